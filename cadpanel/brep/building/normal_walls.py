"""Walls of normals: what a square cut through a flat sheet becomes where the sheet is rolled round."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_BSplineSurface, Geom_Surface
from OCP.Geom2d import Geom2d_Curve, Geom2d_Line
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.building import edges
from cadpanel.brep.building.interpolation import DEGREE, Interpolant, interpolate
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.splines import integer_array, pole_grid, real_array
from cadpanel.geometry.cone_sections import AxisFrame, EllipticSection, lifted
from cadpanel.geometry.plane_sides import SideCurve
from cadpanel.geometry.vectors import cross

_EVERY = np.ones(6)


@dataclass(frozen=True, slots=True, kw_only=True)
class NormalStrip:
    """The strip of a skin's normals along a curve on it, from the skin to the sheet's other face.

    Attributes:
        near, far: the splines along both of its long edges, with the same parameter.
        width: how far apart they are, mm: the sheet's thickness.
    """

    near: Interpolant
    far: Interpolant
    width: float

    def surface(self) -> Geom_Surface:
        """Ruled: u is the parameter of the splines, v counts mm from near to far."""
        rows = pole_grid(np.stack([self.near.poles, self.far.poles], axis=1))
        across: IntArray = np.array([2, 2], dtype=np.intp)
        knots, counts = self.near.kernel_knots()
        levels = real_array(np.array([0.0, self.width]))
        return Geom_BSplineSurface(rows, knots, levels, counts, integer_array(across), DEGREE, 1)


def normal_strip(
    points_and_normals: Callable[[Array], tuple[Array, Array]], start: float, stop: float, depth: float, size: float
) -> NormalStrip:
    """The strip along a curve.

    Args:
        points_and_normals: from parameters (m,) to points of the skin and its unit normals there, (m, 3) each.
        start: the curve's first parameter.
        stop: its last one.
        depth: where the other face lies, mm along the normals.
        size: of what the curve bends about, mm.
    """

    def both(parameters: Array) -> Array:
        points, normals = points_and_normals(parameters)
        return np.concatenate([points, points + depth * normals], axis=1)

    found = interpolate(both, start, stop, _EVERY, size)
    near, far = (found._replace(poles=found.poles[:, part]) for part in (slice(3), slice(3, 6)))
    return NormalStrip(near=near, far=far, width=abs(depth))


def strip_along_arc(frame: AxisFrame, section: EllipticSection, depth: float) -> NormalStrip:
    """The strip along an arc of ellipse on a cone, with its parameter."""

    def at(parameters: Array) -> tuple[Array, Array]:
        return section.points(parameters), frame.normals(section.sweep_angles(parameters))

    return normal_strip(at, section.start, section.stop, depth, abs(frame.level_radius))


def strip_along_side(curve: SideCurve, lift: float) -> NormalStrip:
    """The strip along a side that stands in a plane, of which `curve` is on the other face, from the skin at `lift`.

    Its parameter is the height.
    """
    skin = lifted(curve.frame, lift)

    def at(heights: Array) -> tuple[Array, Array]:
        angles = curve.angles(heights)
        return skin.points(angles, heights), skin.normals(angles)

    low, high = curve.heights.tolist()
    return normal_strip(at, low, high, -lift, abs(skin.level_radius))


def strip_wall(
    strip: NormalStrip,
    loop: Sequence[TopoDS_Shape],
    along: tuple[TopoDS_Edge, TopoDS_Edge],
    posts: tuple[TopoDS_Edge, TopoDS_Edge],
    outward: Array,
) -> TopoDS_Face:
    """The face on a strip inside a loop of oriented edges that runs counterclockwise about the way out.

    Args:
        strip: its surface.
        loop: the edges in their order.
        along: those of them at near and far, with the strip's parameter.
        posts: those across it, at its first and its last parameter.
        outward: (3,) out of the sheet, about half way along.
    """
    surface = strip.surface()
    for edge, level in zip(along, (0.0, strip.width), strict=True):
        edges.lay_on_surface(edge, _line(0.0, level, 1.0, 0.0), surface)
    for post, place, row in zip(posts, strip.near.knots[[0, -1]].tolist(), (0, -1), strict=True):
        begins = np.array(BRep_Tool.Pnt_s(TopExp.FirstVertex_s(post)).Coord())
        ends = np.stack([strip.near.poles[row], strip.far.poles[row]])
        from_far = bool(np.linalg.norm(ends - begins, axis=-1).argmin())
        edges.lay_on_surface(
            post, _line(place, strip.width, 0.0, -1.0) if from_far else _line(place, 0.0, 0.0, 1.0), surface
        )
    middle = 0.5 * float(strip.near.knots[[0, -1]].sum())
    point, by_u, by_v = gp_Pnt(), gp_Vec(), gp_Vec()
    surface.D1(middle, 0.5 * strip.width, point, by_u, by_v)
    turned = cross(np.array(by_u.Coord()), np.array(by_v.Coord()))
    return edges.face_on(surface, bool(turned @ outward > 0.0), loop)


def _line(u: float, v: float, along_u: float, along_v: float) -> Geom2d_Curve:
    return Geom2d_Line(kernel.point_2d(u, v), kernel.direction_2d(along_u, along_v))
