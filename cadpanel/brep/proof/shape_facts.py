"""What a shape read from a file really is, as plain numbers: kinds of faces, validity, volume, straight edges, ends.

Nothing of the kernel is imported here: shapes are inspected in the second interpreter, and these numbers come back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.proof.boundary import Boundary
from cadpanel.geometry.curve_pieces import BoolArray, CurvePieces

FACE_KINDS = ("plane", "cone", "cylinder", "other")


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapeFacts:
    """What was measured on one shape that was read back.

    Attributes:
        name: the product's name.
        placed: (3,) where the origin of its coordinates lies in the file, mm; all else is told in its own coordinates.
        solids: number of solids in it.
        shells: number of shells in it.
        valid: whether the kernel's exact check passes.
        closed: whether every edge belongs to exactly two faces.
        face_kinds: number of faces of each of FACE_KINDS.
        volume: the kernel's volume, mm3; 0 for a shape without solids.
        areas: (f,) the kernel's area of every face, mm2.
        straight_edges: (m, 2, 3) ends of the straight edges that two known faces share, mm.
        edge_surfaces: (m, 2, 9) the two surfaces: point on axis or plane, axis or plane normal, radius, half angle,
            and +1 or -1 by which the surface's own normal becomes the face's. A plane has radius 0.
        vertices: (v, 3) mm.
        pieces: the edges that are lines or ellipses.
        piece_ends: (e, 2, 3) their two end vertices, mm.
        piece_faces: (e, 2) the faces on which they lie; -1 in the place of a second one that is not there.
        other_edges: (o, 2) the same for the edges that are neither.
        surfaces: (f, 9) the surface of each face, as in `edge_surfaces`; not numbers where it is of another kind.
        boundary: all that bounds it.
    """

    name: str
    placed: Array
    solids: int
    shells: int
    valid: bool
    closed: bool
    face_kinds: dict[str, int]
    volume: float
    areas: Array
    straight_edges: Array
    edge_surfaces: Array
    vertices: Array
    pieces: CurvePieces
    piece_ends: Array
    piece_faces: IntArray
    other_edges: IntArray
    surfaces: Array
    boundary: Boundary

    @property
    def border(self) -> BoolArray:
        """(e,) which of the pieces bound the shape."""
        return np.asarray(self.piece_faces[:, 1] < 0)

    @property
    def other_borders(self) -> int:
        """Number of boundary edges that are neither lines nor ellipses."""
        return int((self.other_edges[:, 1] < 0).sum())
