from __future__ import annotations

from pathlib import Path
from typing import Any

from cadpanel.jobs.engine.contents import Contents
from cadpanel.jobs.task import Content
from tests.jobs.jobs import job, parts


class _Client:
    """Remembers what it is to send."""

    def __init__(self) -> None:
        self.sent: list[str] = []

    def submit(self, function: Any, data: bytes, *, key: str, pure: bool) -> str:
        assert pure
        assert function(data) == data
        self.sent.append(key)
        return key


def test_bytes_go_once_to_workers_elsewhere_and_stay_as_long_as_a_task_needs_them(strip: Path) -> None:
    first, second = (task for _, task in parts(job(strip, "A = {}\nB = {thickness = 2}")))
    client: Any = _Client()
    contents = Contents(client, [first, second], here=False)
    for task in (first, second):
        assert contents.of(task) == [f"bytes-{first.contents[0].sha256}"]
    contents.done(first)
    assert contents.of(second)
    assert len(client.sent) == 1
    contents.done(second)
    contents.of(second)
    assert len(client.sent) == 2


def test_workers_here_read_the_files_themselves(strip: Path) -> None:
    ((_, task),) = parts(job(strip, "A = {}"))
    client: Any = None
    (found,) = Contents(client, [task], here=True).of(task)
    assert isinstance(found, Content)
    assert found.path.is_absolute()
    assert found.read() == task.contents[0].read()
