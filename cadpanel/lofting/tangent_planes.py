"""A developable strip through sampled tangent planes, by one linear system.

A developable surface is the envelope of a family of planes. In a frame whose y runs along the strip's rulings and whose
z is its mean normal, every plane is s x + q y + z + d = 0. Where the normals turn one way across the strip, s rises or
falls all along it and is taken for the parameter, so that the strip is a pair of functions of it (H. Pottmann and
J. Wallner, Approximation algorithms for developable surfaces, 1999: the form (u0(t), u1(t), t, -1)):

    U(s) = (s, q(s), 1, d(s)),    ruling U(s) = U'(s) = 0:    x = -q'(s) y - d'(s).

Between a sampled plane and U at the same s, the distance along z at a place (x, y) is (q(s) - q_i) y + d(s) - d_i. Its
mean square over the region of interest, a stretch of the ruling about the sample, is a quadratic form in q and d, and
where these are B-splines in their coefficients. Whatever comes out is developable. It is regular where x moves one way
with s all along every ruling.

A flat part of the strip has one s: its samples count against the first or last plane, in which the strip ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline

from cadpanel.arrays import Array
from cadpanel.errors import LoftError
from cadpanel.geometry.vectors import cross, dot, norm, unit

SPANS = 8
"""Of a strip's spline at most, unless asked otherwise."""
# Rulings hang on derivatives, and are smooth where these have none but whole kinks.
_DEGREE = 3
# Normals further off the mean one, radians, are not told by the planes' coordinates with z = 1.
_WIDEST = np.radians(80.0)
# A plane counts along its ruling for this part of the strip's length, about its sample. On a strip that is not quite
# developable the planes along a ruling differ, and each is right only near its sample.
_REGION = 0.5
# A mean square over a stretch of length 1 is that at its two Gauss points, for what is linear on it.
_GAUSS = 0.5 / np.sqrt(3.0) * np.array([-1.0, 1.0])
# Places at which the foot of a point is looked for first, and Newton's steps from there.
_PLACES, _STEPS = 65, 6
_GRID = np.linspace(0.0, 1.0, _PLACES)
# Rulings follow each other where they do so on both sides of the middle, at these parts of the length, and are apart by
# this share of what they are in the mean.
_BESIDE, _LEAST_GROWTH = (-0.25, 0.25), 0.02
# Places of the grid on which areas are told.
_CELLS = 33
# More of the area than this among the first or last of the turning, a share of it, is a flat part.
_END, _FLAT = 0.047, 0.153


@dataclass(frozen=True, slots=True)
class Sampled:
    """Places of a strip with their tangent planes, in its frame.

    Attributes:
        origin: (3,) mm.
        axes: (3, 3) columns x, across the strip; y, along its rulings; z, its mean normal.
        points: (m, 3) in this frame, mm.
        normals: (m, 3) likewise, of length 1.
        weights: (m,) the area that each stands for.
        length: of the strip along its rulings, mm.
    """

    origin: Array
    axes: Array
    points: Array
    normals: Array
    weights: Array
    length: float

    @classmethod
    def of(cls, points: Array, normals: Array, weights: Array, along: Array) -> Sampled:
        """Samples (m, 3) of a strip whose rulings run nearly `along` (3,).

        Raises:
            LoftError: its normals turn too far to be seen from one side.
        """
        share = weights / weights.sum()
        y = along / norm(along)
        z = share @ normals
        z = z - (z @ y) * y
        if not norm(z) > 0.0:
            raise LoftError("the normals of the strip point all ways: cut it along its rulings")
        z = z / norm(z)
        axes = np.stack([cross(y, z), y, z], axis=-1)
        origin = share @ points
        local, turned = (points - origin) @ axes, normals @ axes
        if not turned[:, 2].min() > np.cos(_WIDEST):
            widest = np.degrees(np.arccos(np.clip(turned[:, 2].min(), -1.0, 1.0)))
            raise LoftError(
                f"the normals of the strip turn by {widest:.0f} degrees from their mean, and "
                f"{np.degrees(_WIDEST):.0f} are the most: cut it along a ruling"
            )
        return cls(origin, axes, local, turned, weights, float(np.ptp(local[:, 1])))

    @property
    def slopes(self) -> Array:
        """(m,) s of every plane."""
        return np.asarray(self.normals[:, 0] / self.normals[:, 2])

    @property
    def whole_turning(self) -> tuple[float, float]:
        """The least and the greatest s."""
        return float(self.slopes.min()), float(self.slopes.max())

    def turning(self) -> tuple[float, float]:
        """Between which s the strip turns: all, less flat parts at its sides, of each of which the mean counts."""
        s = self.slopes
        low, high = self.whole_turning
        ends = []
        for end, way in ((low, 1.0), (high, -1.0)):
            near = way * (s - end) < _END * (high - low)
            flat = self.weights[near].sum() > _FLAT * self.weights.sum()
            ends.append(float(np.average(s[near], weights=self.weights[near])) if flat else end)
        return ends[0], ends[1]


