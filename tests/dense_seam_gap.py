"""The distance of end curves along a seam the plain way: many points, all against all, then ever closer to the peaks.

Written apart from the package's own measure and as simply as can be; slow. The only thing the two share is
`EndCurves.follow`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.vectors import dot

# Places between two neighbours of a peak, each time.
_FINE = 17
# Share of a patch: how far apart the last three points for a closest point are.
_NEAR = 1e-3
# Seams together: all against all of their points is much to hold.
_TOGETHER = 40
# Share of a patch on either side over which the tangent is taken.
_AHEAD = 1e-5
# The end of one patch, not the start of the next.
_LAST = 1.0 - 1e-13


@dataclass(frozen=True, slots=True, kw_only=True)
class Density:
    """How closely curves are followed.

    Attributes:
        points: on every patch of one curve.
        peaks: of them around which more and more are taken.
        close: the step, as a share of a patch, at which that ends.
        targets: on every patch of the curve that is measured to; parabolas go through each three of them.
    """

    points: int
    peaks: int
    close: float
    targets: int


QUICK = Density(points=18, peaks=2, close=2e-3, targets=48)
FINE = Density(points=192, peaks=8, close=1e-5, targets=384)


def dense_seam_gap(first: EndCurves, second: EndCurves, density: Density) -> Array:
    """(4, s) symmetric Hausdorff distance, kink in radians, width and step of s pairs of curves, in mm."""
    found = []
    for start in range(0, len(first.corners), _TOGETHER):
        some = np.arange(start, min(start + _TOGETHER, len(first.corners)))
        pair = first.take(some), second.take(some)
        ways = [_one_way(one, other, density) for one, other in (pair, pair[::-1])]
        found.append(np.maximum(*ways))
    whole: Array = np.concatenate(found, axis=1)
    return whole


def _one_way(one: EndCurves, other: EndCurves, density: Density) -> Array:
    """(4, s) the largest distances, angles, widths and steps that the first curves' points have."""
    to = _Targets(other, density.targets)
    rows = np.arange(len(one.corners))[:, None]
    stations = np.tile(np.linspace(0.0, one.patches, one.patches * density.points + 1), (len(rows), 1))
    values = to.measure(one, stations)
    largest = []
    for which, value in enumerate(values):
        beside = np.pad(value, ((0, 0), (1, 1)), constant_values=-1.0)
        is_peak = (value >= beside[:, :-2]) & (value >= beside[:, 2:])
        highest = np.argsort(-np.where(is_peak, value, -1.0), axis=1, kind="stable")[:, : density.peaks]
        at, step, best = stations[rows, highest], 1.0 / density.points, value.max(axis=1)
        while step > density.close:
            around = np.clip(at[..., None] + step * np.linspace(-1.0, 1.0, _FINE), 0.0, one.patches)
            value = to.measure(one, around.reshape(len(rows), -1))[which].reshape(around.shape)
            at = np.take_along_axis(around, value.argmax(axis=2)[..., None], axis=2)[..., 0]
            best = np.maximum(best, value.max(axis=(1, 2)))
            step *= 2.0 / (_FINE - 1)
        largest.append(best)
    return np.stack(largest)


def _unit(vectors: Array) -> Array:
    scaled: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return scaled


class _Targets:
    """Points along every patch of a curve, and the parabolas through each three of them."""

    def __init__(self, curves: EndCurves, count: int) -> None:
        self.curves, self.count = curves, count
        shares = np.linspace(0.0, 1.0, count + 1)
        shares[-1] = _LAST
        u = (np.arange(curves.patches)[:, None] + shares).ravel()
        points = curves.follow(np.broadcast_to(u, (len(curves.corners), len(u))))[0]
        self.patches = np.split(points, curves.patches, axis=1)

    def measure(self, one: EndCurves, u: Array) -> tuple[Array, Array, Array, Array]:
        """Distances, angles, widths and steps (s, q) at the parameters (s, q) of the other curve."""
        x, normals = one.follow(u)
        least, v = np.full(u.shape, np.inf), np.zeros(u.shape)
        for patch, points in enumerate(self.patches):
            square, share = self._nearest(x, points)
            closer = square < least
            least, v = np.where(closer, square, least), np.where(closer, np.minimum(patch + share, patch + _LAST), v)
        # Once more, through three points close to the one that was found.
        start = np.floor(v)
        middle = np.clip(v, start + _NEAR, start + _LAST - _NEAR)
        three = [self.curves.follow(middle + side * _NEAR)[0] for side in (-1.0, 0.0, 1.0)]
        _, offset = _on_parabola(x, three, (v - middle) / _NEAR)
        v = np.clip(middle + offset * _NEAR, start, start + _LAST)
        there, facing = self.curves.follow(v)
        chord = np.linalg.norm(normals - facing, axis=-1)
        before, after = (self.curves.follow(np.clip(v + side * _AHEAD, start, start + _LAST))[0] for side in (-1, 1))
        tangent = _unit(after - before)
        way = there - x
        square_on = way - dot(way, tangent)[..., None] * tangent
        step = dot(square_on, _unit(normals + facing))
        width = np.sqrt(np.maximum(dot(square_on, square_on) - step**2, 0.0))
        return np.linalg.norm(way, axis=-1), 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0)), width, np.abs(step)

    def _nearest(self, x: Array, points: Array) -> tuple[Array, Array]:
        """Squared distances (s, q) of x (s, q, 3) from a patch's points (s, count + 1, 3), and shares of the patch."""
        x_y_z = ((x[:, :, None, i] - points[:, None, :, i]) ** 2 for i in range(3))
        place: IntArray = sum(x_y_z, np.zeros(1)).argmin(axis=2)
        middle = np.clip(place, 1, self.count - 1)
        rows = np.arange(len(x))[:, None]
        three = [points[rows, middle + side] for side in (-1, 0, 1)]
        least, offset = _on_parabola(x, three, (place - middle).astype(float))
        return least, (middle + offset) / self.count


def _on_parabola(x: Array, three: Sequence[Array], offset: Array) -> tuple[Array, Array]:
    """Squared distances (s, q) of x (s, q, 3) from parabolas that pass three points at -1, 0 and 1, and where."""
    before, here, after = three
    rate, bend = 0.5 * (after - before), after - 2.0 * here + before
    away = here - x
    # The derivative of half the squared distance is a cubic in the offset.
    powers = [dot(away, rate), dot(rate, rate) + dot(away, bend), 1.5 * dot(rate, bend), 0.5 * dot(bend, bend)]
    for _ in range(6):
        slope = powers[0] + offset * (powers[1] + offset * (powers[2] + offset * powers[3]))
        curved = powers[1] + offset * (2.0 * powers[2] + offset * 3.0 * powers[3])
        offset = np.clip(offset - slope / np.maximum(curved, 0.1 * dot(rate, rate) + 1e-300), -1.0, 1.0)
    off = away + offset[..., None] * (rate + 0.5 * offset[..., None] * bend)
    return dot(off, off), offset
