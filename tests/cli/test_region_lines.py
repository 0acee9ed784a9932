"""Lines of regions show names and details as they are written, brackets included."""

from __future__ import annotations

import io
from typing import Any

import pytest
from rich.console import Console

from cadpanel.cli import region_lines as module
from cadpanel.cli.region_lines import region_lines
from cadpanel.jobs.summary import RowModel

BRACKETS = ["roof [north]", "roof [/b]", "[bold]", "a \\[b]", "[link=x]"]


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> io.StringIO:
    """What a terminal is told on the error stream."""
    told = io.StringIO()

    def console(**_: Any) -> Console:
        return Console(file=told, force_terminal=True, color_system=None, width=200)

    monkeypatch.setattr(module, "Console", console)
    return told


@pytest.mark.parametrize("name", BRACKETS)
def test_brackets_are_no_markup(terminal: io.StringIO, name: str) -> None:
    with region_lines(2, quiet=False, told=False) as shown:
        shown.tell(name, "Read reference", 0, 1, "that of " + name)
        shown.tell("other", "Read reference", 0, 1, "")
        shown.done(RowModel(region="other", state="none", said="no face in " + name))
    said = terminal.getvalue()
    assert f"Read reference, that of {name}" in said
    assert said.replace("that of " + name, "").replace("no face in " + name, "").count(name) > 0
    assert f"no face in {name}" in said