@dataclass(frozen=True, slots=True)
class PlaneCurve:
    """A developable strip as a curve in the space of planes.

    Attributes:
        origin, axes: the frame, as `Sampled` has it.
        spline: (q, d) by s; mm.
        turning: least and greatest s; beyond them the strip goes on in its first and last plane.
        bend: 1 where it is convex towards its normals, -1 where it is concave, 0 where rulings meet among the samples.
    """

    origin: Array
    axes: Array
    spline: BSpline
    turning: tuple[float, float]
    bend: int

    def stations(self, count: int) -> Array:
        """(count,) s of equal turning, nearly, from the first to the last ruling."""
        first, last = np.arctan(self.turning).tolist()
        return np.asarray(np.tan(np.linspace(first, last, count)))

    def planes(self, s: Array) -> Array:
        """(m, 4) planes (n, d) with normals of length 1: they hold the points x with n . x + d = 0."""
        found: Array = self._jets(s)[0]
        normals = found[:, :3] @ self.axes.T
        return np.column_stack([normals, found[:, 3] - normals @ self.origin])

    def velocities(self, s: Array) -> Array:
        """(m, 4) how `planes` move, for normals that turn at the rate 1 as s rises."""
        found = self._jets(s)[1]
        normals = found[:, :3] @ self.axes.T
        return np.column_stack([normals, found[:, 3] - normals @ self.origin])

    def rulings(self, s: Array) -> tuple[Array, Array]:
        """(m, 3) a point of every ruling, at y = 0, mm, and (m, 3) its direction, of length 1, towards y."""
        (q, d), (q1, d1) = (self.spline(s, nu=order).T for order in (0, 1))
        point = np.stack([-d1, np.zeros_like(s), s * d1 - d], axis=-1)
        way = unit(np.stack([-q1, np.ones_like(s), s * q1 - q], axis=-1))
        return self.origin + point @ self.axes.T, way @ self.axes.T

    def between(self, s: Array, bounds: Array) -> Array:
        """(m, 2, 3) where rulings meet two planes (2, 4), their bounds, mm."""
        point, way = self.rulings(s)
        far = -(point @ bounds[:, :3].T + bounds[:, 3]) / (way @ bounds[:, :3].T)
        return np.asarray(point[:, None] + far[..., None] * way[:, None])

    def feet(self, points: Array) -> tuple[Array, Array]:
        """(m,) the s of the ruling nearest to each point (m, 3), and (m,) the signed distance from the strip, mm.

        At the foot the distance from the tangent planes is largest on the convex side, least on the concave one.

        Raises:
            LoftError: the strip is not regular.
        """
        if not self.bend:
            raise LoftError("rulings of the strip meet inside of it: take a narrower one, or one that turns one way")
        local = (points - self.origin) @ self.axes
        low, high = self.turning
        grid = np.linspace(low, high, _PLACES)
        planes = self._jets(grid)[0]
        s = grid[np.argmax(self.bend * (local @ planes[:, :3].T + planes[:, 3]), axis=1)]
        for _ in range(_STEPS):
            s = np.clip(s - self._newton(local, s), low, high)
        planes = self._jets(s)[0]
        return s, dot(planes[:, :3], local) + planes[:, 3]

    def _newton(self, local: Array, s: Array) -> Array:
        """Step to where d/ds of (U . p) / |n| is nothing; none where the distance would fall."""
        (q, d), (q1, d1), (q2, d2) = (self.spline(s, nu=order).T for order in range(3))
        x, y, z = local.T
        size = 1.0 + s**2 + q**2
        g, g1, g2 = s * x + q * y + z + d, x + q1 * y + d1, q2 * y + d2
        turn = s + q * q1
        slope = g1 - g * turn / size
        bent = g2 - (g1 * turn + g * (1.0 + q1**2 + q * q2)) / size + 2.0 * g * turn**2 / size**2
        return np.where(self.bend * bent < 0.0, slope / np.where(bent == 0.0, 1.0, bent), 0.0)

    def _jets(self, s: Array) -> tuple[Array, Array]:
        """(m, 4) planes with normals of length 1 in the strip's frame, and their rates by the angle of turning."""
        (q, d), (q1, d1) = (self.spline(s, nu=order).T for order in (0, 1))
        size = np.sqrt(1.0 + s**2 + q**2)
        plane = np.stack([s, q, np.ones_like(s), d], axis=-1) / size[:, None]
        rate = np.stack([np.ones_like(s), q1, np.zeros_like(s), d1], axis=-1) / size[:, None]
        rate = rate - dot(plane[:, :3], rate[:, :3])[:, None] * plane
        return plane, rate / norm(rate[:, :3])[:, None]


