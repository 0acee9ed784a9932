"""How long a whole building takes, how much memory, and what more workers would make of it.

    python -m tests.benchmarks.building --regions 20 --panels 500
    python -m tests.benchmarks.building --regions 20 200 --panels 500 --workers 2 --folder build/building

Every region is a lip of its own in a STEP file of its own, twisted, folded and bent by random numbers (seeded). What a
user types is run, `cadpanel run job.toml --workers N`, with default settings and the outputs `step` and `flats`: each
region is read, fitted, built, written and proved, and the assembly of all is put together. It tells the clock, the
processor's time of all processes, the most memory that one process and that all had together, and how long the regions
would take on more workers, where each takes the next region that is left. Runs on Linux, whose /proc tells of memory.
"""

from __future__ import annotations

import argparse
import heapq
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from shutil import rmtree
from threading import Event, Thread

from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.jobs.summary import SUMMARY, read_summary
from fixtures.make_fixtures import Fixture, write
from tests.benchmarks.strips import uneven_lip

OUTPUTS = ("step", "flats")
LOOKED_AT = 0.5
"""Seconds between two looks at the memory."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spent:
    """What a building took.

    Attributes:
        clock, processor: seconds; those of all processes.
        largest, together: the most memory that one process had, and all of them at one time, MB.
        regions: seconds of each, from reading to the proof.
        size: of the files in the folder, MB.
    """

    clock: float
    processor: float
    largest: float
    together: float
    regions: tuple[float, ...]
    size: float

    def on_workers(self, workers: int, beside: int) -> float:
        """Seconds on so many workers, each of which takes the next region that is left.

        Args:
            workers: how many.
            beside: how many worked side by side when it was measured; what was not spent in regions stays as it was.
        """
        return last_end(self.regions, workers) + max(0.0, self.clock - last_end(self.regions, beside))


def last_end(seconds: Sequence[float], workers: int) -> float:
    """When the last of some tasks is done, taken in their order by whoever is free first, in seconds."""
    free = [0.0] * workers
    for one in seconds:
        heapq.heapreplace(free, free[0] + one)
    return max(free)


class Memory:
    """The memory of a process and of all that it started, looked at now and then."""

    def __init__(self, process: int) -> None:
        self.largest = self.together = 0.0
        self._process, self._over = process, Event()
        self._thread = Thread(target=self._look, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._over.set()
        self._thread.join()

    def _look(self) -> None:
        while not self._over.wait(LOOKED_AT):
            sizes = [_memory_of(one) for one in _with_children(self._process)]
            self.largest = max(self.largest, *sizes, 0.0)
            self.together = max(self.together, sum(sizes))


def _with_children(process: int) -> list[int]:
    try:
        listed = [Path(task, "children").read_text() for task in Path(f"/proc/{process}/task").iterdir()]
    except OSError:
        return []  # it has ended
    return [process, *(one for text in listed for child in text.split() for one in _with_children(int(child)))]


def _memory_of(process: int) -> float:
    """Its share of what lies in memory, MB; pages that several have count in parts."""
    try:
        lines = Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0.0
    return sum(float(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1e3


def measure(folder: Path, regions: int, panels: int, workers: int, seed: int) -> Spent:
    """What a building takes whose files are written into a folder."""
    silence_kernel()
    folder.mkdir(parents=True)
    job = [f"[defaults]\noutputs = [{', '.join(map(repr, OUTPUTS))}]\n"]
    for number in range(regions):
        lip = uneven_lip(panels, number, seed)
        name = f"R{number:03}"
        write(Fixture(file=f"{name}.step", prefix=name, table=(), lip=lip), folder / f"{name}.step")
        job.append(f'[regions.{name}]\nreference = "{name}.step"\n')
    (folder / "job.toml").write_text("\n".join(job), encoding="utf-8")
    words = [
        sys.executable,
        "-m",
        "cadpanel.cli.main",
        "run",
        "job.toml",
        "--out",
        "out",
        "--cache",
        "cache",
        "--quiet",
    ]
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    running = subprocess.Popen([*words, *(["--workers", str(workers)] if workers > 1 else [])], cwd=folder)
    memory = Memory(running.pid)
    code = running.wait()
    clock = time.monotonic() - began
    memory.stop()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    summary = read_summary(folder / "out" / SUMMARY)
    wrong = [f"{row.region}: {row.said}" for row in summary.rows if row.said]
    print(f"exit code {code}; {len(wrong)} regions miss something", *wrong[:5], sep="\n  ", flush=True)
    return Spent(
        clock=clock,
        processor=after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
        largest=memory.largest,
        together=memory.together,
        regions=tuple(row.seconds or 0.0 for row in summary.rows),
        size=sum(file.stat().st_size for file in (folder / "out").rglob("*") if file.is_file()) / 1e6,
    )


def main() -> None:
    """See the module's text."""
    parser = argparse.ArgumentParser(description="Time and memory of a whole building, region by region.")
    parser.add_argument("--regions", type=int, nargs="+", default=[4, 20])
    parser.add_argument("--panels", type=int, default=500)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, help="keep the files there")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        for regions in chosen.regions:
            folder = (chosen.folder or Path(temporary)) / str(regions)
            spent = measure(folder, regions, chosen.panels, chosen.workers, chosen.seed)
            panels = regions * chosen.panels
            print(
                f"{panels} panels in {regions} regions on {chosen.workers} workers: {spent.clock:.0f} s by the clock, "
                f"{spent.processor:.0f} s of the processor ({1e3 * spent.processor / panels:.1f} ms a panel), "
                f"{spent.largest:.0f} MB in one process, {spent.together:.0f} MB together, {spent.size:.0f} MB of files"
            )
            many = (1, 2, 4, 8, 16, 32, 64)
            each = ", ".join(f"{n}: {spent.on_workers(n, chosen.workers):.0f}" for n in many)
            print(f"on more workers, s by the clock: {each}", flush=True)
            if not chosen.folder:
                rmtree(folder)


if __name__ == "__main__":
    main()
