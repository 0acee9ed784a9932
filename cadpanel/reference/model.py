"""What is to be approximated, as arrays only: panels of sampled faces, their outlines, and who meets whom.

All lengths are in millimetres, in the coordinates of the file.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
class PanelReference:
    """One panel's reference: samples, and an outline of four sides, two ends across the fold and two along it.

    The panel is walked from side 0 to side 1 (across the fold, direction b) and from end 0 to end 1 (along the fold,
    direction t); normals n point to the convex side and t x n = b in the mean.

    Attributes:
        name: the panel's stable name.
        points: (m, 3) samples over all faces, mm.
        normals: (m, 3) unit normals, all on the convex (outer) side.
        weights: (m,) area that each sample stands for, mm^2.
        ends: two polylines (q, 3), end 0 and end 1, each from side 0 to side 1, mm.
        end_normals: (q, 3) unit normals at the points of `ends`.
        sides: two polylines (q, 3), side 0 and side 1 (the long free edges), each from end 0 to end 1, mm.
    """

    name: str
    points: Array
    normals: Array
    weights: Array
    ends: tuple[Array, Array]
    end_normals: tuple[Array, Array]
    sides: tuple[Array, Array]

    @property
    def corners(self) -> Array:
        """(2, 2, 3) the outline's corners, indexed [end, side], mm."""
        return np.array([[end[0], end[-1]] for end in self.ends])

    @property
    def length(self) -> float:
        """Mean distance between the two ends, measured along the two sides' chords, mm."""
        return float(np.linalg.norm(self.corners[1] - self.corners[0], axis=-1).mean())


@dataclass(frozen=True, slots=True, kw_only=True)
class Seam:
    """Two panels that meet end to end.

    Attributes:
        panels: indices of the two panels.
        ends: which end (0 or 1) of each panel lies on the seam.
        reversed: True where side 0 of the first panel meets side 1 of the second.
    """

    panels: tuple[int, int]
    ends: tuple[int, int]
    reversed: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """All panels of one reference and the seams between them, found by geometry.

    Attributes:
        source: name of the file.
        panels: in the order of the file.
        seams: which panels meet, end to end.
        seam_tolerance: how far the ends of two panels that meet were allowed to lie apart, mm.
    """

    source: str
    panels: tuple[PanelReference, ...]
    seams: tuple[Seam, ...]
    seam_tolerance: float = 1.0
