"""A strip or a ring divided along its length into any number of panels, whichever way its faces lie."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array
from cadpanel.brep.cutting.smallest_panel import require_room
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.belt import Belt, find_belt
from cadpanel.brep.skin.iso_strip import Lanes, find_lanes
from cadpanel.brep.skin.ring import Ring, find_ring
from cadpanel.brep.skin.seam_planes import PlanesOf, seam_planes
from cadpanel.brep.skin.split_by_planes import cut_by_planes
from cadpanel.brep.skin.strip import Strip, find_strip
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import norm
from cadpanel.reference.settings import Seams

# Points of a long edge by which its length is measured.
EDGE_POINTS = 257


class Division(ABC):
    """What can be divided into a number of panels that follow each other."""

    @property
    @abstractmethod
    def longest(self) -> float:
        """Length of all of it along its longest edge, mm."""

    @abstractmethod
    def longest_panel(self, count: int) -> float:
        """How long the longest of so many panels is, along the longer one of its edges, mm."""

    @abstractmethod
    def cut(self, count: int) -> list[list[TopoDS_Face]]:
        """The faces of each of so many panels.

        Raises:
            ReferenceFileError: it cannot be cut.
            SettingsError: there is no room for so many.
        """


@dataclass(frozen=True, slots=True, kw_only=True)
class Lengthwise(Division):
    """Faces side by side that share their parameter along the strip: cut along parameter lines, without any boolean."""

    lanes: Lanes
    what: str
    tolerance: float

    @property
    def longest(self) -> float:
        """See `Division`."""
        return float(self.lanes.spans(np.array([0.0, 1.0])).max())

    def longest_panel(self, count: int) -> float:
        """See `Division`."""
        return float(self.lanes.spans(self._parts(count)).max())

    def cut(self, count: int) -> list[list[TopoDS_Face]]:
        """See `Division`."""
        _require_room(self.lanes.edges(np.linspace(0.0, 1.0, EDGE_POINTS)), count, self.what, self.tolerance)
        return self.lanes.cut(self._parts(count))

    def _parts(self, count: int) -> Array:
        parts = np.linspace(0.0, 1.0, count + 1)
        parts[1:-1] = self.lanes.at_lengths(parts[1:-1])
        return parts


@dataclass(frozen=True, slots=True, kw_only=True)
class Round(Division):
    """Faces that follow each other round a ring, cut right across it."""

    ring: Ring
    what: str
    tolerance: float

    @property
    def longest(self) -> float:
        """See `Division`."""
        return self.ring.longest

    def longest_panel(self, count: int) -> float:
        """See `Division`; one panel cannot go round, and is infinitely long."""
        return self.ring.longest_panel(count, self.tolerance) if count > 1 else np.inf

    def cut(self, count: int) -> list[list[TopoDS_Face]]:
        """See `Division`."""
        _require_parts(count, self.what)
        require_room([self.ring.longest], 0.0, count, self.what, self.tolerance)
        return self.ring.cut(count, self.tolerance)


@dataclass(frozen=True, slots=True, kw_only=True)
class Girdling(Division):
    """Any faces that close to a ring, cut by planes across them."""

    surface: Surface
    belt: Belt
    source: str
    what: str
    tolerance: float

    @property
    def longest(self) -> float:
        """See `Division`."""
        return max(float(arc_length(edge)[-1]) for edge in self.belt.edges)

    def longest_panel(self, count: int) -> float:
        """See `Division`; one panel cannot go round, and is infinitely long."""
        return self.belt.longest_part(count) if count > 1 else np.inf

    def cut(self, count: int) -> list[list[TopoDS_Face]]:
        """See `Division`."""
        _require_parts(count, self.what)
        require_room([self.belt.length], 0.0, count, self.what, self.tolerance)
        return self.belt.cut(self.surface, count, self.source)


@dataclass(frozen=True, slots=True, kw_only=True)
class Across(Division):
    """Any faces, cut by planes across them."""

    surface: Surface
    strip: Strip
    planes: PlanesOf
    source: str
    what: str
    tolerance: float

    @property
    def longest(self) -> float:
        """See `Division`."""
        return max(float(arc_length(edge)[-1]) for edge in self.strip.edges)

    def longest_panel(self, count: int) -> float:
        """See `Division`."""
        return self.longest if count == 1 else float(self.strip.lengths_between(self.planes(count)).max())

    def cut(self, count: int) -> list[list[TopoDS_Face]]:
        """See `Division`."""
        _require_room(np.array(self.strip.edges), count, self.what, self.tolerance)
        if count == 1:
            return [[face.patch.face for face in self.surface.faces]]
        return cut_by_planes(self.surface, self.planes(count), self.source)


def division_of(surface: Surface, seams: Seams, most_turn: float, source: str, tolerance: float) -> Division:
    """How a surface is divided along its length.

    Faces side by side that share their parameter along the strip are cut along parameter lines where seams are square,
    as are faces that follow each other round a ring, no wider than it is long, in rows with common joints. All others
    are cut by planes across them, strips and rings.

    Args:
        surface: what to cut.
        seams: which planes; free ones are cut square.
        most_turn: by how much a plane of conjugate seams may be turned from square, radians.
        source: the reference's name.
        tolerance: how far faces that meet may lie apart, mm.

    Raises:
        ReferenceFileError: the surface is no strip, or none that has such seams.
    """
    what = f"the surface of {surface.numbers} of '{source}'"
    # Free seams are told from square ones in the fit alone.
    seams = "square" if seams == "free" else seams
    lanes = find_lanes(surface)
    if lanes is None or not lanes.outer:
        ring = find_ring(surface)
        if ring is not None and ring.length >= ring.width:
            _require_square(seams, what)
            return Round(ring=ring, what=what, tolerance=tolerance)
        if ring is not None or lanes is not None:
            raise ReferenceFileError(
                f"T{what[1:]} is closed round its length, and a panel cannot go round: cut it both ways, with a grid."
            )
        belt = find_belt(surface, source, tolerance)
        if belt is not None:
            _require_square(seams, what)
            return Girdling(surface=surface, belt=belt, source=source, what=what, tolerance=tolerance)
    if lanes is not None and seams == "square":
        return Lengthwise(lanes=lanes, what=what, tolerance=tolerance)
    strip = find_strip(surface, source, tolerance)
    planes = seam_planes(seams, strip, surface, most_turn, what)
    return Across(surface=surface, strip=strip, planes=planes, source=source, what=what, tolerance=tolerance)


def _require_square(seams: Seams, what: str) -> None:
    if seams != "square":
        raise ReferenceFileError(f"T{what[1:]} closes to a ring, which is cut right across: ask for square seams.")


def _require_parts(count: int, what: str) -> None:
    if count == 1:
        raise ReferenceFileError(
            f"T{what[1:]} closes to a ring, and a panel cannot go round: divide it into a number of panels, 2 or more."
        )


def _require_room(edges: Array, count: int, what: str, tolerance: float) -> None:
    """Refuse more panels than there is room for between two long edges, (2, q, 3) points."""
    lengths = [float(arc_length(edge)[-1]) for edge in edges]
    require_room(lengths, float(norm(edges[1] - edges[0]).min()), count, what, tolerance)
