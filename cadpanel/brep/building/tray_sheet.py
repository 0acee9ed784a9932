"""A folded flat panel as exact faces: its flat part, and of each fold a cylinder and a plane; and the sheet's walls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_CylindricalSurface
from OCP.Geom2d import Geom2d_Line
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex

from cadpanel.arrays import Array
from cadpanel.brep.building import edges, surfaces
from cadpanel.brep.building.sheet_faces import SheetFaces
from cadpanel.brep.kernel import points as kernel
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.vectors import cross


@dataclass(frozen=True, slots=True, kw_only=True)
class _Piece:
    """One edge of a level's outline, from its start to its stop; of an arc the axis about which it turns.

    Attributes:
        edge: in the way of the outline.
        start, stop: its ends.
        center, turn: of an arc about a relief's axis or a fold's; None of a straight one.
        relief: whether its wall is round.
    """

    edge: TopoDS_Edge
    start: TopoDS_Vertex
    stop: TopoDS_Vertex
    center: Array | None = None
    turn: Array | None = None
    relief: bool = False


class _Level:
    """One of the two faces of the sheet: faces with normals outwards, and the outline in its order."""

    def __init__(self, shape: TrayShape) -> None:
        self.shape = shape
        plan, lift = shape.plan, shape.lift * shape.plan.normal
        self.starts, self.stops = plan.starts + lift, plan.stops + lift
        self.corners = plan.corners + lift
        self.outline: list[_Piece] = []
        self.folds: list[TopoDS_Face] = []
        ends = [_vertices(of) for of in zip(self.starts, self.stops, strict=True)]
        # Where there is no relief one edge begins in the vertex in which the other ends.
        self.ends = [
            (first if plan.reliefs[edge] > 0.0 else ends[edge - 1][1], last) for edge, (first, last) in enumerate(ends)
        ]
        loop: list[TopoDS_Shape] = []
        for edge in range(len(ends)):
            if plan.reliefs[edge] > 0.0:
                loop.append(self._relief(edge))
            first, last = self.ends[edge]
            line = edges.line_edge(first, last, self.starts[edge], self.stops[edge])
            loop.append(line)
            if plan.folded[edge]:
                self._fold(edge, line)
            else:
                self.outline.append(_Piece(edge=line, start=first, stop=last))
        plane = surfaces.plane_surface(self.corners[0], plan.normal, plan.along[0])
        self.faces = [edges.face_on(plane.surface, plane.agrees, loop), *self.folds]

    def _relief(self, edge: int) -> TopoDS_Edge:
        plan = self.shape.plan
        first, last = self.ends[edge - 1][1], self.ends[edge][0]
        center, turn, sweep = self.corners[edge], -plan.normal, float(plan.openings[edge])
        arc = edges.turned_edge(first, last, center, self.stops[edge - 1], turn, sweep)
        self.outline.append(_Piece(edge=arc, start=first, stop=last, center=center, turn=turn, relief=True))
        return arc

    def _fold(self, edge: int, line: TopoDS_Edge) -> None:
        """The cylinder and the leg beyond an edge, and their part of the outline."""
        plan, radius = self.shape.plan, self.shape.radius
        along, away, onwards = plan.along[edge], plan.away[edge], plan.onwards[edge]
        axis = [point - radius * plan.normal for point in (self.starts[edge], self.stops[edge])]
        bent = [point + radius * away for point in axis]
        tips = [point + float(plan.legs[edge]) * onwards for point in bent]
        (a, d), (b, c), (e, f) = self.ends[edge], _vertices(bent), _vertices(tips)
        sweep = float(plan.angles[edge])
        first = edges.turned_edge(a, b, axis[0], self.starts[edge], along, sweep)
        last = edges.turned_edge(c, d, axis[1], bent[1], -along, sweep)
        crease = edges.line_edge(b, c, *bent)
        down, tip, up = (
            edges.line_edge(b, e, bent[0], tips[0]),
            edges.line_edge(e, f, *tips),
            edges.line_edge(f, c, tips[1], bent[1]),
        )
        cylinder = Geom_CylindricalSurface(kernel.frame(axis[0], along, plan.normal), radius)
        long = float(plan.lengths[edge])
        for own, place in (
            (line, (0.0, 0.0, 0.0, 1.0)),
            (crease, (sweep, 0.0, 0.0, 1.0)),
            (first, (0.0, 0.0, 1.0, 0.0)),
            (last, (sweep, long, -1.0, 0.0)),
        ):
            edges.lay_on_surface(own, _line(*place), cylinder)
        leg = surfaces.plane_surface(bent[0], away, along)
        self.folds += [
            edges.face_on(cylinder, True, [first, crease, last, line.Reversed()]),
            edges.face_on(leg.surface, leg.agrees, [down, tip, up, crease.Reversed()]),
        ]
        self.outline += [
            _Piece(edge=first, start=a, stop=b, center=axis[0], turn=along),
            _Piece(edge=down, start=b, stop=e),
            _Piece(edge=tip, start=e, stop=f),
            _Piece(edge=up, start=f, stop=c),
            _Piece(edge=last, start=c, stop=d, center=axis[1], turn=-along),
        ]


def tray_sheet(near: TrayShape, far: TrayShape) -> SheetFaces:
    """The faces of the skin `near`, and of the sheet between it and the parallel skin `far`."""
    skin, other = _Level(near), _Level(far)
    skin_is_top = near.lift > far.lift
    top, bottom = (skin, other) if skin_is_top else (other, skin)
    below = [TopoDS.Face_s(face.Reversed()) for face in bottom.faces]
    own, away = (top.faces, below) if skin_is_top else (below, top.faces)
    return SheetFaces(skin.faces, own, away, _walls(top, bottom))


def tray_skin(shape: TrayShape) -> list[TopoDS_Face]:
    """The faces of a skin, normals outwards."""
    return _Level(shape).faces


def _walls(top: _Level, bottom: _Level) -> list[TopoDS_Face]:
    count = len(top.outline)
    posts = [_post(below.start, above.start) for below, above in zip(bottom.outline, top.outline, strict=True)]
    walls = []
    for i, (below, above) in enumerate(zip(bottom.outline, top.outline, strict=True)):
        before, after = posts[i], posts[(i + 1) % count]
        # Counterclockwise about the way out: along the bottom edge, up, back along the top, down.
        loop: list[TopoDS_Shape] = [below.edge, after, above.edge.Reversed(), before.Reversed()]
        corners = [_place(vertex) for vertex in (below.start, below.stop, above.start, above.stop)]
        if below.relief:
            walls.append(_relief_wall(below, above, (before, after), loop, corners))
            continue
        out = cross(corners[1] - corners[0], 0.5 * (corners[2] + corners[3] - corners[0] - corners[1]))
        wall = surfaces.plane_surface(corners[0], out, corners[1] - corners[0])
        walls.append(edges.face_on(wall.surface, wall.agrees, loop))
    return walls


def _relief_wall(
    below: _Piece,
    above: _Piece,
    posts: tuple[TopoDS_Edge, TopoDS_Edge],
    loop: Sequence[TopoDS_Shape],
    corners: Sequence[Array],
) -> TopoDS_Face:
    """The round wall of a relief, which looks towards its axis; u follows the arcs, v goes down the sheet."""
    assert above.center is not None
    assert above.turn is not None
    start = corners[2] - above.center
    radius, depth = float(np.linalg.norm(start)), float((corners[0] - corners[2]) @ above.turn)
    surface = Geom_CylindricalSurface(kernel.frame(above.center, above.turn, start), radius)
    edges.lay_on_surface(above.edge, _line(0.0, 0.0, 1.0, 0.0), surface)
    edges.lay_on_surface(below.edge, _line(0.0, depth, 1.0, 0.0), surface)
    sweep = BRep_Tool.Range_s(above.edge)[1]
    for post, u in zip(posts, (0.0, sweep), strict=True):
        edges.lay_on_surface(post, _line(u, depth, 0.0, -1.0), surface)
    return edges.face_on(surface, False, loop)


def _vertices(points: Sequence[Array]) -> tuple[TopoDS_Vertex, TopoDS_Vertex]:
    return edges.vertex_at(points[0]), edges.vertex_at(points[1])


def _post(below: TopoDS_Vertex, above: TopoDS_Vertex) -> TopoDS_Edge:
    return edges.line_edge(below, above, _place(below), _place(above))


def _place(vertex: TopoDS_Vertex) -> Array:
    return np.array(BRep_Tool.Pnt_s(vertex).Coord())


def _line(u: float, v: float, along_u: float, along_v: float) -> Geom2d_Line:
    return Geom2d_Line(kernel.point_2d(u, v), kernel.direction_2d(along_u, along_v))
