"""Flat curves as circular arcs that follow them within a tolerance, for machines that know nothing else.

An arc is told as drawings tell it: two ends and the bulge, the tangent of a quarter of the angle that it sweeps,
positive where it turns to the left. Each stretch of a curve becomes two arcs that meet each other and the curve's ends
without a kink (biarcs), so that the largest error falls with the cube of their number.
"""

from __future__ import annotations

import math
from typing import Protocol, Self

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.vectors import side_of, unit

# Places at which a stretch is held against its two arcs.
_SAMPLES = 17
# Part of the tolerance that is used up at those places, so that it holds between them, and where a flat arc is drawn as
# a line.
_USED = 0.8
# A curve that leaves its chord by less than this part of the tolerance is a segment.
_STRAIGHT = 0.01
# An arc that bows by less is a line to every program: by less than this, mm, and by less than this times its chord's
# square, 1/mm: its centre would be so far away that its ends, told by angles, would be off by 1e-6 mm.
_LEAST_BOW, _LEAST_CURVATURE = 1e-6, 3e-10
# By how much more stretches there are at most in the next attempt.
_MOST_MORE = 4.0


class Followed(Protocol):
    """c curves in the plane, each followed by u from 0 to 1."""

    @property
    def start(self) -> Array:
        """(c, 2) where they begin, mm."""
        ...

    @property
    def curved(self) -> BoolArray:
        """(c,) which of them are no segments."""
        ...

    def __len__(self) -> int: ...

    def take(self, rows: IntArray) -> Self:
        """Some of them, perhaps one several times."""
        ...

    def points(self, u: Array) -> Array:
        """(c, q, 2) points at parameters (c, q)."""
        ...

    def velocities(self, u: Array) -> Array:
        """(c, q, 2) derivatives of `points`."""
        ...


def arc_chains(curves: Followed, chord: float) -> list[Array]:
    """Every curve as a chain of arcs within `chord` mm of it: (v, 3) the start of each arc, and its bulge.

    The chain's end is the curve's; it is not among them.
    """
    stretches = np.ones(len(curves), dtype=np.intp)
    while True:
        rows = np.repeat(np.arange(len(curves)), stretches)
        first = (np.arange(len(rows)) - (np.cumsum(stretches) - stretches)[rows]) / stretches[rows]
        vertices, off, sag = _biarcs(curves.take(rows), first, 1.0 / stretches[rows])
        worst, bow = np.zeros(len(curves)), np.zeros(len(curves))
        np.maximum.at(worst, rows, off)
        np.maximum.at(bow, rows, sag)
        straight = ~curves.curved | ((stretches == 1) & (bow <= _STRAIGHT * chord))
        rough = ~straight & (worst > _USED * chord)
        if not rough.any():
            return _chains(curves, vertices, stretches, straight)
        more = np.clip(np.cbrt(worst[rough] / (_USED * chord)), 1.1, _MOST_MORE)
        stretches[rough] = np.ceil(stretches[rough] * more).astype(np.intp)


def _chains(curves: Followed, vertices: Array, stretches: IntArray, straight: Array) -> list[Array]:
    own = np.split(vertices, np.cumsum(stretches)[:-1])
    return [
        np.array([[*curves.start[row], 0.0]]) if straight[row] else arcs.reshape(-1, 3) for row, arcs in enumerate(own)
    ]


def _biarcs(curves: Followed, first: Array, share: Array) -> tuple[Array, Array, Array]:
    """Two arcs over the stretch of each curve that begins at `first` (c,) and goes on for `share` (c,) of it.

    Returns:
        (c, 2, 3) starts and bulges; (c,) distance of the curve from its arcs; (c,) distance from its chord.
    """
    u = first[:, None] + share[:, None] * np.linspace(0.0, 1.0, _SAMPLES)
    points, ways = curves.points(u), curves.velocities(u[:, [0, -1]])
    ways = ways / np.linalg.norm(ways, axis=-1)[..., None]
    start, stop, (leaving, arriving) = points[:, 0], points[:, -1], np.swapaxes(ways, 0, 1)
    chord = stop - start
    square, onward = (chord**2).sum(axis=-1), (chord * (leaving + arriving)).sum(axis=-1)
    turning = 1.0 - (leaving * arriving).sum(axis=-1)
    # Both arcs' tangents are as long: the root that stays finite where the curve is straight.
    reach = (square / (onward + np.sqrt(onward**2 + 2.0 * turning * square)))[:, None]
    joint = 0.5 * (start + stop + reach * (leaving - arriving))
    angles = np.stack([_turn(leaving, joint - start), _turn(stop - joint, arriving)], axis=-1)
    bulges = np.tan(0.5 * angles)
    vertices = np.concatenate([np.stack([start, joint], axis=1), bulges[..., None]], axis=-1)
    onto = (chord - reach * (leaving + arriving))[:, None]
    off = np.where(
        ((points - joint[:, None]) * onto).sum(axis=-1) < 0.0,
        _off_arc(start, joint - start, angles[:, 0], leaving, points),
        _off_arc(stop, joint - stop, angles[:, 1], -arriving, points, mirrored=True),
    )
    sag = np.abs(side_of(start[:, None], stop[:, None], points)) / np.sqrt(square)[:, None]
    return vertices, off.max(axis=-1), sag.max(axis=-1)


