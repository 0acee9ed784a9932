"""Tiny conversions between NumPy arrays and the kernel's points, directions and frames, one a pair of types."""

from __future__ import annotations

from OCP.gp import gp_Ax2, gp_Ax3, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d

from cadpanel.arrays import Array

TOLERANCE = 1e-7
"""Tolerance of every vertex, edge and face that is built, mm."""


def point(xyz: Array) -> gp_Pnt:
    """(3,) mm to a kernel point."""
    return gp_Pnt(float(xyz[0]), float(xyz[1]), float(xyz[2]))


def direction(xyz: Array) -> gp_Dir:
    """(3,), not zero, to a kernel direction (normalised)."""
    return gp_Dir(float(xyz[0]), float(xyz[1]), float(xyz[2]))


def point_2d(x: float, y: float) -> gp_Pnt2d:
    """A point of a surface's parameter plane."""
    return gp_Pnt2d(float(x), float(y))


def direction_2d(x: float, y: float) -> gp_Dir2d:
    """A direction, not zero, of a surface's parameter plane (normalised)."""
    return gp_Dir2d(float(x), float(y))


def frame(origin: Array, z_axis: Array, x_axis: Array) -> gp_Ax3:
    """Right-handed frame with the given z; x is made square to it."""
    return gp_Ax3(point(origin), direction(z_axis), direction(x_axis))


def conic_frame(origin: Array, z_axis: Array, x_axis: Array) -> gp_Ax2:
    """The same for a conic: it turns about z from x on."""
    return gp_Ax2(point(origin), direction(z_axis), direction(x_axis))
