"""Round holes through a sheet, square to it: cylinders through flat patches, walls of normals through round ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface, Geom_Surface
from OCP.Geom2d import Geom2d_Line
from OCP.gp import gp_Circ
from OCP.TopAbs import TopAbs_FORWARD
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex, TopoDS_Wire

from cadpanel.arrays import Array
from cadpanel.brep.building import edges
from cadpanel.brep.building.interpolation import interpolate
from cadpanel.brep.building.normal_walls import normal_strip
from cadpanel.brep.building.sheet_faces import SheetFaces
from cadpanel.brep.building.surfaces import plane_spline
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.shapes import children
from cadpanel.geometry.fixings import Hole

_BUILDER = BRep_Builder()
_HALVES = ((0.0, math.pi), (math.pi, 2.0 * math.pi))
"""A wall is two faces, so that none of them closes on itself."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Drilled:
    """What a hole adds: its rims, in the way that they turn about the way to the far face, and its wall."""

    near: tuple[TopoDS_Edge, TopoDS_Edge]
    far: tuple[TopoDS_Edge, TopoDS_Edge]
    walls: tuple[TopoDS_Face, TopoDS_Face]


def drilled(faces: SheetFaces, holes: Sequence[Hole], depth: float) -> SheetFaces:
    """The faces of a sheet with holes; those of the skin itself stay whole.

    Args:
        faces: of the sheet.
        holes: clear of each other, and inside of their patches.
        depth: where the other face lies, mm along the skin's normals.
    """
    near, far, walls = list(faces.near), list(faces.far), list(faces.walls)
    for hole in holes:
        surfaces = tuple(BRep_Tool.Surface_s(side[hole.patch]) for side in (near, far))
        made = _through_plane(hole, depth) if hole.place.frame is None else _through_round(hole, depth, *surfaces)
        near[hole.patch] = _with_hole(near[hole.patch], list(made.near))
        far[hole.patch] = _with_hole(far[hole.patch], [edge.Reversed() for edge in reversed(made.far)])
        walls += made.walls
    return SheetFaces(faces.skin, near, far, walls)


def _with_hole(face: TopoDS_Face, loop: Sequence[TopoDS_Shape]) -> TopoDS_Face:
    """The face without what lies inside of a loop that runs clockwise about its normal."""
    forward = face.Orientation() == TopAbs_FORWARD
    found = TopoDS.Face_s(face.Oriented(TopAbs_FORWARD).EmptyCopied())
    for wire in children(face.Oriented(TopAbs_FORWARD), oriented=True):
        _BUILDER.Add(found, wire)
    wire = TopoDS_Wire()
    _BUILDER.MakeWire(wire)
    for edge in loop:
        _BUILDER.Add(wire, edge)
    wire.Closed(True)
    _BUILDER.Add(found, wire if forward else wire.Reversed())
    return TopoDS.Face_s(found.Oriented(face.Orientation()))


def _through_plane(hole: Hole, depth: float) -> _Drilled:
    (middle,), (normal,) = hole.place.on_skin(hole.middle[None])
    way, thickness, radius = math.copysign(1.0, depth) * normal, abs(depth), 0.5 * hole.diameter
    start = hole.place.direction
    levels = [middle, middle + depth * normal]
    vertices = [[edges.vertex_at(level + side * radius * start) for side in (1.0, -1.0)] for level in levels]
    rims = [
        tuple(
            edges.circle_edge(ends[half], ends[1 - half], gp_Circ(kernel.conic_frame(level, way, start), radius), *span)
            for half, span in enumerate(_HALVES)
        )
        for level, ends in zip(levels, vertices, strict=True)
    ]
    posts = _posts(vertices)
    # Each half has a surface of its own: on one for both, a post would lie at 0 and at a whole turn.
    walls = [
        _wall(
            Geom_CylindricalSurface(kernel.frame(middle, way, start), radius),
            thickness,
            half,
            (rims[0][half], rims[1][half]),
            posts,
            span,
        )
        for half, span in enumerate(_HALVES)
    ]
    return _Drilled(near=(rims[0][0], rims[0][1]), far=(rims[1][0], rims[1][1]), walls=(walls[0], walls[1]))


