"""What is drawn beside solids: flat patterns as faces, and the edges of a skin that lie on a seam."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Edge, TopoDS_Shape, TopoDS_Shell, TopoDS_Vertex
from OCP.TopTools import TopTools_IndexedMapOfShape

from cadpanel.arrays import Array
from cadpanel.brep.building.edges import face_on, line_edge, turned_edge, vertex_at
from cadpanel.brep.building.surfaces import plane_surface
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.geometry.biarcs import all_but_straight, arc_circle

_UP = np.array([0.0, 0.0, 1.0])
_ACROSS = np.array([1.0, 0.0, 0.0])
NO_HOLES = np.empty((0, 3))
# A corner of a panel and the vertex that was built there are nearer than this, mm.
_SAME = 1e-6


def flat_face(contour: Array, lines: Array, holes: Array = NO_HOLES) -> TopoDS_Compound:
    """A flat part in the plane z = 0: its face, seen from above, and lines on it.

    Args:
        contour: (v, 3) a closed chain of arcs, counterclockwise: the start of each in mm, and its bulge.
        lines: (m, 2, 2) ends of the lines, mm.
        holes: (h, 3) middles and diameters of round holes in the face, mm.
    """
    corners = _in_space(contour[:, :2])
    vertices = [vertex_at(corner) for corner in corners]
    after = [*range(1, len(corners)), 0]
    loop = [_arc(vertices[i], vertices[j], corners[i], corners[j], float(contour[i, 2])) for i, j in enumerate(after)]
    plane = plane_surface(corners[0], _UP, _ACROSS)
    drawn: list[TopoDS_Shape] = [face_on(plane.surface, plane.agrees, loop, [[_rim(hole)] for hole in holes])]
    for start, stop in zip(_in_space(lines[:, 0]), _in_space(lines[:, 1]), strict=True):
        drawn.append(line_edge(vertex_at(start), vertex_at(stop), start, stop))
    return compound_of(drawn)


def edges_along(skins: Sequence[tuple[TopoDS_Shell, Array]]) -> TopoDS_Compound:
    """Of every skin the edges from corner to corner along a row of corners (m, 3), mm.

    Raises:
        ValueError: there is no edge between two of them.
    """
    return compound_of(edge for skin, row in skins for edge in _along(skin, row))


def _along(skin: TopoDS_Shell, row: Array) -> list[TopoDS_Edge]:
    known = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(skin, TopAbs_EDGE, known)
    edges = [TopoDS.Edge_s(known.FindKey(index)) for index in range(1, known.Extent() + 1)]
    ends = np.array([[_place(TopExp.FirstVertex_s(edge)), _place(TopExp.LastVertex_s(edge))] for edge in edges])
    found = []
    for piece in np.stack([row[:-1], row[1:]], axis=1):
        off = np.minimum(np.abs(ends - piece).max(axis=(1, 2)), np.abs(ends - piece[::-1]).max(axis=(1, 2)))
        nearest = int(off.argmin())
        if off[nearest] > _SAME:
            raise ValueError(f"the skin has no edge between {piece[0]} and {piece[1]}")
        found.append(edges[nearest])
    return found


def rim_places(holes: Array) -> Array:
    """(h, 3) where the rim of each hole (h, 3) begins and ends, mm."""
    return _in_space(holes[:, :2] + np.multiply.outer(0.5 * holes[:, 2], _ACROSS[:2]))


def _rim(hole: Array) -> TopoDS_Edge:
    """The circle round a hole, clockwise from above, as the face lies outside of it."""
    (start,) = rim_places(hole[None])
    vertex = vertex_at(start)
    return turned_edge(vertex, vertex, np.append(hole[:2], 0.0), start, -_UP, 2.0 * math.pi)


def _arc(first: TopoDS_Vertex, last: TopoDS_Vertex, start: Array, stop: Array, bulge: float) -> TopoDS_Edge:
    if all_but_straight(start[:2], stop[:2], bulge):
        return line_edge(first, last, start, stop)
    center, _ = arc_circle(start[:2], stop[:2], bulge)
    turn = _UP if bulge > 0.0 else -_UP
    return turned_edge(first, last, np.append(center, 0.0), start, turn, 4.0 * math.atan(abs(bulge)))


def _in_space(points: Array) -> Array:
    return np.concatenate([points, np.zeros((len(points), 1))], axis=1)


def _place(vertex: TopoDS_Vertex) -> tuple[float, float, float]:
    found: tuple[float, float, float] = BRep_Tool.Pnt_s(vertex).Coord()
    return found
