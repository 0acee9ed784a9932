"""What is left is told by what was done, never in the first second, and not where nobody knows."""

from __future__ import annotations

import io

import pytest
from rich.console import Console
from rich.progress import Progress

from cadpanel.cli.region_lines import RegionLines
from cadpanel.cli.steps import Steps, WrittenSteps
from cadpanel.cli.time_left import TimeLeft
from cadpanel.jobs.summary import RowModel


class Clock:
    """Moves when it is told to."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.mark.parametrize(
    ("spent", "done", "said"),
    [
        (0.9, 1, ""),
        (10.0, 0, ""),
        (10.0, 10, ""),
        (3.0, 5, "about 3 s left"),
        (10.0, 2, "about 40 s left"),
        (60.0, 4, "about 2 min left"),
        (9000.0, 5, "about 2.5 h left"),
        (2.0, 8, ""),
    ],
)
def test_what_is_left_is_in_proportion_to_what_was_done(spent: float, done: int, said: str) -> None:
    clock = Clock()
    left = TimeLeft(clock)
    clock.now += spent
    assert left.said(done, 10) == said


def test_steps_of_like_parts_tell_what_is_left_and_others_how_much_is_done() -> None:
    clock, progress = Clock(), Progress(console=Console(file=io.StringIO()), disable=True)
    shown = Steps(progress, clock)
    for step, said in (("build", "30 of 120, about 30 s left"), ("write", "30 of 120")):
        shown.count(step, 0, 120)
        clock.now += 10.0
        shown.count(step, 30, 120)
        assert progress.tasks[-1].fields["detail"] == said


def test_lines_in_a_pipe_say_it_too_and_each_step_begins_its_own_clock() -> None:
    clock, stream = Clock(), io.StringIO()
    shown = WrittenSteps(Progress(disable=True), stream, 0.01, 0.0, clock)
    shown.begin("Read reference", "roof.step")
    clock.now += 500.0
    shown.count("build", 0, 4)
    clock.now += 2.0
    shown.count("build", 1, 4)
    while "left" not in stream.getvalue():
        pass
    shown.close()
    lines = stream.getvalue().splitlines()
    assert lines[-1] == "Build solids: at work for 2 s, 1 of 4, about 6 s left"


def test_what_is_left_is_told_as_it_is_when_it_is_told() -> None:
    clock, stream = Clock(), io.StringIO()
    shown = WrittenSteps(Progress(disable=True), stream, 0.01, 0.0, clock)
    shown.count("build", 0, 4)
    clock.now += 6.0
    shown.count("build", 3, 4)
    clock.now += 60.0
    while "66 s" not in stream.getvalue():
        pass
    whole = TimeLeft(clock)
    shown.begin("Fit 2 of 3", left=lambda: whole.said(1, 3))
    assert shown._at_work() == "Fit 2 of 3: at work for 0 s"
    clock.now += 10.0
    assert shown._at_work() == "Fit 2 of 3: at work for 10 s, about 20 s left"
    shown.close()
    assert "Build solids: at work for 66 s, 3 of 4, about 20 s left\n" in stream.getvalue()


def test_regions_that_were_made_tell_of_those_that_are_left_and_kept_ones_do_not() -> None:
    clock, stream = Clock(), io.StringIO()
    shown = RegionLines(Progress(disable=True), 4, told=False, stream=stream, clock=clock)
    row = RowModel.model_construct(region="R", panels=None, said="why", state="kept")
    clock.now += 5.0
    shown.done(row)
    clock.now += 5.0
    shown.done(row.model_copy(update={"state": "made"}))
    shown.close()
    assert stream.getvalue().splitlines() == [
        "1 of 4: R: from earlier results: why",
        "2 of 4: R: made: why, about 20 s left",
    ]
