"""A developable surface between two rails."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, norm
from cadpanel.kinds import checked
from cadpanel.lofting.checks import check_rails, cut_at_corners, same_way, size_of
from cadpanel.lofting.distance import Distance, check_distance
from cadpanel.lofting.flat import FlatError, FlatPiece, unrolled
from cadpanel.lofting.kinds import Kind, kind_of
from cadpanel.lofting.pairing import best_pairing
from cadpanel.lofting.pieces import Piece, pieces_of
from cadpanel.lofting.rail import Rail, rail_of
from cadpanel.lofting.ruled import RuledSurface
from cadpanel.lofting.settling import settled
from cadpanel.lofting.warp import squares

PLACES = 129
"""Places on each rail that are paired."""
SHARED = 5e-8
"""How far a ruling that two faces share may lie off them, mm: half of the tolerance of edges."""
MEASURED = 257
"""Rulings of each piece at which warp is measured."""


@dataclass(frozen=True, eq=False)
class Segment:
    """What is spanned between two corners.

    Attributes:
        rails: the parts of both rails.
        cost: what the best of all pairings of `PLACES` places costs; see `pairing`.
        exact: whether every ruling was moved to where it has one tangent plane.
        pieces: fans and what lies between them.
        kinds: what each of these is.
    """

    rails: tuple[Rail, Rail]
    cost: float
    exact: bool
    pieces: tuple[Piece, ...]
    kinds: tuple[Kind, ...]


@dataclass(frozen=True, eq=False)
class Loft:
    """A surface between two rails, as developable as they allow.

    Attributes:
        name: for reports and products.
        distance: what its pairing makes small.
        rails: both, followed the same way.
        size: the diagonal of a box about them, mm.
        segments: from corner to corner.
    """

    name: str
    distance: Distance
    rails: tuple[Rail, Rail]
    size: float
    segments: tuple[Segment, ...]

    def __repr__(self) -> str:
        return f"<Loft '{self.name}': {self.rails[0]!r} to {self.rails[1]!r}, {len(self.segments)} segments>"

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """All pieces, each of which begins where the one before it ends."""
        return tuple(piece for segment in self.segments for piece in segment.pieces)

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """What each piece is."""
        return tuple(kind for segment in self.segments for kind in segment.kinds)

    @property
    def faces(self) -> tuple[Kind, ...]:
        """On what each piece is built: with others beside it, what its rulings lie on within `SHARED`, or splines."""
        alone = len(self.pieces) == 1
        return tuple(kind if kind is not None and (alone or kind.off <= SHARED) else None for kind in self.kinds)

    @property
    def exact(self) -> bool:
        """Whether every ruling has one tangent plane."""
        return all(segment.exact for segment in self.segments)

    @cached_property
    def warps(self) -> Array:
        """(pieces, MEASURED) the warp along each piece, radians."""
        u = np.linspace(0.0, 1.0, MEASURED)
        return np.array([piece.warp(u) for piece in self.pieces])

    @cached_property
    def creases(self) -> Array:
        """Angles between pieces that follow each other inside of a segment, radians."""
        found = []
        for segment in self.segments:
            for before, after in zip(segment.pieces, segment.pieces[1:], strict=False):
                one, other = before.normals(np.ones(1))[0], after.normals(np.zeros(1))[0]
                found.append(np.arctan2(norm(cross(one, other)), one @ other))
        return np.array(found)

    @property
    def max_warp(self) -> float:
        """The largest warp or crease, radians."""
        return float(max(self.warps.max(), self.creases.max(initial=0.0)))

    @property
    def off(self) -> float:
        """How far its edges leave the rails at most, mm."""
        pairs = zip(self.pieces, self.faces, strict=True)
        return max(piece.off + (0.0 if face is None else face.off) for piece, face in pairs)

    @cached_property
    def flat(self) -> tuple[tuple[FlatPiece, ...], FlatError]:
        """It in the plane, and by how much that is wrong; see `flat`."""
        return unrolled(self.pieces)

    def ruled(self) -> tuple[RuledSurface, ...]:
        """Each piece as a ruled B-spline surface, with its dual form."""
        return tuple(piece.ruled() for piece in self.pieces)

    def rulings(self, count: int) -> Iterator[tuple[Array, Array]]:
        """Of each piece `count` rulings: (count, 3) their ends on both rails, mm."""
        for piece in self.pieces:
            a, b = piece.jets(np.linspace(0.0, 1.0, count))
            yield a.point, b.point


@checked
def loft(
    a: Rail | BSpline | Array, b: Rail | BSpline | Array, *, distance: Distance = "warp", name: str = "loft"
) -> Loft:
    """Span a developable surface between two rails.

    Args:
        a: a rail as `rails` reads it, a spline of scipy, or points (q, 3) along a smooth curve, mm.
        b: the other one; whichever way it runs.
        distance: what the pairing makes small: "warp", the angle between the tangent planes at both ends of a ruling,
            or "tangent-planes", their distance after Hoschek.
        name: for reports and products.

    Raises:
        LoftError: a rail is none, stands still, closes, meets the other one, is 20 times as long, or has a corner of
            its own; both lie on one line.
        SettingsError: there is no such distance.
    """
    how = check_distance(distance)
    rail_a, rail_b = rail_of(a, "A"), rail_of(b, "B")
    size = size_of(rail_a, rail_b)
    rail_b = same_way(rail_a, rail_b)
    check_rails(rail_a, rail_b, size)
    segments = tuple(_segment(pair, how, size) for pair in cut_at_corners(rail_a, rail_b))
    return Loft(name, how, (rail_a, rail_b), size, segments)


def _segment(rails: tuple[Rail, Rail], distance: Distance, size: float) -> Segment:
    shares = np.linspace(0.0, 1.0, PLACES)
    q = squares(*rails, shares, shares, distance)
    best = best_pairing(q, shares, shares)
    smooth = settled(rails, (shares, shares), best.path)
    pieces = pieces_of(smooth, size)
    return Segment(rails, best.cost, smooth.exact, pieces, tuple(kind_of(piece, size) for piece in pieces))
