"""The standing attack works: what it counts as come through is seen, and a few of its tries find nothing."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path

import pytest

from cadpanel.errors import CadpanelError
from tests.attack.damage import damaged, json_damaged, lines_damaged
from tests.attack.fuzz import ended
from tests.attack.report_tampers import of_values, other
from tests.attack.workers import DIED, tried

needs_forks = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs processes that fork")


def test_damage_is_the_same_for_a_seed_and_differs_from_the_file() -> None:
    text = json.dumps({"a": [1.0, 2.0, {"b": "x"}], "c": None}).encode()
    lines = b"v 0 0 0\nv 1 0 0\nf 1 2 3\n"
    for change, data in ((damaged, text), (json_damaged, text), (lines_damaged, lines)):
        found = [change(data, seed) for seed in range(20)]
        assert found == [change(data, seed) for seed in range(20)]
        assert len({*found} - {data}) > 10


def raising(error: Exception) -> str:
    def work() -> str:
        raise error

    return ended(work)


def test_what_must_not_be_is_told_in_capitals() -> None:
    assert raising(CadpanelError("'x.step' is damaged.")) == "refused"
    assert raising(CadpanelError("'x.step' makes the CAD kernel crash: repair it.")) == "crash, told"
    for said in ("no full stop", "two\nlines.", "a pointer 0x7f3a12b45678.", "bell \x07."):
        assert raising(CadpanelError(said)).startswith("NO SENTENCE")
    assert raising(KeyError("x")).startswith("TRACEBACK: KeyError")


def test_every_kind_of_value_is_changed_once() -> None:
    content = {"panels": [{"name": "a", "area": 1.0}, {"name": "b", "area": 2.0}], "met": True, "none": None}
    changes = of_values(content)
    assert set(changes) == {"panels", "panels.*", "panels.*.name", "panels.*.area", "met", "none"}
    for name, change in changes.items():
        copy = json.loads(json.dumps(content))
        change(copy)
        assert copy != content, name
    assert other(2.0) == pytest.approx(2.03)


@needs_forks
def test_an_input_that_kills_its_process_is_counted_and_the_next_ones_are_tried() -> None:
    def attempt(_kind: str, seed: int) -> str:
        if seed == 2:
            os.kill(os.getpid(), signal.SIGKILL)
        return f"{seed}"

    found = sorted(tried([("x", seed) for seed in range(5)], attempt, lambda: None, 2))
    assert [one.end for one in found] == ["0", "1", DIED, "3", "4"]


def test_the_command_line_is_as_it_is_told(tmp_path: Path) -> None:
    from tests.attack.__main__ import _options

    options = _options(["fuzz", "--count", "7", "--seed", "3"])
    assert (options.attack, options.count, options.seed) == ("fuzz", 7, 3)
    assert list(tmp_path.iterdir()) == []
