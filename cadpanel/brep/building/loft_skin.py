"""A loft as an open shell: planes, cylinders and cones where it is such, ruled B-spline faces elsewhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.Geom import (
    Geom_BSplineCurve,
    Geom_BSplineSurface,
    Geom_ConicalSurface,
    Geom_CylindricalSurface,
    Geom_Surface,
)
from OCP.Geom2d import Geom2d_Curve, Geom2d_Line
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shell, TopoDS_Vertex
from scipy.interpolate import BSpline, make_interp_spline

from cadpanel.arrays import Array
from cadpanel.brep.building.edges import face_on, lay_on_surface, line_edge, shell_of, vertex_at
from cadpanel.brep.building.surfaces import plane_surface
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.splines import knot_arrays, pole_array, pole_grid, spline_curve
from cadpanel.lofting.kinds import Flat, Kind, Round
from cadpanel.lofting.loft import Loft
from cadpanel.lofting.pieces import DEGREE, Piece

_BUILDER = BRep_Builder()
_ENDS = np.array([0.0, 1.0])


@dataclass(frozen=True, slots=True)
class _Ruling:
    """The edge of a ruling from A to B, with its vertices and places."""

    edge: TopoDS_Edge
    vertices: tuple[TopoDS_Vertex, TopoDS_Vertex]
    ends: Array


def build_loft(loft: Loft) -> TopoDS_Shell:
    """The loft as a shell whose faces share their rulings, normals along A'(u) x (B - A)."""
    faces: list[TopoDS_Face] = []
    pieces, kinds = loft.pieces, loft.faces
    places = [_ends(piece, kind) for piece, kind in zip(pieces, kinds, strict=True)]
    before = _ruling(places[0][0], (None, None))
    for number, (piece, kind) in enumerate(zip(pieces, kinds, strict=True)):
        shared: list[TopoDS_Vertex | None] = [None, None]
        if piece.apex is not None:
            shared[piece.apex] = before.vertices[piece.apex]
        after = _ruling(places[number][1], (shared[0], shared[1]))
        faces.append(_face(piece, kind, before, after))
        before = after
    return shell_of(faces)


def _ends(piece: Piece, kind: Kind) -> Array:
    """(2, 2, 3) the ends of its first and last ruling; on the very surface where that is round."""
    ends = np.stack([np.asarray(edge(_ENDS)) for edge in piece.edges], axis=1)
    if isinstance(kind, Round):
        return np.array([kind.points(kind.parameters(pair)) for pair in ends])
    return ends


def _ruling(ends: Array, shared: tuple[TopoDS_Vertex | None, TopoDS_Vertex | None]) -> _Ruling:
    first, last = (vertex_at(end) if known is None else known for end, known in zip(ends, shared, strict=True))
    return _Ruling(line_edge(first, last, *ends), (first, last), ends)


def _face(piece: Piece, kind: Kind, before: _Ruling, after: _Ruling) -> TopoDS_Face:
    """One face: along A, the last ruling, back along B, back along the first ruling."""
    surface, agrees = _surface(piece, kind)
    rails: list[TopoDS_Edge | None] = []
    for side, edge in enumerate(piece.edges):
        if piece.apex == side:
            rails.append(None)
            continue
        curve, laid = _rail(edge, kind, float(side))
        vertices = before.vertices[side], after.vertices[side]
        made = _spline_edge(curve, *vertices)
        if laid is not None:
            lay_on_surface(made, laid, surface)
        rails.append(made)
    for ruling, u in ((before, 0.0), (after, 1.0)):
        laid = _ruling_on(kind, ruling, u)
        if laid is not None:
            lay_on_surface(ruling.edge, laid, surface)
    along, back = rails
    loop = [
        *([] if along is None else [along]),
        after.edge,
        *([] if back is None else [back.Reversed()]),
        before.edge.Reversed(),
    ]
    return face_on(surface, agrees, loop)


def _surface(piece: Piece, kind: Kind) -> tuple[Geom_Surface, bool]:
    """The kernel's surface, and whether its own normal is the wanted one."""
    normal = piece.normals(np.array([0.5]))[0]
    if isinstance(kind, Flat):
        a, b = (np.asarray(edge(0.5)) for edge in piece.edges)
        return plane_surface(kind.point, normal, b - a).surface, True
    if isinstance(kind, Round):
        axes = kernel.frame(kind.origin, kind.axis, kind.across)
        middle = np.mean([np.asarray(edge(0.5)) for edge in piece.edges], axis=0)
        to = middle - kind.origin
        out = to - (to @ kind.axis) * kind.axis
        surface = (
            Geom_ConicalSurface(axes, kind.half_angle, kind.radius)
            if kind.half_angle
            else Geom_CylindricalSurface(axes, kind.radius)
        )
        return surface, bool(out @ normal > 0.0)
    a, b = (edge.c for edge in piece.edges)
    knots, counts = knot_arrays(piece.edges[0].t)
    across = knot_arrays(np.array([0.0, 0.0, 1.0, 1.0]))
    poles = pole_grid(np.stack([np.asarray(a), np.asarray(b)], axis=1))
    return Geom_BSplineSurface(poles, knots, across[0], counts, across[1], DEGREE, 1), True


def _rail(edge: BSpline, kind: Kind, v: float) -> tuple[BSpline, Geom2d_Curve | None]:
    """The curve of a rail in space, and in the parameter plane of its surface."""
    if isinstance(kind, Round):
        u = np.unique(edge.t)
        u = np.sort(np.concatenate([u, 0.5 * (u[1:] + u[:-1])]))
        flat = kind.parameters(np.asarray(edge(u)))
        laid = make_interp_spline(u, flat, k=DEGREE)
        return make_interp_spline(u, kind.points(flat), k=DEGREE), spline_curve(laid)
    return edge, None if isinstance(kind, Flat) else Geom2d_Line(kernel.point_2d(0.0, v), kernel.direction_2d(1.0, 0.0))


def _ruling_on(kind: Kind, ruling: _Ruling, u: float) -> Geom2d_Curve | None:
    """The ruling in the parameter plane: with the length from A on as its parameter."""
    if isinstance(kind, Flat):
        return None
    length = float(np.linalg.norm(ruling.ends[1] - ruling.ends[0]))
    ends = np.array([[u, 0.0], [u, 1.0]])
    if isinstance(kind, Round):
        ends = kind.parameters(ruling.ends)
    return spline_curve(BSpline(np.array([0.0, 0.0, length, length]), ends, 1))


def _spline_edge(curve: BSpline, first: TopoDS_Vertex, last: TopoDS_Vertex) -> TopoDS_Edge:
    edge = TopoDS_Edge()
    made = Geom_BSplineCurve(pole_array(np.asarray(curve.c)), *knot_arrays(curve.t), int(curve.k))
    _BUILDER.MakeEdge(edge, made, kernel.TOLERANCE)
    _BUILDER.Add(edge, first.Oriented(TopAbs_FORWARD))
    _BUILDER.Add(edge, last.Oriented(TopAbs_REVERSED))
    _BUILDER.Range(edge, float(curve.t[0]), float(curve.t[-1]))
    return edge
