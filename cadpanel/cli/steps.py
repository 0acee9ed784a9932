"""Progress of long steps: bars on a terminal, lines in a file or a pipe, or lines for programs."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TextIO

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn

from cadpanel.cli.silence import Unsilent
from cadpanel.cli.time_left import Clock, TimeLeft, listed

SILENCE = 4.0
"""After so many seconds without a line one says which step is still at work, s."""
PACE = 2.0
"""Between two rounds of a fit that are told at least so many seconds pass, and before the first, s."""

DELIVERING = {
    "compare": "Fit two-stage, to compare",
    "build": "Build solids",
    "write": "Write STEP",
    "verify": "Read back and verify",
}
"""What the steps of a delivery are called."""
_ALIKE = {DELIVERING["build"], DELIVERING["verify"]}
"""Steps whose parts take about as long as each other, panels and not files: what is left of them can be told."""


class Steps:
    """One line a step: what it is, a bar, how far it is, and its time."""

    def __init__(self, progress: Progress, clock: Clock = time.monotonic) -> None:
        """Write to `progress`."""
        self._progress, self._clock = progress, clock
        self._tasks: dict[str, TaskID] = {}
        self._left = TimeLeft(clock)

    def begin(self, step: str, detail: str = "", left: Callable[[], str] = str) -> None:
        """Start a step of unknown length; those before it are done. `left` says what remains of all, whenever asked."""
        for task in self._tasks.values():
            self._finish(task)
        self._tasks[step] = self._progress.add_task(step, total=None, detail=listed(detail, left()))
        self._left = TimeLeft(self._clock)

    def detail(self, step: str, detail: str) -> None:
        """Say how far a step is."""
        self._progress.update(self._tasks[step], detail=detail)

    def count(self, step: str, done: int, of: int) -> None:
        """Say how much of a step is done, and how long it will go on; begins it where it has not begun."""
        name = DELIVERING.get(step, step)
        if name not in self._tasks:
            self.begin(name)
        detail = listed(f"{done} of {of}" if of > 1 else "", self._time_left(name, done, of))
        self._progress.update(self._tasks[name], completed=done, total=of, detail=detail)

    def solving(self, step: str, count: int, excess: float, rms: float) -> None:
        """Say how far the concurrent fit is from its tolerances and the reference; begins where it has not begun."""
        if step not in self._tasks:
            self.begin(step)
        self._progress.update(self._tasks[step], detail=_solving(count, excess, rms))

    def end(self) -> None:
        """All steps are done."""
        for task in self._tasks.values():
            self._finish(task)

    def _time_left(self, name: str, done: int, of: int) -> str:
        return self._left.said(done, of) if name in _ALIKE else ""

    def _finish(self, task: TaskID) -> None:
        self._progress.update(task, total=1, completed=1)
        self._progress.stop_task(task)


class ToldSteps(Steps):
    """Steps as lines of JSON on the error stream: their name, how much is done of how much, and a detail."""

    def begin(self, step: str, detail: str = "", left: Callable[[], str] = str) -> None:
        """See `Steps.begin`."""
        super().begin(step, detail, left)
        self._tell(step, 0, 1, listed(detail, left()))

    def count(self, step: str, done: int, of: int) -> None:
        """See `Steps.count`."""
        super().count(step, done, of)
        name = DELIVERING.get(step, step)
        self._tell(name, done, of, self._time_left(name, done, of))

    def solving(self, step: str, count: int, excess: float, rms: float) -> None:
        """See `Steps.solving`."""
        super().solving(step, count, excess, rms)
        self._tell(step, 0, 1, _solving(count, excess, rms))

    def _tell(self, step: str, done: int, of: int, detail: str) -> None:
        line = json.dumps({"step": step, "done": done, "of": of, "detail": detail})
        sys.stderr.write(f"{line}\n")
        sys.stderr.flush()


class WrittenSteps(Steps):
    """Steps as lines in a file or a pipe: rounds of a fit that takes its time, and one wherever it was silent for long.

    A run that is short, or refused, writes none.
    """

    def __init__(
        self, progress: Progress, stream: TextIO, silence: float, pace: float, clock: Clock = time.monotonic
    ) -> None:
        """Write to `stream`, never later than `silence` seconds after the line before, and no round before `pace`."""
        super().__init__(progress, clock)
        self._pace, self._last = pace, clock()
        self._step, self._detail, self._began = "", "", self._last
        self._says_left: Callable[[], str] = str
        self._lines = Unsilent(stream, silence, self._at_work)

    def begin(self, step: str, detail: str = "", left: Callable[[], str] = str) -> None:
        """See `Steps.begin`."""
        super().begin(step, detail, left)
        self._step, self._detail, self._says_left, self._began = step, detail, left, self._clock()

    def count(self, step: str, done: int, of: int) -> None:
        """See `Steps.count`."""
        super().count(step, done, of)
        if of > 1 and DELIVERING.get(step, step) == self._step:
            self._detail, self._says_left = f"{done} of {of}", partial(self._time_left, self._step, done, of)

    def solving(self, step: str, count: int, excess: float, rms: float) -> None:
        """See `Steps.solving`."""
        super().solving(step, count, excess, rms)
        if self._clock() - self._last >= self._pace:
            self._lines.write(f"{step}: {_solving(count, excess, rms)}")
            self._last = self._clock()

    def close(self) -> None:
        """Write nothing any more."""
        self._lines.close()

    def _at_work(self) -> str:
        if not self._step:
            return ""
        self._last = self._clock()
        # Told as it is now: a part that takes long makes what is left longer, not what was said before true again.
        at_work = f"{self._step}: at work for {self._last - self._began:.0f} s"
        return listed(at_work, self._detail, self._says_left())


def _solving(count: int, excess: float, rms: float) -> str:
    # Nobody knows how many steps there will be: what remains stands in the words.
    return f"step {count}: worst gap or drift at {excess:.2f} x its limit (held at 1), RMS deviation {rms:.2f} mm"


@contextmanager
def steps(*, quiet: bool, told: bool = False) -> Iterator[Steps]:
    """Show steps on the error stream while the block runs: bars on a terminal, else lines, for people or programs."""
    console = Console(stderr=True)
    progress = Progress(
        SpinnerColumn(finished_text="[green]ok"),
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        TimeElapsedColumn(),
        TextColumn("{task.fields[detail]}", style="dim", markup=False),  # names of files hold brackets
        console=console,
        disable=quiet or told or not console.is_terminal,
    )
    written = None if quiet or told or console.is_terminal else WrittenSteps(progress, sys.stderr, SILENCE, PACE)
    try:
        with progress:
            shown = written or (ToldSteps(progress) if told else Steps(progress))
            yield shown
            shown.end()
    finally:
        if written is not None:
            written.close()
