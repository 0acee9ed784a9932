"""What a shape read from a file really is, as plain numbers: kinds of faces, validity, volume, straight edges, ends.

Nothing of the kernel is imported here: shapes are inspected in the second interpreter, and these numbers come back.
"""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.arrays import Array
from cadpanel.geometry.curve_hausdorff import CurvePieces

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
        planes: (f, 6) location and normal of its plane; nothing but 0 for other faces.
        straight_edges: (m, 2, 3) ends of the straight edges that two known faces share, mm.
        edge_surfaces: (m, 2, 9) the two surfaces: point on axis or plane, axis or plane normal, radius, half angle,
            and +1 or -1 by which the surface's own normal becomes the face's. A plane has radius 0.
        vertices: (v, 3) mm.
        border: boundary edges that are lines or ellipses.
        border_ends: (b, 2, 3) their two end vertices, mm.
        other_borders: number of boundary edges that are neither.
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
    planes: Array
    straight_edges: Array
    edge_surfaces: Array
    vertices: Array
    border: CurvePieces
    border_ends: Array
    other_borders: int
