"""Progress of many regions: a line each, whoever works at them."""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import TextIO

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn

from cadpanel.cli.printable import printable
from cadpanel.cli.silence import Unsilent
from cadpanel.cli.steps import DELIVERING, SILENCE
from cadpanel.cli.time_left import Clock, TimeLeft, listed
from cadpanel.jobs.summary import RowModel

_ENDS = {"made": "made", "kept": "from earlier results", "there": "there already", "none": "no delivery"}


class RegionLines:
    """Lines of regions: on a terminal those at work, under those that are done; else one wherever one is done.

    Where none came for long, one says what is at work.
    """

    def __init__(
        self, progress: Progress, of: int, *, told: bool, stream: TextIO | None = None, clock: Clock = time.monotonic
    ) -> None:
        """Write to `progress`, or lines for people to a stream, or for programs to the error stream."""
        self._progress, self._of, self._done, self._made = progress, of, 0, 0
        self._told, self._left = told, TimeLeft(clock)
        self._tasks: dict[str, TaskID] = {}
        self._at_work = ""  # the region that said something last, and what
        self._lock = threading.Lock()  # workers tell from a thread of their own
        self._lines = None if stream is None else Unsilent(stream, SILENCE, lambda: self._at_work)

    def close(self) -> None:
        """Write nothing any more."""
        if self._lines is not None:
            self._lines.close()

    def tell(self, region: str, step: str, done: int, of: int, detail: str) -> None:
        """Say how far a region is."""
        with self._lock:
            step = DELIVERING.get(step, step)
            said = listed(step, f"{done} of {of}" if of > 1 else detail)
            self._at_work = printable(f"{region}: {said}")
            if region not in self._tasks:
                self._tasks[region] = self._progress.add_task(region, total=None, detail="")
            self._progress.update(self._tasks[region], detail=said)
            if self._told:
                _say(json.dumps({"region": region, "step": step, "done": done, "of": of, "detail": detail}))

    def done(self, row: RowModel) -> None:
        """Say what came of a region, and how long the others will take if they are like those that were made."""
        with self._lock:
            self._done += 1
            self._made += row.state == "made"
            self._at_work = ""
            task = self._tasks.pop(row.region, None)
            if task is not None:
                self._progress.remove_task(task)
            left = self._left.said(self._made, self._made + self._of - self._done)
            said = listed(f"{self._done} of {self._of}: {row.region}: {_told(row)}", left)
            if self._told:
                _say(json.dumps({"region": row.region, "state": row.state, "met": row.met, "said": row.said}))
            elif self._lines is not None:
                self._lines.write(printable(said))
            elif not self._progress.disable:
                self._progress.console.print(said, markup=False, highlight=False)


def _say(line: str) -> None:
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()


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
        TextColumn("{task.description}", markup=False),  # names of users hold brackets
        TimeElapsedColumn(),
        TextColumn("{task.fields[detail]}", style="dim", markup=False),
        console=console,
        disable=quiet or told or not console.is_terminal,
    )
    stream = None if quiet or told or console.is_terminal else sys.stderr
    with progress, closing(RegionLines(progress, of, told=told, stream=stream)) as shown:
        yield shown
