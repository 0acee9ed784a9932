"""Polylines so fine that they stand for a smooth curve: digitised, intersected, or exported by other programs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.interpolate import BSpline, splprep

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.order import levels
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import norm, unit

_Fitted = tuple[Array, list[Array], int]

# A turn between two segments is a facet where the smooth curve past it misses them by no more than this, mm: a tenth
# of the default seam tolerance, and far below what can be seen on a facade.
FACET = 0.1
# Over this length to both sides, mm, a facet does not turn by more than the angle, degrees; what does is a corner,
# chamfered as it may be. (No outline of a panel shows edges that are shorter than a millimetre.)
CORNER_LENGTH = 1.0
CORNER_ANGLE = 20.0
SAME_COSINE = 1e-9
# Lengths of neighbouring segments differ by no more than this factor when a curve is fitted through their ends.
GRADING = 2.0
# Longer ones are halved as long as they are longer than this, mm, and this many times at most.
SHORTEST = 0.01
HALVINGS = 24
# Points are met to this part of the polyline's own error, or to this many times their noise.
OWN_ERROR = 0.25
NOISE = 1.5
# What the running differences below make of noise of size 1 in independent points.
NOISE_GAIN = float(np.linalg.norm([0.25, -1.0, 1.5, -1.0, 0.25]))
# Times that the error allowed is quartered where the curve comes to lie too far off.
QUARTERINGS = 4
DEGREE = 3


def missed(before: Array, after: Array, lengths: Array) -> Array:
    """How far a smooth curve past turns misses each, (k,) mm.

    The arc through three points of a polyline leaves its shorter side by an eighth of that times the turn.

    Args:
        before: (k, 3) unit directions before each turn.
        after: (k, 3) those after it.
        lengths: (k + 1,) of the segments, mm.
    """
    turns = 2.0 * np.arcsin(np.clip(0.5 * norm(after - before), 0.0, 1.0))
    return np.asarray(turns * np.minimum(lengths[:-1], lengths[1:]) / 8.0)


def corners(points: Array, turns: IntArray) -> BoolArray:
    """Tell which turns are corners once they are looked at over a millimetre, one for each corner.

    Args:
        points: (q, 3) along a curve, mm.
        turns: (k,) rising indices of those at which it may turn.
    """
    reached = arc_length(points)
    here, at = points[turns], reached[turns]
    before, after = (
        np.stack([np.interp(at + step, reached, points[:, axis]) for axis in range(3)], axis=1)
        for step in (-CORNER_LENGTH, CORNER_LENGTH)
    )
    cosines = np.sum(unit(here - before) * unit(after - here), axis=1)
    found = np.zeros(len(turns), dtype=np.bool_)
    # Beside a corner, to as far as it may be chamfered and beyond, the curve turns, too, when looked at so roughly: the
    # sharpest turn stands for its neighbours, and of those alike, as at both ends of a chamfer, the first.
    for place in np.argsort(levels(cosines, SAME_COSINE), kind="stable").tolist():
        if cosines[place] > np.cos(np.radians(CORNER_ANGLE)):
            break
        first, last = np.searchsorted(at, [at[place] - 2.0 * CORNER_LENGTH, at[place] + 2.0 * CORNER_LENGTH])
        found[place] = not found[first:last].any()
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class SmoothCurve:
    """A cubic spline by length, mm, and how far it passes beside the polyline that it stands for at most, mm."""

    spline: BSpline
    off: float


def smooth_curve(points: Array, vertices: IntArray) -> SmoothCurve | None:
    """The curve that a fine polyline stands for, with no more knots than its own error asks for.

    Args:
        points: (q, 3) along the polyline, mm; it begins and ends where the spline does.
        vertices: (k,) rising indices of those at which it turns, and of its ends.

    Returns:
        None where no spline stays within two facets of the polyline.
    """
    error = min(_error(points[vertices]), OWN_ERROR * FACET)
    graded = _graded(points)
    reached = arc_length(graded)
    rising = np.concatenate([[True], np.diff(reached) > 0.0])
    graded, reached = graded[rising], reached[rising]
    middles, between = 0.5 * (reached[1:] + reached[:-1]), 0.5 * (graded[1:] + graded[:-1])
    for quartering in range(QUARTERINGS + 1):
        allowed = len(graded) * (error * 0.25**quartering) ** 2
        knots, poles, degree = cast(_Fitted, splprep(graded.T, u=reached, s=allowed, k=min(DEGREE, len(graded) - 1))[0])
        spline = BSpline(knots, np.stack(poles, axis=1), degree)
        # Neighbouring pieces go on from the very ends.
        spline.c[[0, -1]] = points[[0, -1]]
        off = max(norm(spline(reached) - graded).max(), norm(spline(middles) - between).max())
        if off <= 2.0 * FACET:
            return SmoothCurve(spline=spline, off=float(off))
    return None


def _error(points: Array) -> float:
    """How closely a smooth curve has to meet the points of a polyline, mm, root mean square.

    Exact points lie off the chords past them by four times what the segments lie off their curve. Of noise, these
    distances differ from those of their neighbours.
    """
    before, here, after = points[:-2], points[1:-1], points[2:]
    chord = unit(after - before)
    away = here - before
    away = away - np.sum(away * chord, axis=1)[:, None] * chord
    noise = away[1:-1] - 0.5 * (away[:-2] + away[2:])
    return max(OWN_ERROR * _size(away) / 4.0, NOISE * _size(noise) / NOISE_GAIN)


def _size(vectors: Array) -> float:
    """Root mean square of the lengths of (m, 3) vectors; 0 without any."""
    return float(np.sqrt(np.sum(vectors**2) / max(len(vectors), 1)))


def _graded(points: Array) -> Array:
    """The polyline with segments halved until none is much longer than one beside it."""
    for _ in range(HALVINGS):
        lengths = norm(np.diff(points, axis=0))
        beside = np.minimum(np.append(lengths[1:], np.inf), np.insert(lengths[:-1], 0, np.inf))
        places = np.flatnonzero((lengths > GRADING * beside) & (lengths > SHORTEST))
        if not len(places):
            break
        points = np.insert(points, places + 1, 0.5 * (points[places] + points[places + 1]), axis=0)
    return points
