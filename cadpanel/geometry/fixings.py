"""Fixing holes in rows along the edges of a flat pattern, clear of corners, bends and each other. Millimetres.

A hole keeps its distance from every edge and from every line at which a bend begins or ends, and two holes are at least
2.2 diameters apart from middle to middle, edges 1.2 diameters from a hole's middle: the least that EN 1993-1-8 (table
3.3) allows for bolts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.flat_places import FlatPlace
from cadpanel.geometry.limits import LEAST_PITCH
from cadpanel.geometry.polyline import distances_to_polylines
from cadpanel.geometry.unroll import FlatPattern
from cadpanel.geometry.unroll_trays import of_corner

TOO_NEAR = 0.05
"""By how much a hole may come nearer to what it keeps away from, mm: curves are measured by their chords."""
# Points on each curved piece.
_POINTS = 257
# Of a hole that is rolled round, places along a radius and round the middle by which its volume is found.
_RADII, _TURNS = 12, 24
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_RADII)


@dataclass(frozen=True, slots=True, kw_only=True)
class FixingRule:
    """Which holes a panel gets.

    Attributes:
        diameter: of each, mm.
        pitch: largest distance between two of a row, mm.
        distance: from an edge to the middles of its row, mm.
    """

    diameter: float
    pitch: float
    distance: float

    @property
    def from_corner(self) -> float:
        """How far from the corners of an edge its row begins, so that the rows of two edges keep apart."""
        return max(2.0 * self.distance, self.distance + LEAST_PITCH * self.diameter / math.sqrt(2.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixing:
    """One hole.

    Attributes:
        edge: along which it stands.
        patch: of the panel in which it lies.
        place: (2,) its middle on the flat pattern.
    """

    edge: str
    patch: int
    place: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixings:
    """The holes of a panel.

    Attributes:
        holes: in the order of the outline.
        short: edges with a piece that is too short or too narrow for a hole.
    """

    holes: tuple[Fixing, ...] = ()
    short: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Hole:
    """A hole that is round on the flat pattern.

    Attributes:
        patch: in which it lies.
        place: of that patch, on the skin and in the plane.
        middle: (2,) in the plane, mm.
        diameter: mm.
    """

    patch: int
    place: FlatPlace
    middle: Array
    diameter: float


def fixings(pattern: FlatPattern, rule: FixingRule) -> Fixings:
    """The holes of a flat pattern: along every edge, in each patch a row of its own."""
    outline = _outline(pattern)
    holes: list[Fixing] = []
    short: dict[str, None] = {}
    for row, places in enumerate(_rows(pattern, rule, outline)):
        if of_corner(pattern.edges[row]):
            continue
        others = [*outline[:row], *outline[row + 1 :], *pattern.tangents]
        far = _distances(places, others) >= rule.distance - TOO_NEAR
        clear = [place for place in places[far] if _apart(place, holes, rule)]
        holes += [Fixing(edge=pattern.edges[row], patch=pattern.owners[row], place=place) for place in clear]
        if not len(places) or len(clear) < len(places):
            short[pattern.edges[row]] = None
    return Fixings(holes=tuple(holes), short=tuple(short))


def clearance(pattern: FlatPattern, places: Array) -> Array:
    """(m,) how far places (m, 2) are from the nearest edge, or line at which a bend begins or ends, mm."""
    return _distances(places, [*_outline(pattern), *pattern.tangents])


def hole_bending(place: FlatPlace, middle: Array, diameter: float) -> float:
    """The integral of 1 / r over a hole, mm, r the radius of the unrolled surface along its normal.

    At a height h over that surface an element of it has (1 + h / r) times its area: so much less or more does a hole
    take of a parallel one.
    """
    if place.frame is None:
        return 0.0
    radii = 0.25 * diameter * (1.0 + _NODES)
    turns = 2.0 * math.pi * np.arange(_TURNS) / _TURNS
    places = middle + radii[:, None, None] * np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    curvature = 1.0 / place.normal_radii(places.reshape(-1, 2)).reshape(_RADII, _TURNS)
    return 0.25 * diameter * float((_WEIGHTS * radii) @ curvature.sum(axis=1)) * 2.0 * math.pi / _TURNS


def _rows(pattern: FlatPattern, rule: FixingRule, outline: Sequence[Array]) -> Iterator[Array]:
    """For each piece of the outline the middles (m, 2) of its row, evenly along it."""
    for row, curve in enumerate(outline):
        lengths = np.concatenate([[0.0], np.linalg.norm(np.diff(curve, axis=0), axis=-1).cumsum()])
        free = float(lengths[-1]) - 2.0 * rule.from_corner
        if free < 0.0:
            yield np.empty((0, 2))
            continue
        # A row that is shorter than a hole needs has one, in its middle; a hair of room, so that no hole hangs on the
        # last digit.
        spaces = max(1, math.ceil(free / rule.pitch - 1e-9)) if free >= LEAST_PITCH * rule.diameter else 0
        ways = np.linspace(0.0, free, spaces + 1) if spaces else np.array([0.5 * free])
        u = np.interp(rule.from_corner + ways, lengths, np.linspace(0.0, 1.0, len(curve)))[None]
        piece = pattern.curves.take(slice(row, row + 1))
        velocities = piece.velocities(u)[0]
        inwards = np.stack([-velocities[:, 1], velocities[:, 0]], axis=-1)
        yield piece.points(u)[0] + rule.distance * inwards / np.linalg.norm(inwards, axis=-1, keepdims=True)


def _apart(place: Array, others: Sequence[Fixing], rule: FixingRule) -> bool:
    """Whether a hole keeps away from other holes."""
    least = LEAST_PITCH * rule.diameter - TOO_NEAR
    return all(float(np.linalg.norm(place - other.place)) >= least for other in others)


def _outline(pattern: FlatPattern) -> list[Array]:
    """Each piece as points (2, 2), or where it is curved (_POINTS, 2)."""
    u = np.broadcast_to(np.linspace(0.0, 1.0, _POINTS), (len(pattern.curves), _POINTS))
    points, curved = pattern.curves.points(u), pattern.curves.curved.tolist()
    return [along if bends else along[[0, -1]] for along, bends in zip(points, curved, strict=True)]


def _distances(places: Array, lines: Sequence[Array]) -> Array:
    """(m,) distances of places (m, 2) to the nearest of some polylines; those of as many points are taken at once."""
    nearest = np.full(len(places), np.inf)
    for count in sorted({len(line) for line in lines}):
        alike = np.stack([line for line in lines if len(line) == count])
        shared = np.broadcast_to(places, (len(alike), *places.shape))
        nearest = np.minimum(nearest, distances_to_polylines(shared, alike).min(axis=0))
    return nearest
