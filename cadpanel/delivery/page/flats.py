"""Flat patterns as lines to look at, in tenths of a millimetre; what is cut by is in the drawings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.unroll import FlatPattern

_STEPS = 12
"""In which a curved piece is followed."""
_TENTHS = 10.0
_MIDDLE = np.array([0.5])


def flat_lines(pattern: FlatPattern) -> tuple[Array, Array]:
    """The outline (q, 2) of a flat pattern and the lines (m, 2, 2) where it bends, mm."""
    curves = pattern.curves
    share = np.linspace(0.0, 1.0, _STEPS, endpoint=False)
    followed = curves.points(np.broadcast_to(share, (len(curves), _STEPS)))
    outline = np.concatenate(
        [points if bent else points[:1] for points, bent in zip(followed, curves.curved.tolist(), strict=True)]
    )
    middles = [pattern.rulings(bend, _MIDDLE) for bend in pattern.bends]
    return outline, np.concatenate([pattern.tangents, *middles])


def packed_flats(patterns: Sequence[FlatPattern], circles: Sequence[Array] = ()) -> list[dict[str, Any]]:
    """The same as JSON holds it: x and y in turn, of holes (h, 3) their diameters, too."""
    packed = [
        {"outline": _whole(outline), "bends": [_whole(line) for line in bends]}
        for outline, bends in map(flat_lines, patterns)
    ]
    for flat, own in zip(packed, circles, strict=False):
        if len(own):
            flat["holes"] = _whole(own)
    return packed


def like_flats(shown: object, wanted: Sequence[dict[str, Any]]) -> bool:
    """Whether what a page holds are these flat patterns; a number just between two may be rounded to either."""
    if not isinstance(shown, list) or len(shown) != len(wanted):
        return False
    return all(
        isinstance(one, dict) and one.keys() == other.keys() and all(_near(one[key], other[key]) for key in other)
        for one, other in zip(shown, wanted, strict=True)
    )


def _near(shown: object, wanted: list[Any]) -> bool:
    rows = [[row] if isinstance(row, int) else row for row in wanted]
    if not isinstance(shown, list) or len(shown) != len(rows):
        return False
    for row, other in zip(shown, rows, strict=True):
        own = [row] if isinstance(row, int) else row
        if not isinstance(own, list) or len(own) != len(other) or not all(isinstance(value, int) for value in own):
            return False
        if any(abs(one - two) > 1 for one, two in zip(own, other, strict=True)):
            return False
    return True


def _whole(points: Array) -> list[int]:
    tenths: list[int] = np.rint(_TENTHS * points).astype(np.int64).ravel().tolist()
    return tenths
