"""Points and first derivatives of many B-spline surfaces at once, rational or not.

The basis functions and their derivatives come from the triangular table of Cox and de Boor (Piegl, Tiller: The NURBS
Book, 1997, algorithms A2.2 and A2.3), worked out for all points together; a rational surface is the quotient of one in
homogeneous coordinates and its weight (equation 4.9 there).
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray

CHUNK = 4096
"""Points worked on at once, so that everything stays in the processor's cache."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SplineSurface:
    """One B-spline surface, not periodic.

    Attributes:
        degrees: by u and v, at least 1.
        knots: by u and v, each knot as often as its multiplicity, one more than poles and degree together.
        poles: (n, m, 3), or (n, m, 4) with w x, w y, w z, w where it is rational.
        bounds: (2, 2) least and largest parameter in use, by u and v. On a knot there the derivative is the one from
            inside, where the two sides differ; beyond, the outermost polynomials go on.
    """

    degrees: tuple[int, int]
    knots: tuple[Array, Array]
    poles: Array
    bounds: Array


class SplineSurfaces:
    """Many B-spline surfaces of the same two degrees, all rational or all not."""

    __slots__ = ("_degrees", "_first_poles", "_knots", "_poles", "_row_lengths", "_spans")

    def __init__(self, surfaces: list[SplineSurface]) -> None:
        """Lay their poles and knots out for evaluation."""
        self._degrees = surfaces[0].degrees
        width = surfaces[0].poles.shape[-1]
        # Parts of one surface may share their poles.
        different = {id(surface.poles): surface.poles for surface in surfaces}
        self._poles = np.concatenate([poles.reshape(-1, width) for poles in different.values()])
        counts = [poles.shape[0] * poles.shape[1] for poles in different.values()]
        first = dict(zip(different, np.cumsum([0, *counts[:-1]]).tolist(), strict=True))
        self._first_poles = np.array([first[id(surface.poles)] for surface in surfaces])
        self._row_lengths = np.array([surface.poles.shape[1] for surface in surfaces])
        self._knots = tuple(_padded([surface.knots[way] for surface in surfaces]) for way in range(2))
        self._spans = tuple(np.array([_spans(surface, way) for surface in surfaces], dtype=np.intp) for way in range(2))

    def evaluate(self, owners: IntArray, parameters: Array) -> Array:
        """(p, 3, 3) the point and the derivatives by u and by v, mm, at (p, 2) parameters of the (p,) owners."""
        result = np.empty((len(owners), 3, 3))
        for start in range(0, len(owners), CHUNK):
            part = slice(start, start + CHUNK)
            result[part] = self._evaluate(owners[part], parameters[part])
        return result

    def evaluate_grids(self, owners: IntArray, u: Array, v: Array) -> Array:
        """(k, n, m, 3, 3) the same on a grid of each of the (k,) owners, a fourth of the work of point by point.

        Args:
            owners: (k,) which surfaces.
            u: (k, n) parameters along u of each grid.
            v: (k, m) the same along v.
        """
        return self._on_grids(owners, u, v, 0)

    def slopes_on_grids(self, owners: IntArray, u: Array, v: Array) -> Array:
        """(k, n, m, 2, 3) the derivatives of these alone, to the same digits."""
        return self._on_grids(owners, u, v, 1)

    def _on_grids(self, owners: IntArray, u: Array, v: Array, first: int) -> Array:
        result = np.empty((*u.shape, v.shape[1], 3 - first, 3))
        at_once = max(CHUNK // max(result[0, ..., 0, 0].size, 1), 1) if len(owners) else 1
        for start in range(0, len(owners), at_once):
            part = slice(start, start + at_once)
            result[part] = self._evaluate_grids(owners[part], u[part], v[part], first)
        return result

    def _evaluate_grids(self, owners: IntArray, u: Array, v: Array, first_row: int) -> Array:
        (span_u, basis_u, slope_u), (span_v, basis_v, slope_v) = (
            self._basis(way, np.repeat(owners, at.shape[1]), at.ravel()) for way, at in enumerate((u, v))
        )
        rows, columns = span_u.reshape(u.shape) - self._degrees[0], span_v.reshape(v.shape) - self._degrees[1]
        first = columns.min(axis=1, keepdims=True)
        corner = (self._first_poles[owners, None] + first + rows * self._row_lengths[owners, None])[..., None]
        # Of every row no more than the grid reaches; the last surface of all may have no more.
        reach = np.arange((columns - first).max() + self._degrees[1] + 1)
        lines = np.zeros((2, *u.shape, len(reach), self._poles.shape[-1]))
        for i in range(self._degrees[0] + 1):
            across = i * self._row_lengths[owners, None, None]
            poles = self._poles[np.minimum(corner + across + reach, len(self._poles) - 1)]
            lines[0] += basis_u[i].reshape(*u.shape, 1, 1) * poles
            lines[1] += slope_u[i].reshape(*u.shape, 1, 1) * poles
        values = np.zeros((3, *u.shape, v.shape[1], self._poles.shape[-1]))
        rational = self._poles.shape[-1] > 3
        every, line = np.arange(len(owners))[:, None, None], np.arange(u.shape[1])[:, None]
        for j in range(self._degrees[1] + 1):
            near = lines[:, every, line, (columns - first + j)[:, None]]
            basis = basis_v[j].reshape(len(v), 1, -1, 1)
            if not first_row or rational:
                values[0] += basis * near[0]
            values[1] += basis * near[1]
            values[2] += slope_v[j].reshape(basis.shape) * near[0]
        if rational:
            values = _quotient(values.reshape(3, -1, 4)).reshape(*values.shape[:-1], 3)
        return np.moveaxis(values[first_row:], 0, -2)

    def _evaluate(self, owners: IntArray, parameters: Array) -> Array:
        (span_u, basis_u, slope_u), (span_v, basis_v, slope_v) = (
            self._basis(way, owners, parameters[:, way]) for way in range(2)
        )
        degree_u, degree_v = self._degrees
        rows = self._row_lengths[owners]
        corner = self._first_poles[owners] + (span_u - degree_u) * rows + span_v - degree_v
        values = np.zeros((3, len(owners), self._poles.shape[-1]))
        for i in range(degree_u + 1):
            along, across = (np.zeros_like(values[0]) for _ in range(2))
            for j in range(degree_v + 1):
                poles = self._poles[corner + j]
                along += basis_v[j, :, None] * poles
                across += slope_v[j, :, None] * poles
            values[0] += basis_u[i, :, None] * along
            values[1] += slope_u[i, :, None] * along
            values[2] += basis_u[i, :, None] * across
            corner += rows
        if values.shape[-1] > 3:
            values = _quotient(values)
        return values.transpose(1, 0, 2)

    def _basis(self, way: int, owners: IntArray, at: Array) -> tuple[IntArray, Array, Array]:
        """(p,) the span of each parameter, and (degree + 1, p) the basis functions there and their derivatives."""
        knots, degree = self._knots[way], self._degrees[way]
        least, greatest = self._spans[way][owners].T
        span = np.clip((knots[owners] <= at[:, None]).sum(axis=1) - 1, least, greatest)
        near = knots[owners, span + np.arange(1 - degree, degree + 1)[:, None]]
        left, right = at - near[degree - 1 :: -1], near[degree:] - at
        basis = np.zeros((degree + 1, len(at)))
        slope = np.zeros_like(basis)
        basis[0] = 1.0
        for order in range(1, degree + 1):
            shares = basis[:order] / (right[:order] + left[order - 1 :: -1])
            basis[:order] = right[:order] * shares
            basis[1 : order + 1] += left[order - 1 :: -1] * shares
        slope[1:] = degree * shares
        slope[:-1] -= degree * shares
        return span, basis, slope


def _padded(knots: list[Array]) -> Array:
    """(s, most knots) one row a surface, filled up with infinity, which no parameter reaches."""
    rows = np.full((len(knots), max(map(len, knots))), np.inf)
    for row, own in zip(rows, knots, strict=True):
        row[: len(own)] = own
    return rows


def _spans(surface: SplineSurface, way: int) -> tuple[int, int]:
    """The first and the last span that the bounds reach."""
    knots, degree = surface.knots[way].tolist(), surface.degrees[way]
    low, high = surface.bounds[way].tolist()
    poles = surface.poles.shape[way]
    first = bisect_right(knots, max(low, knots[degree]), hi=poles) - 1
    last = bisect_left(knots, min(high, knots[poles]), lo=degree + 1) - 1
    return first, max(first, last)


def _quotient(values: Array) -> Array:
    """(3, p, 3) of homogeneous (3, p, 4) values."""
    weights = values[0, :, 3:]
    points = values[0, :, :3] / weights
    slopes = (values[1:, :, :3] - values[1:, :, 3:] * points) / weights
    return np.concatenate([points[None], slopes])