def _turn(before: Array, after: Array) -> Array:
    """Angles (c,) by which directions turn to the left."""
    angles: Array = np.arctan2(side_of(np.zeros(2), before, after), (before * after).sum(axis=-1))
    return angles


def _off_arc(end: Array, chord: Array, angle: Array, way: Array, points: Array, *, mirrored: bool = False) -> Array:
    """Distances (c, q) of points from the circles that leave `end` (c, 2) in the direction `way`.

    `angle` (c,) is that from the way to the chord, half of what the arc sweeps; mirrored, it is told from its end.
    """
    curvature = (2.0 * np.sin(angle) / np.linalg.norm(chord, axis=-1))[:, None] * (-1.0 if mirrored else 1.0)
    # Coordinate by coordinate: where two numbers lie side by side, NumPy takes three times as long.
    x, y = points[..., 0] - end[:, :1], points[..., 1] - end[:, 1:]
    height, square = way[:, :1] * y - way[:, 1:] * x, x**2 + y**2
    inside = 1.0 - 2.0 * curvature * height + curvature**2 * square
    return np.asarray(np.abs(2.0 * height - curvature * square) / (1.0 + np.sqrt(np.maximum(inside, 0.0))))


def arc_contour_area(vertices: Array) -> float:
    """Area in mm2 inside a closed chain of arcs (v, 3), positive where it runs counterclockwise."""
    start, stop = vertices[:, :2], np.roll(vertices[:, :2], -1, axis=0)
    origin = start.mean(axis=0)
    polygon = 0.5 * side_of(np.zeros(2), start - origin, stop - origin)
    sweep = 4.0 * np.arctan(vertices[:, 2])
    square = ((stop - start) ** 2).sum(axis=-1)
    # (sweep - sin sweep) / 2 radius^2 with radius = chord / (2 sin(sweep / 2)), without a division by nothing.
    half = np.where(sweep == 0.0, 1.0, sweep)
    beside = np.where(sweep == 0.0, 0.0, square * (half - np.sin(half)) / (8.0 * np.sin(0.5 * half) ** 2))
    return float((polygon + beside).sum())


def off_arcs(vertices: Array, points: Array) -> Array:
    """Distances (q,) in mm of points (q, 2) from the nearest arc of a closed chain (v, 3), each below half a circle."""
    start, stop = vertices[:, :2], np.roll(vertices[:, :2], -1, axis=0)
    chord, half = stop - start, 2.0 * np.arctan(vertices[:, 2])
    cosine, sine = np.cos(half)[:, None], np.sin(half)[:, None]
    across = np.stack([-chord[:, 1], chord[:, 0]], axis=-1)
    leaving, arriving = unit(cosine * chord - sine * across), unit(cosine * chord + sine * across)
    on_circle = _off_arc(start, chord, half, leaving, np.broadcast_to(points, (len(start), *points.shape)))
    (x, y), (to_x, to_y) = ((points[:, 0] - end[:, :1], points[:, 1] - end[:, 1:]) for end in (start, stop))
    before = x * leaving[:, :1] + y * leaving[:, 1:] < 0.0
    beyond = to_x * arriving[:, :1] + to_y * arriving[:, 1:] > 0.0
    from_end = np.sqrt(np.where(before, x**2 + y**2, to_x**2 + to_y**2))
    return np.asarray(np.where(before | beyond, from_end, on_circle).min(axis=0))


def arc_circle(start: Array, stop: Array, bulge: float) -> tuple[Array, float]:
    """Centre (2,) and radius in mm of the circle on which an arc lies; its bulge is not 0."""
    chord = stop - start
    left = np.array([-chord[1], chord[0]])
    centre: Array = 0.5 * (start + stop) + left * (1.0 - bulge**2) / (4.0 * bulge)
    return centre, math.hypot(*chord) * (1.0 + bulge**2) / (4.0 * abs(bulge))


def all_but_straight(start: Array, stop: Array, bulge: float) -> bool:
    """Whether an arc is told better as the line between its ends: its centre would be too far away to be told."""
    chord = math.dist(start, stop)
    return abs(bulge) * 0.5 * chord < max(_LEAST_BOW, _LEAST_CURVATURE * chord**2)
