"""Do two panels' numbers make the same sheet? Millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch, Patch
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.vectors import dot

SAME_LENGTH = 1e-9
"""Difference in mm of lengths that are one: what is built of them differs by far less than two points that are one."""
SAME_TURN = 1e-12
"""Difference in radians, or of unit vectors, that is rounding's; a panel's radii of 1e5 mm make 1e-7 mm of it."""


@singledispatch
def alike(_one: Panel, _other: Panel) -> bool:
    """Whether two panels differ by rounding only, and so do their sheets; never said of a kind that has no entry."""
    return False


@alike.register
def _chains_alike(one: PanelShape, other: Panel) -> bool:
    """The same of panels between rulings."""
    if type(one) is not type(other):
        return False
    if (one.feature, one.square, len(one.patches)) != (other.feature, other.square, len(other.patches)):
        return False
    if not all(_patches_alike(own, wanted) for own, wanted in zip(one.patches, other.patches, strict=True)):
        return False
    turns = ((one.directions, other.directions), (one.normals, other.normals), (one.cut_normals, other.cut_normals))
    # Where on a cut plane its point lies says nothing.
    level = dot(one.cut_points - other.cut_points, one.cut_normals)
    lengths = (
        (one.points, other.points),
        (one.corners(), other.corners()),
        (one.side_leans, other.side_leans),
        (np.array(one.lift), np.array(other.lift)),
        (level, np.zeros(2)),
    )
    return _near(turns, SAME_TURN) and _near(lengths, SAME_LENGTH)


def _patches_alike(one: Patch, other: Patch) -> bool:
    if not (isinstance(one, ConePatch) and isinstance(other, ConePatch)):
        return type(one) is type(other)
    return (
        one.kind == other.kind
        and abs(one.radius - other.radius) <= SAME_LENGTH
        and max(abs(one.half_angle - other.half_angle), abs(one.sweep - other.sweep)) <= SAME_TURN
    )


def _near(pairs: Sequence[tuple[Array, Array]], limit: float) -> bool:
    return all((np.abs(one - other) <= limit).all() for one, other in pairs)
