"""End curves of panels, and how far apart two of them are along a whole seam.

An end curve runs from corner to corner: straight over a plane patch, a conic over a cone patch. It is followed by a
parameter u from 0 to k: the integer part is the patch, the rest the share of its sweep (cone) or of its chord (plane).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.frames import rotate_about
from cadpanel.geometry.vectors import cross, dot

# Points a curved patch is followed at, and steps of the closest-point iteration from the nearest of them.
_ARC_POINTS = 24
_NEWTON_STEPS = 6
_DERIVATIVE_STEP = 1e-5
# The widest place is looked for again between the points, on ever finer grids around the widest of them on each patch.
_PEAKS = 4
_REFINEMENTS = 3
_GRID = np.linspace(-1.0, 1.0, 9)


@dataclass(frozen=True, slots=True)
class EndCurves:
    """A batch of s end curves of panels with k patches each, in one frame and unit.

    Attributes:
        corners: (s, k + 1, 3).
        p, t, n: (s, k + 1, 3) the bounding rulings.
        radius, half_angle, sweep: (s, k) of the patch that follows each ruling; all 0 for a plane.
        cut_point, cut_normal: (s, 3).
    """

    corners: Array
    p: Array
    t: Array
    n: Array
    radius: Array
    half_angle: Array
    sweep: Array
    cut_point: Array
    cut_normal: Array

    def take(self, index: IntArray) -> EndCurves:
        """The curves at `index`."""
        return EndCurves(*(getattr(self, f.name)[index] for f in fields(self)))

    @property
    def patches(self) -> int:
        """Patches along a curve."""
        return int(self.radius.shape[1])

    @property
    def straight(self) -> bool:
        """Whether every curve is one segment."""
        return self.patches == 1 and not self.sweep.any()

    def follow(self, u: Array) -> tuple[Array, Array]:
        """Points and the skin's normals (s, q, 3) at the parameters u (s, q) in [0, k]."""
        patch = np.clip(np.floor(u).astype(np.intp), 0, self.patches - 1)
        share = u - patch
        rows = np.arange(len(u))[:, None]
        p, t, n = self.p[rows, patch], self.t[rows, patch], self.n[rows, patch]
        radius, half_angle, sweep = (getattr(self, f)[rows, patch] for f in ("radius", "half_angle", "sweep"))
        axis = np.cos(half_angle)[..., None] * t - np.sin(half_angle)[..., None] * n
        centre = p - radius[..., None] * n
        turned_t, turned_n = rotate_about(axis, share * sweep, t), rotate_about(axis, share * sweep, n)
        foot = centre + radius[..., None] * turned_n
        m = self.cut_normal[:, None]
        slide = dot(m, self.cut_point[:, None] - foot) / dot(m, turned_t)
        arc = foot + slide[..., None] * turned_t
        here, there = self.corners[rows, patch], self.corners[rows, patch + 1]
        straight = here + share[..., None] * (there - here)
        return np.where((sweep == 0.0)[..., None], straight, arc), turned_n

    def stations(self) -> Array:
        """(q,) parameters that follow every curve of the batch closely."""
        curved = np.any(self.sweep != 0.0, axis=0)
        parts = [i + np.arange(n) / n for i, n in enumerate(np.where(curved, _ARC_POINTS, 4))]
        return np.append(np.concatenate(parts), float(self.patches))


