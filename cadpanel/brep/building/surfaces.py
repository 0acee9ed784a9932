"""Exact kernel surfaces of patches and walls, and how a skin's arc looks in a cone's parameter plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface, Geom_Plane, Geom_Surface
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Curve, Geom2d_Line

from cadpanel.arrays import Array
from cadpanel.brep.building.interpolation import DEGREE, Interpolant, interpolate
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.splines import pole_array_2d
from cadpanel.geometry.cone_sections import AxisFrame, EllipticSection
from cadpanel.geometry.plane_sides import SideCurve


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

    The same of an arc whose points lie over those of the section, along the normals: angles and heights are theirs.
    """

    def wanted(parameters: Array) -> Array:
        angles = section.sweep_angles(parameters)
        angles += _whole_turns(angles, surface.sweep)
        return surface.parameters(angles, section.heights(parameters))

    weights = np.array([surface.radius, 1.0])
    return plane_spline(interpolate(wanted, section.start, section.stop, weights, surface.radius))


def side_on_round(surface: RoundSurface, curve: SideCurve) -> Geom2d_Curve:
    """The side that stands in a plane, in the parameter plane of the cone, its parameter the height: a spline."""

    def wanted(heights: Array) -> Array:
        return surface.parameters(curve.angles(heights), heights)

    weights = np.array([surface.radius, 1.0])
    low, high = curve.heights.tolist()
    return plane_spline(interpolate(wanted, low, high, weights, surface.radius))


def plane_spline(curve: Interpolant) -> Geom2d_Curve:
    """A spline of the parameter plane as the kernel's."""
    return Geom2d_BSplineCurve(pole_array_2d(curve.poles), *curve.kernel_knots(), DEGREE)


def _whole_turns(angles: Array, sweep: float) -> float:
    """What brings the angles next to the patch's own, which lie between 0 and sweep."""
    return -2.0 * math.pi * round(float(angles.mean() - 0.5 * sweep) / (2.0 * math.pi))
