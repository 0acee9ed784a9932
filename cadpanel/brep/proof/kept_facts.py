"""What a shape that an archive keeps really is, in a few plain numbers. Nothing of the kernel is imported."""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class KeptFacts:
    """What was measured on one shape.

    Attributes:
        solids, faces, edges: how many there are.
        volume: of the solids, mm3; 0 without any.
        area: of the faces where there is no solid, mm2: it takes the kernel longer than all the rest.
        vertices: (v, 3) mm.
        triangles: whether it brings triangles, or polygons of edges, to be shown by.
        triangles_fault: what is wrong with these, as the rest of a sentence; empty if nothing is.
    """

    solids: int
    faces: int
    edges: int
    volume: float
    area: float
    vertices: Array
    triangles: bool
    triangles_fault: str
