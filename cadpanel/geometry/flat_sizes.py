"""How large flat patterns are: areas, lengths of edges, and the rectangles that they are cut from, many at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.geometry.flat_curves import joined
from cadpanel.geometry.smallest_rectangle import Rectangle, smallest_rectangle
from cadpanel.geometry.unroll import FlatPattern
from cadpanel.geometry.unroll_trays import of_corner

# Points on each curved piece; between two of them it bulges by less than 0.01 mm.
_POINTS = 64


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatSize:
    """The numbers of one flat pattern.

    Attributes:
        area: inside its outline, mm2, to rounding error.
        pieces: the length of each piece of the outline, mm, to rounding error.
        edges: the length of each edge, in the order of the outline, mm; what belongs to reliefs is left out.
        blank: the smallest rectangle about it, to 0.01 mm.
    """

    area: float
    pieces: tuple[float, ...]
    edges: dict[str, float]
    blank: Rectangle


def flat_sizes(patterns: Sequence[FlatPattern]) -> list[FlatSize]:
    """The numbers of many patterns."""
    curves = joined([pattern.curves for pattern in patterns])
    stops = np.cumsum([len(pattern.curves) for pattern in patterns])[:-1]
    shares = np.broadcast_to(np.arange(_POINTS) / _POINTS, (len(curves), _POINTS))
    columns = (curves.lengths(), curves.areas(), curves.points(shares))
    lengths, areas, points = (np.split(column, stops) for column in columns)
    return [
        FlatSize(
            area=float(areas[i].sum()),
            pieces=tuple(lengths[i].tolist()),
            edges=_by_edge(pattern.edges, lengths[i].tolist()),
            blank=smallest_rectangle(points[i].reshape(-1, 2)),
        )
        for i, pattern in enumerate(patterns)
    ]


def _by_edge(edges: Sequence[str], lengths: Sequence[float]) -> dict[str, float]:
    found = dict.fromkeys((edge for edge in edges if not of_corner(edge)), 0.0)
    for edge, length in zip(edges, lengths, strict=True):
        if edge in found:
            found[edge] += length
    return found
