"""Exact kernel surfaces of patches and walls, and how a skin's arc looks in a cone's parameter plane."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface, Geom_Plane, Geom_Surface
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Curve, Geom2d_Line
from scipy.interpolate import BSpline

from cadpanel.arrays import Array
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.splines import integer_array, pole_array_2d, real_array
from cadpanel.geometry.cone_sections import AxisFrame, EllipticSection

ARC_DEGREE = 11
"""Degree of a parameter curve on a cone; no more, as some readers stop at 11."""
ARC_POLES = (12, 13, 14, 16, 20, 24, 36, 48)
"""Poles that are tried in turn. The kernel's exact check takes as long as there are spans, and one polynomial, the
first of these, follows a quarter turn to 3e-12 mm."""
ARC_ERROR = 2e-11
"""How far off the arc its parameter curve may be, mm, before more poles are tried; in proportion more on a radius of
more than a metre, where rounding rules."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PatchSurface:
    """A kernel surface under a patch.

    Attributes:
        surface: plane, cone or cylinder.
        agrees: whether the surface's own normal points along the patch's n (else against it).
    """

    surface: Geom_Surface
    agrees: bool


def plane_surface(origin: Array, normal: Array, x_axis: Array) -> PatchSurface:
    """The plane through `origin`, its own normal along `normal`."""
    return PatchSurface(surface=Geom_Plane(kernel.frame(origin, normal, x_axis)), agrees=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class RoundSurface(PatchSurface):
    """A cone or cylinder, located at the panel's own level (the apex may be 1e12 mm away).

    A point at sweep angle phi and height s along the generatrix has parameters u = pi + sense * (phi - sweep / 2) and
    v = sense * (s - level): the patch lies around u = pi, clear of the surface's seam. `radius` is the one at `level`.
    """

    sense: int
    sweep: float
    level: float
    radius: float

    def parameters(self, sweep_angles: Array, heights: Array) -> Array:
        """(m, 2) surface parameters at (m,) sweep angles and heights."""
        u = math.pi + self.sense * (sweep_angles - 0.5 * self.sweep)
        return np.stack([u, self.sense * (heights - self.level)], axis=1)


def round_surface(patch_frame: AxisFrame, level: float) -> RoundSurface:
    """The cone, or where the half angle is 0 the cylinder, located at height `level` along the generatrix.

    The kernel's cone opens along its axis with a positive half angle, so a patch that narrows along t gets an axis
    against t. A concave patch (negative radius) lies with its outward normal towards the axis.
    """
    radius = patch_frame.level_radius + level * math.sin(patch_frame.half_angle)
    side = 1 if radius > 0.0 else -1
    opening = side * patch_frame.half_angle
    sense = 1 if opening >= 0.0 else -1
    origin = patch_frame.center + level * math.cos(patch_frame.half_angle) * patch_frame.axis
    middle = patch_frame.radials(np.array([0.5 * patch_frame.sweep]))[0]
    axes = kernel.frame(origin, sense * patch_frame.axis, -side * middle)
    surface = (
        Geom_CylindricalSurface(axes, abs(radius))
        if opening == 0.0
        else Geom_ConicalSurface(axes, abs(opening), abs(radius))
    )
    return RoundSurface(
        surface=surface, agrees=side > 0, sense=sense, sweep=patch_frame.sweep, level=level, radius=abs(radius)
    )


def generatrix_on_round(surface: RoundSurface, sweep_angle: float, start_height: float) -> Geom2d_Curve:
    """The straight generatrix at a sweep angle, its parameter the length from the height `start_height`."""
    u, v = surface.parameters(np.array([sweep_angle]), np.array([start_height]))[0]
    return Geom2d_Line(kernel.point_2d(u, v), kernel.direction_2d(0.0, surface.sense))


def arc_on_round(surface: RoundSurface, section: EllipticSection) -> Geom2d_Curve:
    """The arc in the parameter plane of the cone, with the parameter of the ellipse: an interpolated spline.

    It has the fewest poles by which it is as close as ARC_ERROR between its nodes, or the closest of those tried: where
    rounding rules, more poles are worse.
    """
    allowed = ARC_ERROR * max(1.0, 1e-3 * surface.radius)
    best, least = None, math.inf
    for poles in ARC_POLES:
        form = _interpolation(poles)
        parameters = section.start + (section.stop - section.start) * form.places
        angles = section.sweep_angles(parameters)
        angles += _whole_turns(angles, surface.sweep)
        wanted = surface.parameters(angles, section.heights(parameters))
        # About their middle: on a radius of 50 m the digits that a half turn costs would show.
        middle = wanted[:poles].mean(axis=0)
        found = form.inverse @ (wanted[:poles] - middle)
        off = np.abs(form.between @ found - (wanted[poles:] - middle)).max(axis=0)
        error = float(off[0] * surface.radius + off[1])
        if error < least:
            best, least = (found + middle, form.knots), error
        if error <= allowed:
            break
    assert best is not None
    return _spline(*best, section)


def _whole_turns(angles: Array, sweep: float) -> float:
    """What brings the angles next to the patch's own, which lie between 0 and sweep."""
    return -2.0 * math.pi * round(float(angles.mean() - 0.5 * sweep) / (2.0 * math.pi))


class _Interpolation(NamedTuple):
    """A spline space on [0, 1].

    Attributes:
        places: (2 n - 1,) n nodes crowded to the ends, then the middles between them.
        knots: (s + 1,) distinct knots of s spans.
        inverse: (n, n) from values at the nodes to poles.
        between: (n - 1, n) from poles to values at the middles.
    """

    places: Array
    knots: Array
    inverse: Array
    between: Array


@lru_cache(maxsize=len(ARC_POLES))
def _interpolation(poles: int) -> _Interpolation:
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(poles) / (poles - 1))
    places = np.concatenate([nodes, 0.5 * (nodes[1:] + nodes[:-1])])
    inner = np.convolve(nodes, np.full(ARC_DEGREE, 1.0 / ARC_DEGREE), mode="valid")[1:-1]
    knots: Array = np.concatenate([[0.0], inner, [1.0]])
    clamped: Array = np.concatenate([np.zeros(ARC_DEGREE), knots, np.ones(ARC_DEGREE)])
    matrix = BSpline.design_matrix(places, clamped, ARC_DEGREE).toarray()
    inverse = np.asarray(np.linalg.inv(matrix[:poles]), dtype=np.float64)
    return _Interpolation(places=places, knots=knots, inverse=inverse, between=matrix[poles:])


def _spline(poles: Array, knots: Array, section: EllipticSection) -> Geom2d_BSplineCurve:
    scaled = section.start + (section.stop - section.start) * knots
    scaled[-1] = section.stop
    counts = np.ones(len(knots), dtype=np.intp)
    counts[[0, -1]] = ARC_DEGREE + 1
    return Geom2d_BSplineCurve(pole_array_2d(poles), real_array(scaled), integer_array(counts), ARC_DEGREE)
