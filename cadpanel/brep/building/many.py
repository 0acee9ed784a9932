"""Many sheets built at once, with the second interpreter's help where there are enough of them.

Building a sheet is the smaller part: its checks and what the kernel measures of it take longer. The second interpreter
checks and measures sheets from the back, and whoever asks those from the front, until none is left. All are built here:
a shape that comes over a pipe has its directions normalised once more, and so other last digits.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid

from cadpanel.arrays import Array
from cadpanel.brep.building.mass_properties import area_and_centroid, volume_and_centroid
from cadpanel.brep.building.sheet import build_checked, build_panel
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.isolation.client import READER
from cadpanel.brep.isolation.processors import processors
from cadpanel.brep.isolation.requests import SECONDS_TO_WORK, Request, Stage
from cadpanel.errors import CadpanelError, PanelError
from cadpanel.geometry.volume import sheet_volume

WORTHWHILE_PANELS = 400
"""Sheets that take longer to build than it takes to start an interpreter, about 2 s."""
CHUNK = 16
"""Sheets asked for at once, about 0.1 s of work."""
WITHIN = Path(__file__).parent
"""A folder that is there: nothing is looked for in it."""
Told = Callable[[int], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """What the kernel and the formulas find of a sheet and its skin; mm.

    Attributes:
        area, centroid: of the whole surface of the solid, and (3,) of its volume.
        skin_area, skin_centroid: of the skin.
        volume: by the formula, of the sheet without holes.
    """

    area: float
    centroid: Array
    skin_area: float
    skin_centroid: Array
    volume: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MadeSheet:
    """A sheet as a solid, and its skin."""

    solid: TopoDS_Solid
    skin: TopoDS_Shell
    measured: Measured


def make_sheet(wanted: Sheet) -> MadeSheet:
    """Build one.

    Raises:
        PanelError: it cannot be built (see `check_buildable`).
    """
    built = build_panel(wanted.shape, wanted.thickness, wanted.skin_side, wanted.holes)
    area, _ = area_and_centroid(built.solid)
    _, centroid = volume_and_centroid(built.solid)
    skin_area, skin_centroid = area_and_centroid(built.skin)
    measured = Measured(
        area=area,
        centroid=centroid,
        skin_area=skin_area,
        skin_centroid=skin_centroid,
        volume=sheet_volume(wanted.shape, wanted.thickness, wanted.skin_side),
    )
    return MadeSheet(solid=built.solid, skin=built.skin, measured=measured)


def measure_sheets(wanted: Sequence[Sheet]) -> list[Measured | PanelError]:
    """Measure some for whoever builds them; why one cannot be built is told in its place."""
    found: list[Measured | PanelError] = []
    for one in wanted:
        try:
            found.append(make_sheet(one).measured)
        except PanelError as error:
            found.append(error)
    return found


def make_sheets(wanted: Sequence[Sheet], told: Told) -> list[MadeSheet]:
    """Build all, in their order.

    Args:
        wanted: sheets.
        told: that one more is built.

    Raises:
        PanelError: the first that cannot be built, in their order.
    """
    work = _Work(wanted, told)
    if len(wanted) < WORTHWHILE_PANELS or processors() < 2:
        work.build()
    else:
        with _helped(work):
            work.build()
    return work.all()


@contextmanager
def _helped(work: _Work) -> Iterator[None]:
    """Let a thread have sheets measured by the second interpreter until none is left, or this ends."""
    with ThreadPoolExecutor(max_workers=1) as clerk:
        helping = clerk.submit(work.have_measured)
        try:
            yield
            helping.result()
        finally:
            work.stop()


class _Work:
    """Sheets that are checked and measured from both ends, and built here."""

    def __init__(self, wanted: Sequence[Sheet], told: Told) -> None:
        self._wanted, self._told = wanted, told
        self._made: dict[int, MadeSheet | PanelError] = {}
        self._left = deque(range(len(wanted)))
        self._come: deque[tuple[int, Measured | PanelError]] = deque()
        self._stopped = threading.Event()

    def build(self) -> None:
        """Build what has been measured, or else the first that is left, until there is neither.

        Raises:
            PanelError: one cannot be built; all before it can.
        """
        while True:
            if self._come:
                place, found = self._come.popleft()
                self._made[place] = self._built(place, found)
            elif (place := self._next()) >= 0:
                self._made[place] = make_sheet(self._wanted[place])
            else:
                return
            self._told(1)

    def have_measured(self) -> None:
        """Have the second interpreter measure from the back; what it fails over is left to those who build here."""
        while not self._stopped.is_set() and (places := self._last()):
            try:
                request = _request([self._wanted[place] for place in places])
                found = cast(list[Measured | PanelError], READER.ask(request))
            except (CadpanelError, RuntimeError):
                self._left.extend(reversed(places))
                return
            self._come.extend(zip(places, found, strict=True))

    def _built(self, place: int, found: Measured | PanelError) -> MadeSheet | PanelError:
        if isinstance(found, PanelError):
            return found
        sheet = self._wanted[place]
        built = build_checked(sheet.shape, sheet.thickness, sheet.skin_side, sheet.holes)
        return MadeSheet(solid=built.solid, skin=built.skin, measured=found)

    def stop(self) -> None:
        """Have no more measured by the second interpreter."""
        self._stopped.set()

    def all(self) -> list[MadeSheet]:
        """All sheets in their order.

        Raises:
            PanelError: the first that cannot be built.
        """
        self.build()  # what may have been left
        made = [self._made[place] for place in range(len(self._wanted))]
        for sheet in made:
            if isinstance(sheet, PanelError):
                raise sheet
        return cast(list[MadeSheet], made)

    def _next(self) -> int:
        """The first place that is left, -1 if none is."""
        try:
            return self._left.popleft()
        except IndexError:
            return -1

    def _last(self) -> list[int]:
        """The last places, from the back."""
        places: list[int] = []
        try:
            while len(places) < CHUNK:
                places.append(self._left.pop())
        except IndexError:
            pass
        return places


def _request(wanted: Sequence[Sheet]) -> Request:
    stage = Stage(file="panels", doing="building", seconds=SECONDS_TO_WORK)
    return Request(work="measure", folder=WITHIN, path=WITHIN, argument=wanted, stages=(stage,))