def closest(curves: EndCurves, points: Array) -> tuple[Array, Array]:
    """Distance (s, q) of each point (s, q, 3) to its curve, and the parameter of the closest point.

    Starts at the nearest of many points of the curve and iterates u -= (C - x) . C' / |C'|^2, clipped to the curve; on
    a segment the foot of the perpendicular is the closest point, or an end is.
    """
    if curves.straight:
        start, span = curves.corners[:, None, 0], (curves.corners[:, 1] - curves.corners[:, 0])[:, None]
        along = np.clip(dot(points - start, span) / np.maximum(dot(span, span), np.finfo(float).tiny), 0.0, 1.0)
        return np.linalg.norm(points - start - along[..., None] * span, axis=-1), along
    stations = curves.stations()
    u_all = np.broadcast_to(stations, (len(points), len(stations)))
    on_curve, _ = curves.follow(u_all)
    square = np.sum((points[:, :, None] - on_curve[:, None]) ** 2, axis=-1)
    nearest = stations[np.argmin(square, axis=2)]
    u = nearest
    top = float(curves.patches)
    for _ in range(_NEWTON_STEPS):
        low, high = np.clip(u - _DERIVATIVE_STEP, 0.0, top), np.clip(u + _DERIVATIVE_STEP, 0.0, top)
        here = curves.follow(u)[0]
        rate = (curves.follow(high)[0] - curves.follow(low)[0]) / (high - low)[..., None]
        u = np.clip(u - dot(here - points, rate) / np.maximum(dot(rate, rate), np.finfo(float).tiny), 0.0, top)
    # A station that was closer than where the iteration went keeps its place.
    distance, refined = np.sqrt(square.min(axis=2)), np.linalg.norm(curves.follow(u)[0] - points, axis=-1)
    closer = refined <= distance
    return np.where(closer, refined, distance), np.where(closer, u, nearest)


def seam_gap(first: EndCurves, second: EndCurves) -> tuple[Array, Array]:
    """Symmetric Hausdorff distance (s,) of pairs of end curves, and the largest angle (s,) between the skins there.

    The angle (kink, radians) is taken between the normals at each followed point and at its closest point.
    """
    gap, kink = np.zeros(len(first.corners)), np.zeros(len(first.corners))
    straight = first.straight and second.straight
    for one, other in ((first, second), (second, first)):
        # The distance from a segment is convex along another one: it is largest at an end.
        stations = np.array([0.0, 1.0]) if straight else one.stations()
        points, normals = one.follow(np.broadcast_to(stations, (len(one.corners), len(stations))))
        distance, u = closest(other, points)
        facing = other.follow(u)[1]
        angle = np.arctan2(np.linalg.norm(cross(normals, facing), axis=-1), dot(normals, facing))
        gap = np.maximum(gap, distance.max(axis=1) if straight else _widest(one, other, stations, distance))
        kink = np.maximum(kink, angle.max(axis=1))
    return gap, kink


def _widest(one: EndCurves, other: EndCurves, stations: Array, distance: Array) -> Array:
    """(s,) the largest distance of `one` from `other`, found from the distances (s, q) at the stations (q,)."""
    widest: Array = distance.max(axis=1)
    patch = np.minimum(stations.astype(np.intp), one.patches - 1)
    # The widest place may hide between two stations while a third is the widest of all: look around several.
    peaks = [_largest(distance[:, patch == i], stations[patch == i]) for i in range(one.patches)]
    peak = np.stack(peaks, axis=1)
    lows = np.arange(one.patches, dtype=float)[None, :, None, None]
    step = np.array([np.diff(stations, append=one.patches)[patch == i].max() for i in range(one.patches)])
    for _ in range(_REFINEMENTS):
        grid = np.clip(peak[..., None] + step[:, None, None] * _GRID, lows, lows + 1.0)
        near, _ = closest(other, one.follow(grid.reshape(len(grid), -1))[0])
        near = near.reshape(grid.shape)
        peak = np.take_along_axis(grid, near.argmax(axis=-1)[..., None], axis=-1)[..., 0]
        widest = np.maximum(widest, near.max(axis=(1, 2, 3)))
        step = step / 4.0
    return widest


def _largest(distance: Array, stations: Array) -> Array:
    """(s, _PEAKS) the stations (q,) with the largest distances (s, q)."""
    order = np.argsort(-distance, axis=1, kind="stable")[:, :_PEAKS]
    return stations[np.resize(order.T, (_PEAKS, len(order))).T]