def plane_curve(sampled: Sampled, *, spans: int = SPANS) -> PlaneCurve:
    """The cubic B-spline in the space of planes nearest to sampled tangent planes.

    Args:
        sampled: places of a strip that turns one way.
        spans: of the spline, halved until rulings follow each other all along the strip: where it is drawn with flat
            parts, or is not developable, too fine a spline follows what no developable strip can.

    Raises:
        LoftError: the strip does not turn.
    """
    low, high = sampled.turning()
    if not high - low > 0.0:
        raise LoftError("the strip is flat: its rulings are any lines")
    while True:
        curve = _solved(sampled, (low, high), spans)
        if curve.bend or spans == 1:
            return curve
        spans //= 2


def _solved(sampled: Sampled, turning: tuple[float, float], spans: int) -> PlaneCurve:
    """The one linear system: least squares of distances over the region of every sample, q and d together."""
    own, size = sampled.slopes, sampled.length
    s = np.clip(own, *turning)
    knots = _knots(s, sampled.weights, turning, spans)
    # For so few samples quicker than the sparse matrix of the same numbers, `BSpline.design_matrix`. The knots need no
    # looking at: they were made here.
    basis = BSpline.construct_fast(knots, np.eye(len(knots) - _DEGREE - 1), _DEGREE)(s)
    x, y, z = sampled.points.T
    q = sampled.normals[:, 1] / sampled.normals[:, 2]
    d = -(own * x + q * y + z)
    # A distance along z is one square to the plane times 1 / n_z.
    root = np.sqrt(sampled.weights) * sampled.normals[:, 2]
    weighed = root[:, None] * basis
    at = y + _REGION * size * _GAUSS[:, None]
    rows = np.concatenate([(at / size)[..., None] * weighed, np.broadcast_to(weighed, (2, *weighed.shape))], axis=2)
    right = root * (d + q * at + (own - s) * x)
    found = np.linalg.lstsq(rows.reshape(2 * len(s), -1), right.reshape(-1), rcond=None)[0].reshape(2, -1)
    spline = BSpline.construct_fast(knots, np.stack([found[0] / size, found[1]], axis=-1), _DEGREE)
    return PlaneCurve(sampled.origin, sampled.axes, spline, turning, _bend(spline, s, y, size))


def _bend(spline: BSpline, s: Array, y: Array, length: float) -> int:
    """Which way a strip bends, if x rises along the strip by its share at least: see `PlaneCurve`.

    At every sample, and between them on both sides of the middle of the strip.
    """
    grid = spline.t[0] + (spline.t[-1] - spline.t[0]) * _GRID
    stations, heights = (
        np.concatenate([s, grid, grid]),
        np.concatenate([y, *(share * length + 0.0 * grid for share in _BESIDE)]),
    )
    q2, d2 = spline(stations, nu=2).T
    growth = -(q2 * heights + d2)
    least = _LEAST_GROWTH * abs(float(growth[len(s) :].mean()))
    return 1 if growth.min() > least else -1 if growth.max() < -least else 0


def _knots(s: Array, weights: Array, ends: tuple[float, float], spans: int) -> Array:
    """Clamped knots between which there is as much of two measures in equal parts: the area that turns, and s itself.

    Areas are told on a grid between whose places every sample is shared, as decisions between samples of nearly one s
    would hang on their last digit.
    """
    place = (s - ends[0]) / (ends[1] - ends[0]) * (_CELLS - 1)
    low = np.minimum(place.astype(np.intp), _CELLS - 2)
    # Flat parts stand at the ends and do not turn.
    own = weights * np.clip(np.minimum(place, _CELLS - 1 - place), 0.0, 1.0)
    area = np.bincount(low, own * (low + 1 - place), minlength=_CELLS)
    area += np.bincount(low + 1, own * (place - low), minlength=_CELLS)
    steps = np.full(_CELLS - 1, 1.0 / (_CELLS - 1))
    if area.any():
        steps = 0.5 * (steps + 0.5 * (area[1:] + area[:-1]) / area.sum())
    total = np.concatenate([[0.0], np.cumsum(steps)])
    shares = np.linspace(0.0, total[-1], spans + 1)[1:-1]
    inner = np.interp(shares, total, np.linspace(ends[0], ends[1], _CELLS))
    return np.concatenate([np.full(_DEGREE + 1, ends[0]), inner, np.full(_DEGREE + 1, ends[1])])
