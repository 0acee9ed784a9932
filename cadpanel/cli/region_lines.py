"""Progress of many regions: a line each, whoever works at them."""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn

from cadpanel.cli.printable import printable
from cadpanel.cli.steps import DELIVERING, SILENCE
from cadpanel.jobs.summary import RowModel

_ENDS = {"made": "made", "kept": "from earlier results", "there": "there already", "none": "no delivery"}


class RegionLines:
    """Lines of regions: on a terminal those at work, under those that are done; else a line where one is done."""

    def __init__(self, progress: Progress, of: int, *, silent: bool, told: bool) -> None:
        """Write to `progress`, or lines for people or programs."""
        self._progress, self._of, self._done = progress, of, 0
        self._silent, self._told = silent, told
        self._tasks: dict[str, TaskID] = {}
        self._steps: dict[str, str] = {}
        self._last = time.monotonic()
        self._lock = threading.Lock()  # workers tell from a thread of their own

    def tell(self, region: str, step: str, done: int, of: int, detail: str) -> None:
        """Say how far a region is."""
        with self._lock:
            step = DELIVERING.get(step, step)
            said = step + (f", {done} of {of}" if of > 1 else f", {detail}" if detail else "")
            self._steps[region] = said
            if region not in self._tasks:
                self._tasks[region] = self._progress.add_task(region, total=None, detail="")
            self._progress.update(self._tasks[region], detail=said)
            if self._told:
                self._write(json.dumps({"region": region, "step": step, "done": done, "of": of, "detail": detail}))
            elif time.monotonic() - self._last >= SILENCE:
                self._line(f"{region}: {said}")

    def done(self, row: RowModel) -> None:
        """Say what came of a region."""
        with self._lock:
            self._done += 1
            self._steps.pop(row.region, None)
            task = self._tasks.pop(row.region, None)
            if task is not None:
                self._progress.remove_task(task)
            said = f"{self._done} of {self._of}: {row.region}: {_told(row)}"
            if self._told:
                self._write(json.dumps({"region": row.region, "state": row.state, "met": row.met, "said": row.said}))
            elif self._progress.disable:
                self._line(said)
            else:
                self._progress.console.print(said, markup=False, highlight=False)

    def _line(self, said: str) -> None:
        if not self._silent:
            self._write(printable(said))

    def _write(self, line: str) -> None:
        sys.stderr.write(f"{line}\n")
        sys.stderr.flush()
        self._last = time.monotonic()


def _told(row: RowModel) -> str:
    if row.panels is None:
        return f"{_ENDS[row.state]}: {row.said}"
    held = "all held" if row.met else f"missed: {row.said}"
    return f"{row.panels} panels, RMS {row.rms_deviation:.2f} mm, {held} ({_ENDS[row.state]})"


@contextmanager
def region_lines(of: int, *, quiet: bool, told: bool) -> Iterator[RegionLines]:
    """Show regions on the error stream while the block runs."""
    console = Console(stderr=True)
    progress = Progress(
        SpinnerColumn(),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
        TextColumn("[dim]{task.fields[detail]}"),
        console=console,
        disable=quiet or told or not console.is_terminal,
    )
    with progress:
        yield RegionLines(progress, of, silent=quiet, told=told)
