"""What is to be approximated, as arrays only: panels of sampled faces, their outlines, and who meets whom.

All lengths are in millimetres, in the coordinates of the file, less an origin where it lies far away.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from cadpanel.arrays import Array
from cadpanel.near import holds, panel_named
from cadpanel.reference.settings import ReferenceSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class FaceSamples:
    """One face of the reference as the CAD kernel sees it, before anything is made of it.

    Attributes:
        points: (m, 3) samples spread over the inside of the trimmed face, mm.
        normals: (m, 3) unit normals there; their side is the file's and may differ from face to face.
        weights: (m,) the area that each sample stands for, mm^2.
        edges: the face's boundary, one polyline an edge, (q, 3) points in order; q is odd and at least 33.
        edge_normals: (q, 3) this face's unit normals at the points of `edges`.
    """

    points: Array
    normals: Array
    weights: Array
    edges: tuple[Array, ...]
    edge_normals: tuple[Array, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RawPanel:
    """One top-level shape of the file: a panel's faces in file order."""

    name: str
    faces: tuple[FaceSamples, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning:
    """How the surface's normals turn along a panel's outline, radians.

    Attributes:
        across: from side 0 to side 1, the mean of both ends; positive where the panel is convex outwards.
        along: largest angle between any two normals on a side.
        to_and_fro: sum of all turning along the edge on which it is largest, whichever way it goes.
        slenderness: width of the panel over its length.
    """

    across: float
    along: float
    to_and_fro: float
    slenderness: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelReference:
    """One panel's reference: samples, and an outline of n edges.

    With four edges these are end 0, end 1, side 0 and side 1: the panel is walked from side 0 to side 1 (across the
    fold, direction b) and from end 0 to end 1 (along the fold, direction t); both ends run from side 0 to side 1, both
    sides from end 0 to end 1. With another number of edges they follow each other counterclockwise about the normals.
    Normals n point to the outside; that is the convex side of a fold, and the same side all over panels that meet.

    Attributes:
        name: the panel's stable name.
        points: (m, 3) samples over all faces, mm.
        normals: (m, 3) unit normals, all on the outer side.
        weights: (m,) area that each sample stands for, mm^2.
        edges: n polylines (q, 3), mm.
        edge_normals: n times the (q, 3) unit normals at the points of `edges`.
        turning: how the normals turn along the outline, None unless it has four edges.
    """

    name: str
    points: Array
    normals: Array
    weights: Array
    edges: tuple[Array, ...]
    edge_normals: tuple[Array, ...]
    turning: Turning | None = None

    def __repr__(self) -> str:
        return f"<PanelReference '{self.name}': {len(self.points)} samples, {len(self.edges)} edges>"

    @property
    def four_sided(self) -> bool:
        """Whether ends can be told from sides."""
        return len(self.edges) == 4

    @property
    def ends(self) -> tuple[Array, Array]:
        """End 0 and end 1 of a panel with four edges."""
        return self.edges[0], self.edges[1]

    @property
    def sides(self) -> tuple[Array, Array]:
        """Side 0 and side 1 of a panel with four edges."""
        return self.edges[2], self.edges[3]

    @property
    def corners(self) -> Array:
        """The outline's corners, mm: (2, 2, 3), indexed [end, side], of a panel with four edges; else (n, 3)."""
        if self.four_sided:
            return np.array([[end[0], end[-1]] for end in self.ends])
        return np.array([edge[0] for edge in self.edges])

    @property
    def length(self) -> float:
        """Mean length of the sides' chords, from end to end; where there are no ends, of all edges' chords, mm."""
        chords = self.sides if self.four_sided else self.edges
        return sum(math.dist(chord[0], chord[-1]) for chord in chords) / len(chords)


@dataclass(frozen=True, slots=True, kw_only=True)
class Seam:
    """Two panels that meet along an edge of each.

    Attributes:
        panels: indices of the two panels.
        edges: which edge of each panel lies on the seam.
        reversed: True where the two edges run against each other.
    """

    panels: tuple[int, int]
    edges: tuple[int, int]
    reversed: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """All panels of one reference and the seams between them, found by geometry.

    Attributes:
        source: name of the file.
        panels: in the order of the file.
        seams: which panels meet, edge to edge.
        seam_tolerance: how far the edges of two panels that meet were allowed to lie apart, mm.
        notes: what was mended, moved, guessed or left out on the way from the file, one sentence each.
        settings: how the file was read and cut.
        origin: what was taken off all coordinates of the file, mm.
    """

    source: str
    panels: tuple[PanelReference, ...]
    seams: tuple[Seam, ...]
    seam_tolerance: float = 1.0
    notes: tuple[str, ...] = ()
    settings: ReferenceSettings = field(default_factory=ReferenceSettings)
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __getitem__(self, name: str) -> PanelReference:
        return panel_named(name, self.panels)

    def __contains__(self, panel: object) -> bool:
        return holds(panel, self.panels)

    def __len__(self) -> int:
        return len(self.panels)

    def __iter__(self) -> Iterator[PanelReference]:
        return iter(self.panels)

    def __repr__(self) -> str:
        return f"<Reference '{self.source}': {len(self.panels)} panels, {len(self.seams)} seams>"
