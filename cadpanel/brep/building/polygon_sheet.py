"""A planar polygon as an exact face, and its sheet as a prism whose walls stand as its posts do."""

from __future__ import annotations

import numpy as np
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex

from cadpanel.arrays import Array
from cadpanel.brep.building import edges, surfaces
from cadpanel.brep.building.sheet_faces import SheetFaces
from cadpanel.geometry.shape import PolygonShape


class _Level:
    """One of the two faces of the sheet: corners, vertices and edges, each from its corner to the next."""

    def __init__(self, shape: PolygonShape) -> None:
        self.corners: Array = shape.outline
        self.vertices: list[TopoDS_Vertex] = [edges.vertex_at(corner) for corner in self.corners]
        count = len(self.corners)
        self.edges: list[TopoDS_Edge] = [
            edges.line_edge(
                self.vertices[i], self.vertices[(i + 1) % count], self.corners[i], self.corners[(i + 1) % count]
            )
            for i in range(count)
        ]
        plane = surfaces.plane_surface(self.corners[0], shape.normal, self.corners[1] - self.corners[0])
        self.face: TopoDS_Face = edges.face_on(plane.surface, plane.agrees, self.edges)


def polygon_sheet(near: PolygonShape, far: PolygonShape) -> SheetFaces:
    """The face of the skin `near`, and the faces of the sheet between it and the parallel polygon `far`."""
    skin, other = _Level(near), _Level(far)
    skin_is_top = float((near.outline[0] - far.outline[0]) @ near.normal) > 0.0
    top, bottom = (skin, other) if skin_is_top else (other, skin)
    below = TopoDS.Face_s(bottom.face.Reversed())
    own, away = (top.face, below) if skin_is_top else (below, top.face)
    return SheetFaces([skin.face], [own], [away], _walls(top, bottom))


def polygon_skin(shape: PolygonShape) -> list[TopoDS_Face]:
    """The polygon as one face, its normal outwards."""
    return [_Level(shape).face]


def _walls(top: _Level, bottom: _Level) -> list[TopoDS_Face]:
    count = len(top.corners)
    posts = [
        edges.line_edge(bottom.vertices[i], top.vertices[i], bottom.corners[i], top.corners[i]) for i in range(count)
    ]
    walls = []
    for i in range(count):
        after = (i + 1) % count
        # Counterclockwise about the way out: along the bottom edge, up, back along the top, down.
        loop: list[TopoDS_Shape] = [bottom.edges[i], posts[after], top.edges[i].Reversed(), posts[i].Reversed()]
        along = bottom.corners[after] - bottom.corners[i]
        up = 0.5 * (top.corners[i] + top.corners[after] - bottom.corners[i] - bottom.corners[after])
        wall = surfaces.plane_surface(bottom.corners[i], np.cross(along, up), along)
        walls.append(edges.face_on(wall.surface, wall.agrees, loop))
    return walls
