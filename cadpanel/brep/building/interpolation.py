"""Splines through curves that are known point by point, as close as rounding lets them."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from scipy.interpolate import BSpline

from cadpanel.arrays import Array
from cadpanel.brep.kernel.splines import integer_array, real_array

DEGREE = 11
"""No more, as some readers stop at 11."""
POLES = (12, 13, 14, 16, 20, 24, 36, 48)
"""Poles that are tried in turn. The kernel's exact check takes as long as there are spans, and one polynomial, the
first of these, follows a quarter turn to 3e-12 mm."""
CLOSE = 2e-11
"""How far off a curve its spline may be, mm, before more poles are tried; in proportion more on a radius of more than a
metre, where rounding rules."""


class Interpolant(NamedTuple):
    """A spline of DEGREE.

    Attributes:
        poles: (n, d).
        knots: (s + 1,) distinct knots of its s spans.
    """

    poles: Array
    knots: Array

    def kernel_knots(self) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
        """Knots and how often each of them comes, as the kernel's arrays."""
        counts = np.ones(len(self.knots), dtype=np.intp)
        counts[[0, -1]] = DEGREE + 1
        return real_array(self.knots), integer_array(counts)


def interpolate(
    at: Callable[[Array], Array], start: float, stop: float, weights: Array, size: float = 0.0
) -> Interpolant:
    """A spline with the parameter of the curve that it follows.

    It has the fewest poles by which it is as close as CLOSE between its nodes, or the closest of those tried: where
    rounding rules, more poles are worse.

    Args:
        at: from parameters (m,) to points (m, d).
        start: the curve's first parameter.
        stop: its last one.
        weights: (d,) what one unit of each coordinate is in mm.
        size: of what the curve bends about, mm.
    """
    allowed = CLOSE * max(1.0, 1e-3 * size)
    best, least = None, math.inf
    for poles in POLES:
        form = _space(poles)
        wanted = at(start + (stop - start) * form.places)
        # About their middle: on a radius of 50 m the digits that a half turn costs would show.
        middle = wanted[:poles].mean(axis=0)
        found = form.inverse @ (wanted[:poles] - middle)
        error = float(np.abs(form.between @ found - (wanted[poles:] - middle)).max(axis=0) @ weights)
        if error < least:
            best, least = (found + middle, form.knots), error
        if error <= allowed:
            break
    assert best is not None
    knots = start + (stop - start) * best[1]
    knots[-1] = stop
    return Interpolant(poles=best[0], knots=knots)


class _Space(NamedTuple):
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


@lru_cache(maxsize=len(POLES))
def _space(poles: int) -> _Space:
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(poles) / (poles - 1))
    places = np.concatenate([nodes, 0.5 * (nodes[1:] + nodes[:-1])])
    inner = np.convolve(nodes, np.full(DEGREE, 1.0 / DEGREE), mode="valid")[1:-1]
    knots: Array = np.concatenate([[0.0], inner, [1.0]])
    clamped: Array = np.concatenate([np.zeros(DEGREE), knots, np.ones(DEGREE)])
    matrix = BSpline.design_matrix(places, clamped, DEGREE).toarray()
    inverse = np.asarray(np.linalg.inv(matrix[:poles]), dtype=np.float64)
    return _Space(places=places, knots=knots, inverse=inverse, between=matrix[poles:])
