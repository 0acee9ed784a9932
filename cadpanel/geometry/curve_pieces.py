"""Segments and arcs of ellipse in one table, and how far they reach in any direction. Millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from cadpanel.arrays import Array, IntArray

BoolArray = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


@dataclass(frozen=True, slots=True, kw_only=True)
class CurvePieces:
    """n pieces center + cos(w) * cosine_axis + sin(w) * sine_axis for arcs, center + w * cosine_axis for segments.

    Attributes:
        centers: (n, 3) mm; a segment's start.
        cosine_axes: (n, 3); a segment's whole span.
        sine_axes: (n, 3); zero for a segment.
        starts: (n,) least parameter; 0 for a segment.
        stops: (n,) greatest parameter; 1 for a segment.
        arcs: (n,) whether it is an arc.
    """

    centers: Array
    cosine_axes: Array
    sine_axes: Array
    starts: Array
    stops: Array
    arcs: BoolArray

    def __len__(self) -> int:
        return len(self.centers)

    def take(self, chosen: BoolArray | IntArray) -> CurvePieces:
        """The pieces at these places."""
        return CurvePieces(**{one.name: getattr(self, one.name)[chosen] for one in fields(self)})

    def reach(self, directions: Array) -> tuple[Array, Array]:
        """Least and greatest (d, n) inner product of each direction (d, 3) with the points of each piece.

        Exact: c + A cos(w) + B sin(w) is extreme at the ends or where w is atan2(B, A), or half a turn from there.
        """
        middle, cosine, sine = (directions @ of.T for of in (self.centers, self.cosine_axes, self.sine_axes))
        ends = [
            middle + np.where(self.arcs, np.cos(w), w) * cosine + np.where(self.arcs, np.sin(w), 0.0) * sine
            for w in (self.starts, self.stops)
        ]
        least, greatest = np.minimum(*ends), np.maximum(*ends)
        swing = np.hypot(cosine, sine)
        peak = np.arctan2(sine, cosine)
        for turn, sign in ((0.0, 1.0), (np.pi, -1.0)):
            ahead = np.mod(peak + turn - self.starts, 2.0 * np.pi)
            met = self.arcs & (ahead <= self.stops - self.starts)
            value = np.where(met, middle + sign * swing, middle)
            least = np.where(met, np.minimum(least, value), least)
            greatest = np.where(met, np.maximum(greatest, value), greatest)
        return least, greatest


def segments(starts: Array, stops: Array) -> CurvePieces:
    """Segments between points (n, 3)."""
    count = len(starts)
    return CurvePieces(
        centers=starts,
        cosine_axes=stops - starts,
        sine_axes=np.zeros((count, 3)),
        starts=np.zeros(count),
        stops=np.ones(count),
        arcs=np.zeros(count, dtype=bool),
    )


def together(pieces: Sequence[CurvePieces]) -> CurvePieces:
    """All pieces of some in one table."""
    return CurvePieces(
        **{one.name: np.concatenate([getattr(some, one.name) for some in pieces]) for one in fields(CurvePieces)}
    )
