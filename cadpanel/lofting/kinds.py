"""Whether a piece of a loft is a plane, a circular cylinder or a circular cone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, norm, unit
from cadpanel.lofting.pieces import Piece

SAME = 1e-6
"""What lies on a plane, cylinder or cone to this part of the loft's size is one."""
_PLACES = 65


@dataclass(frozen=True, eq=False)
class Flat:
    """The plane through a point (3,) mm with a unit normal."""

    point: Array
    normal: Array
    off: float

    @property
    def word(self) -> Literal["plane"]:
        """What it is."""
        return "plane"

    def numbers(self) -> dict[str, float]:
        """What a report says of it."""
        return {}


@dataclass(frozen=True, eq=False)
class Round:
    """A circular cylinder or cone.

    A point at the angle u and the height v along its generatrix is origin + (radius + v sin g) (cos u x + sin u y) +
    v cos g z, with the half angle g, and y = z cross x; u is pi in the middle of the piece.

    Attributes:
        origin: (3,) on the axis, mm.
        axis: (3,) z; a cone opens along it.
        across: (3,) x.
        radius: at the origin, mm.
        half_angle: radians; 0 for a cylinder.
        off: how far the piece's edges lie off it at most, mm.
    """

    origin: Array
    axis: Array
    across: Array
    radius: float
    half_angle: float
    off: float

    @property
    def word(self) -> Literal["cylinder", "cone"]:
        """What it is."""
        return "cone" if self.half_angle else "cylinder"

    def numbers(self) -> dict[str, float]:
        """What a report says of it: mm and degrees."""
        return {"radius": self.radius, "half_angle": float(np.degrees(self.half_angle))}

    def parameters(self, points: Array) -> Array:
        """(m, 2) angles u, without jumps along the points (m, 3), and heights v of the nearest points on it."""
        to = points - self.origin
        x, y, z = to @ self.across, to @ cross(self.axis, self.across), to @ self.axis
        sine, cosine = np.sin(self.half_angle), np.cos(self.half_angle)
        around = np.pi + np.arctan2(-y, -x)
        return np.stack([np.unwrap(around), (np.hypot(x, y) - self.radius) * sine + z * cosine], axis=-1)

    def points(self, parameters: Array) -> Array:
        """(m, 3) points at parameters (m, 2)."""
        u, v = parameters[:, 0, None], parameters[:, 1, None]
        out = np.cos(u) * self.across + np.sin(u) * cross(self.axis, self.across)
        radii = self.radius + v * np.sin(self.half_angle)
        return np.asarray(self.origin + radii * out + v * np.cos(self.half_angle) * self.axis)


Kind = Flat | Round | None
"""None is a general ruled surface."""


def kind_of(piece: Piece, size: float) -> Kind:
    """What a piece is, to `SAME` of the loft's size, mm."""
    a, b = (jet.point for jet in piece.jets(np.linspace(0.0, 1.0, _PLACES)))
    points = np.concatenate([a, b])
    allowed = SAME * size
    middle = points.mean(axis=0)
    _, _, ways = np.linalg.svd(points - middle, full_matrices=False)
    off = float(np.abs((points - middle) @ ways[2]).max())
    if off <= allowed:
        normal = ways[2] * (1.0 if ways[2] @ piece.normals(np.array([0.5]))[0] > 0.0 else -1.0)
        return Flat(middle, normal, off)
    if piece.apex is not None:  # a face round its apex is a spline surface: the kernel's cones have no corner there
        return None
    for found in (_cylinder(a, b), _cone(a, b)):
        if found is not None and found.off <= allowed:
            return found
    return None


def _cylinder(a: Array, b: Array) -> Round | None:
    """The circle through the rulings, looked at along them (least squares of |p|^2 - 2 p . c - k)."""
    axis = unit(unit(b - a).mean(axis=0))
    points = np.concatenate([a, b])
    middle = points.mean(axis=0)
    across = unit(cross(axis, np.eye(3)[np.abs(axis).argmin()]))
    plane = np.stack([across, cross(axis, across)], axis=-1)
    flat = (points - middle) @ plane
    system = np.column_stack([2.0 * flat, np.ones(len(flat))])
    x, y, k = np.linalg.lstsq(system, (flat**2).sum(axis=-1), rcond=None)[0]
    square = k + x**2 + y**2
    if not square > 0.0:
        return None
    center, radius = middle + plane @ np.array([x, y]), float(np.sqrt(square))
    off = float(np.abs(norm(flat - np.array([x, y])) - radius).max())
    return _placed(center, axis, radius, 0.0, points, off)


def _cone(a: Array, b: Array) -> Round | None:
    """The apex nearest to all rulings, and the circle of their directions (least squares of d . w = 1)."""
    way = unit(b - a)
    beside = np.eye(3) - way[:, :, None] * way[:, None, :]
    middle = 0.5 * (a + b).mean(axis=0)
    system, right = beside.sum(axis=0), np.einsum("kij,kj->i", beside, a - middle)
    if np.linalg.cond(system) > 1e14:
        return None
    apex = middle + np.linalg.solve(system, right)
    points = np.concatenate([a, b])
    to = points - apex
    far = norm(to)
    if not (far > 0.0).all():
        return None
    w = np.linalg.lstsq(to / far[:, None], np.ones(len(to)), rcond=None)[0]
    if not norm(w) > 1.0:
        return None
    axis, half_angle = unit(w), float(np.arccos(1.0 / norm(w)))
    angles = np.arctan2(norm(cross(to, np.broadcast_to(axis, to.shape))), to @ axis)
    off = float((far * np.abs(np.sin(angles - half_angle))).max())
    level = float(far.mean())
    return _placed(apex + level * np.cos(half_angle) * axis, axis, level * np.sin(half_angle), half_angle, points, off)


def _placed(origin: Array, axis: Array, radius: float, half_angle: float, points: Array, off: float) -> Round:
    """With the middle of the points at the angle pi, clear of the surface's seam."""
    to = points - origin
    out = unit(to - (to @ axis)[:, None] * axis)
    across = -unit(out.mean(axis=0))
    along = float(((points - origin) @ axis).mean()) if half_angle == 0.0 else 0.0
    return Round(origin + along * axis, axis, across, radius, half_angle, off)
