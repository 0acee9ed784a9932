"""Progress of long steps: bars on a terminal, nothing where the output goes to a file, or lines for programs."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn

_DELIVERING = {
    "compare": "Fit two-stage, to compare",
    "build": "Build solids",
    "write": "Write STEP",
    "verify": "Read back and verify",
}


class Steps:
    """One line a step: what it is, a bar, how far it is, and its time."""

    def __init__(self, progress: Progress) -> None:
        """Write to `progress`."""
        self._progress = progress
        self._tasks: dict[str, TaskID] = {}

    def begin(self, step: str, detail: str = "") -> None:
        """Start a step of unknown length; those before it are done."""
        for task in self._tasks.values():
            self._finish(task)
        self._tasks[step] = self._progress.add_task(step, total=None, detail=detail)

    def detail(self, step: str, detail: str) -> None:
        """Say how far a step is."""
        self._progress.update(self._tasks[step], detail=detail)

    def count(self, step: str, done: int, of: int) -> None:
        """Say how much of a step is done; begins it where it has not begun."""
        name = _DELIVERING.get(step, step)
        if name not in self._tasks:
            self.begin(name)
        self._progress.update(self._tasks[name], completed=done, total=of, detail=f"{done} of {of}" if of > 1 else "")

    def solving(self, step: str, count: int, excess: float, rms: float) -> None:
        """Say how far the concurrent fit is from its tolerances and the reference; begins where it has not begun."""
        if step not in self._tasks:
            self.begin(step)
        self._progress.update(self._tasks[step], detail=_solving(count, excess, rms))

    def end(self) -> None:
        """All steps are done."""
        for task in self._tasks.values():
            self._finish(task)

    def _finish(self, task: TaskID) -> None:
        self._progress.update(task, total=1, completed=1)
        self._progress.stop_task(task)


class ToldSteps(Steps):
    """Steps as lines of JSON on the error stream: their name, how much is done of how much, and a detail."""

    def begin(self, step: str, detail: str = "") -> None:
        """See `Steps.begin`."""
        super().begin(step, detail)
        self._tell(step, 0, 1, detail)

    def count(self, step: str, done: int, of: int) -> None:
        """See `Steps.count`."""
        super().count(step, done, of)
        self._tell(_DELIVERING.get(step, step), done, of, "")

    def solving(self, step: str, count: int, excess: float, rms: float) -> None:
        """See `Steps.solving`."""
        super().solving(step, count, excess, rms)
        self._tell(step, 0, 1, _solving(count, excess, rms))

    def _tell(self, step: str, done: int, of: int, detail: str) -> None:
        line = json.dumps({"step": step, "done": done, "of": of, "detail": detail})
        sys.stderr.write(f"{line}\n")
        sys.stderr.flush()


def _solving(count: int, excess: float, rms: float) -> str:
    return f"step {count}: worst gap or drift at {excess:.2f} x its limit, RMS deviation {rms:.2f} mm"


@contextmanager
def steps(*, quiet: bool, told: bool = False) -> Iterator[Steps]:
    """Show steps on the terminal's error stream while the block runs, or tell them there as lines for programs."""
    console = Console(stderr=True)
    progress = Progress(
        SpinnerColumn(finished_text="[green]ok"),
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        TimeElapsedColumn(),
        TextColumn("[dim]{task.fields[detail]}"),
        console=console,
        disable=quiet or told or not console.is_terminal,
    )
    with progress:
        shown = ToldSteps(progress) if told else Steps(progress)
        yield shown
        shown.end()
