"""Whether a building takes more time or memory a panel, the larger it is.

    python -m tests.benchmarks.growth --panels 1000 10000
    python -m tests.benchmarks.growth --panels 10000 100000 --only-file

A strip of as many panels as a region has is read and fitted panel by panel, which is not timed. Then it is delivered
again and again as one region after the other: its sheets are built, both STEP files are written and proved, and its
solids go into one file of the whole building, which is written while regions come and go. With --only-file nothing but
that file is written, from sheets that were built once. Each number of panels has a process of its own, as memory is the
most that it had: POSIX's `resource` tells, so this runs on Linux and macOS.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
from collections.abc import Iterator
from multiprocessing import get_context
from pathlib import Path
from shutil import rmtree
from typing import NamedTuple

from cadpanel.brep.isolation.client import start_reader, stop_reader
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.brep.proof.parallel import Helper, second_interpreter
from cadpanel.brep.read import read_reference
from cadpanel.brep.step.file import write_step
from cadpanel.brep.step.products import NamedShape
from cadpanel.delivery.outputs.step_files import PANELS, SKINS, colour, write_skins, write_solids
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import PanelSheet, build_panels
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference
from fixtures.make_fixtures import Fixture, write
from tests.benchmarks.delivery import Took, local_shapes, now, prove, strip

WHOLE = "building.step"


class Spent(NamedTuple):
    """What a building took.

    Attributes:
        took: seconds of the clock and of the processor, those of the interpreters beside included.
        most: the most memory that this process had, MB.
        most_beside: the same of an interpreter beside it.
        size: of the whole building's file, MB.
    """

    took: Took
    most: float
    most_beside: float
    size: float


class Building:
    """A building of regions that are all alike, delivered one after the other."""

    def __init__(self, folder: Path, region: int, *, only_file: bool) -> None:
        """Read and fit the region, and start what proves it."""
        self._folder, self._only_file = folder, only_file
        silence_kernel()
        start_reader()
        file = folder / f"region_{region}.step"
        write(Fixture(file=file.name, prefix="P", table=(), lip=strip(region)), file)
        self._reference: Reference = read_reference(file)
        self._shapes: tuple[Panel, ...] = local_shapes(self._reference)

    def deliver(self, panels: int) -> Took:
        """Deliver so many panels; what it took."""
        began = now()
        with second_interpreter(0 if self._only_file else len(self._shapes)) as helper:
            solids = self._standing(panels) if self._only_file else self._regions(panels, helper)
            write_step(self._folder / WHOLE, solids, title="building")
            stop_reader()
        ended = now()
        return Took(ended.clock - began.clock, ended.processor - began.processor)

    def _regions(self, panels: int, helper: Helper | None) -> Iterator[NamedShape]:
        """The solids of all regions, each built, written and proved before."""
        for number in range(-(-panels // len(self._shapes))):
            built = self._built()
            folder = self._folder / str(number)
            folder.mkdir()
            write_skins(folder / SKINS, built, "region")
            write_solids(folder / PANELS, built, "region")
            certificate = prove(folder, self._reference, built, helper)
            if not certificate.holds:
                raise SystemExit(f"the proof fails: {certificate.failures[0]}")
            yield from _named(built, number)
            rmtree(folder)

    def _standing(self, panels: int) -> Iterator[NamedShape]:
        """The solids of one region, again and again."""
        built = self._built()
        for number in range(-(-panels // len(built))):
            yield from _named(built, number)

    def _built(self) -> tuple[PanelSheet, ...]:
        return build_panels(self._shapes, SheetSettings(), self._reference.seams).panels


def _named(built: tuple[PanelSheet, ...], number: int) -> Iterator[NamedShape]:
    for place, panel in enumerate(built):
        yield f"{number}-{panel.shape.name}", panel.solid, colour(place)


def measure(panels: int, region: int, only_file: bool) -> Spent:
    """What a building of so many panels takes, in a process that does nothing else."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        took = Building(folder, region, only_file=only_file).deliver(panels)
        size = (folder / WHOLE).stat().st_size / 1e6
    unit = 1e6 if sys.platform == "darwin" else 1e3
    own, beside = (resource.getrusage(who).ru_maxrss / unit for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return Spent(took=took, most=own, most_beside=beside, size=size)


def main() -> None:
    """See the module's text."""
    parser = argparse.ArgumentParser(description="Time and memory a panel, by the size of a building.")
    parser.add_argument("--panels", type=int, nargs="+", default=[1000, 10_000])
    parser.add_argument("--region", type=int, default=500)
    parser.add_argument("--only-file", action="store_true", help="write the whole building's file and nothing else")
    chosen = parser.parse_args()
    print("   panels   clock s   processor s   ms a panel   MB here   MB beside   MB of file", flush=True)
    for panels in chosen.panels:
        with get_context("spawn").Pool(1) as alone:
            spent = alone.apply(measure, (panels, chosen.region, chosen.only_file))
        each = 1e3 * spent.took.processor / panels
        print(
            f"{panels:>9} {spent.took.clock:9.1f} {spent.took.processor:13.1f} {each:12.2f} {spent.most:9.0f}"
            f" {spent.most_beside:11.0f} {spent.size:12.0f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
