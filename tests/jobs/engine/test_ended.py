from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cadpanel.jobs.engine import ended as module
from cadpanel.jobs.engine.ended import Ended


class _Future:
    """Has ended once somebody says so."""

    def add_done_callback(self, heard: Callable[[Any], None]) -> None:
        self.heard = heard

    def end(self) -> None:
        self.heard(self)


class _Client:
    """Says how many workers there are, one answer after the other; with the last one a task ends."""

    def __init__(self, counts: list[int], ending: _Future) -> None:
        self._left, self._ending = list(counts), ending

    def nthreads(self) -> dict[str, int]:
        count = self._left.pop(0)
        if not self._left:
            self._ending.end()
        return {str(number): 1 for number in range(count)}


@pytest.mark.parametrize(
    ("counts", "times"), [([1], 0), ([2, 1, 3], 0), ([0], 1), ([0, 0, 0, 1], 1), ([1, 0, 0], 1), ([0, 2, 0], 2)]
)
def test_that_nobody_works_is_told_once_until_somebody_did(
    monkeypatch: pytest.MonkeyPatch, counts: list[int], times: int
) -> None:
    monkeypatch.setattr(module, "SECONDS_WITHOUT", 0.0)
    monkeypatch.setattr(module, "LOOK_UP", 0.001)
    future, told = _Future(), list[object]()
    client: Any = _Client(counts, future)
    ended = Ended(client, told.append)
    ended.add(future)
    given: Any = {future: "the first", _Future(): "the second"}
    assert ended.next(given) is future
    assert told == ["the first"] * times


def test_where_something_ends_in_time_nobody_is_asked() -> None:
    first, second = _Future(), _Future()
    client: Any = None
    ended = Ended(client, lambda _: None)
    for future in (first, second):
        ended.add(future)
    second.end()
    first.end()
    given: Any = {first: "A", second: "B"}
    assert [ended.next(given), ended.next(given)] == [second, first]