def _through_round(hole: Hole, depth: float, near: Geom_Surface, far: Geom_Surface) -> _Drilled:
    """The rims follow the circle, which is developed with the sheet, as closely as rounding lets a spline."""
    turn, radius = math.copysign(1.0, depth), 0.5 * hole.diameter

    def rim(parameters: Array) -> tuple[Array, Array]:
        ring = np.stack([np.cos(parameters), turn * np.sin(parameters)], axis=-1)
        points, normals = hole.place.on_skin(hole.middle + radius * ring)
        return points, normals

    strips = [normal_strip(rim, *span, depth, radius) for span in _HALVES]
    vertices = [
        [edges.vertex_at(side.poles[0]) for side in sides]
        for sides in ([strip.near for strip in strips], [strip.far for strip in strips])
    ]
    rims = [
        tuple(
            edges.spline_edge(ends[half], ends[1 - half], strip.near if level == 0 else strip.far)
            for half, strip in enumerate(strips)
        )
        for level, ends in enumerate(vertices)
    ]
    for level, surface in enumerate((near, far)):
        for half, span in enumerate(_HALVES):
            _lay_rim(rims[level][half], surface, rim, level * depth, span)
    posts = _posts(vertices)
    walls = [
        _wall(strip.surface(), strip.width, half, (rims[0][half], rims[1][half]), posts, span)
        for half, (strip, span) in enumerate(zip(strips, _HALVES, strict=True))
    ]
    return _Drilled(near=(rims[0][0], rims[0][1]), far=(rims[1][0], rims[1][1]), walls=(walls[0], walls[1]))


def _posts(vertices: Sequence[Sequence[TopoDS_Vertex]]) -> tuple[TopoDS_Edge, TopoDS_Edge]:
    """The two straight edges of a wall, from near to far."""
    first, second = (
        edges.line_edge(near, far, *(np.array(BRep_Tool.Pnt_s(end).Coord()) for end in (near, far)))
        for near, far in zip(*vertices, strict=True)
    )
    return first, second


def _wall(
    surface: Geom_Surface,
    width: float,
    half: int,
    rims: tuple[TopoDS_Edge, TopoDS_Edge],
    posts: tuple[TopoDS_Edge, TopoDS_Edge],
    span: tuple[float, float],
) -> TopoDS_Face:
    """Half of a wall, its normal towards the hole's middle; u turns about the way to the far face, v goes that way."""
    for rim, level in zip(rims, (0.0, width), strict=True):
        edges.lay_on_surface(rim, Geom2d_Line(kernel.point_2d(0.0, level), kernel.direction_2d(1.0, 0.0)), surface)
    begins, ends = posts[half], posts[1 - half]
    for post, u in zip((begins, ends), span, strict=True):
        edges.lay_on_surface(post, Geom2d_Line(kernel.point_2d(u, 0.0), kernel.direction_2d(0.0, 1.0)), surface)
    return edges.face_on(surface, False, [begins, rims[1], ends.Reversed(), rims[0].Reversed()])


def _lay_rim(
    edge: TopoDS_Edge,
    surface: Geom_Surface,
    rim: Callable[[Array], tuple[Array, Array]],
    lift: float,
    span: tuple[float, float],
) -> None:
    """Give half a rim its curve in the parameter plane of the cone or cylinder at a height over the skin."""
    assert isinstance(surface, (Geom_ConicalSurface, Geom_CylindricalSurface))
    axes = surface.Position()
    origin, *ways = (
        np.array(of.Coord()) for of in (axes.Location(), axes.XDirection(), axes.YDirection(), axes.Direction())
    )
    cosine = math.cos(surface.SemiAngle()) if isinstance(surface, Geom_ConicalSurface) else 1.0

    def parameters(places: Array) -> Array:
        points, normals = rim(places)
        x, y, z = ((points + lift * normals - origin) @ way for way in ways)
        # Patches lie about u = pi, so far from where angles jump.
        return np.stack([np.mod(np.arctan2(y, x), 2.0 * math.pi), z / cosine], axis=-1)

    radius = float(np.linalg.norm(rim(np.zeros(1))[0][0] - origin))
    weights = np.array([radius, 1.0])
    edges.lay_on_surface(edge, plane_spline(interpolate(parameters, *span, weights, radius)), surface)
