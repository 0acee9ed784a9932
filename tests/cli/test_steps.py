"""Whoever reads a pipe is told of the rounds of a long fit, and is never left in silence."""

from __future__ import annotations

import io
import threading

import pytest
from rich.console import Console
from rich.progress import Progress

from cadpanel.cli.steps import WrittenSteps, steps


class Heard(io.StringIO):
    """A stream that says when something was written."""

    def __init__(self) -> None:
        super().__init__()
        self.something = threading.Event()

    def flush(self) -> None:
        self.something.set()


def quiet() -> Progress:
    return Progress(console=Console(file=io.StringIO()), disable=True)


def test_a_long_step_says_that_it_is_at_work() -> None:
    stream = Heard()
    shown = WrittenSteps(quiet(), stream, 0.01, 0.0)
    shown.begin("Read reference", "roof.step")
    assert stream.something.wait(60.0)
    shown.close()
    assert stream.getvalue().startswith("Read reference: at work for 0 s, roof.step\n")
    said = stream.getvalue()
    shown.begin("Build solids")
    assert stream.getvalue() == said


def test_every_round_of_a_fit_is_a_line() -> None:
    stream = Heard()
    shown = WrittenSteps(quiet(), stream, 3600.0, 0.0)
    shown.begin("Fit each alone")
    for count in (1, 2):
        shown.solving("Fit all at once", count, 1.5, 7.25)
    shown.count("build", 1, 2)
    shown.close()
    assert stream.getvalue().splitlines() == [
        f"Fit all at once: step {count}: worst gap or drift at 1.50 x its limit (held at 1), RMS deviation 7.25 mm"
        for count in (1, 2)
    ]


def test_a_short_fit_tells_none_of_its_rounds() -> None:
    stream = Heard()
    shown = WrittenSteps(quiet(), stream, 3600.0, 3600.0)
    shown.begin("Fit each alone")
    shown.solving("Fit all at once", 1, 1.5, 7.25)
    shown.close()
    assert stream.getvalue() == ""


@pytest.mark.parametrize("name", ["roof [north].step", "roof [/b].step", "[bold].step"])
def test_brackets_in_names_of_files_are_no_markup(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    told = io.StringIO()
    terminal = Console(file=told, force_terminal=True, color_system=None, width=200)
    monkeypatch.setattr("cadpanel.cli.steps.Console", lambda **_: terminal)
    with steps(quiet=False) as shown:
        shown.begin("Read reference", name)
    assert name in told.getvalue()
