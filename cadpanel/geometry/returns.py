"""Returns: edges of a sheet folded inwards, along sides of chains that are flat there. Millimetres and radians.

A return is two more patches of the chain, a cylinder and a plane, so that all that is known of chains is known of it,
too. The outer face of its leg lies where the wall of the side stood, and turns away from the sheet as that leaned.
Sides of round patches have none: no edge of a rolled zone is folded straight by a brake. Nor have ends that bend with
the sheet. Panels that are flat are folded all round, as `trays` says.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.panel import Chain
from cadpanel.geometry.patches import ConePatch, PlanePatch
from cadpanel.geometry.sheet_checks import SkinSide

SomeChain = TypeVar("SomeChain", bound=Chain)
SIDES = ("side 0", "side 1")
PATCHES = 2
"""Patches that a return adds to its side."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReturnRule:
    """How edges are folded.

    Attributes:
        length: of the leg, from the outermost line of the sheet to its edge, on the outer face, mm.
        inner_radius: of the fold, mm.
    """

    length: float
    inner_radius: float


@dataclass(frozen=True, slots=True)
class _Fold:
    """One fold: the ruling where it begins on the skin, and what it is folded by."""

    point: Array
    outward: float
    angle: float
    radius: float
    leg: float


def foldable_sides(shape: Chain) -> tuple[str, ...]:
    """The sides that are flat."""
    return tuple(side for place, side in enumerate(SIDES) if isinstance(shape.patches[-place], PlanePatch))


def with_returns(
    shape: SomeChain, sides: Iterable[str], rule: ReturnRule, thickness: float, skin_side: SkinSide
) -> SomeChain:
    """The chain with returns along some of its flat sides, folded away from its outside.

    Args:
        shape: as it is cut.
        sides: that get one.
        rule: how they are folded.
        thickness: of the sheet, mm.
        skin_side: "outer" where the sheet lies inside of the skin.

    Raises:
        PanelError: nothing is left of a leg behind its fold.
    """
    found = shape
    for side in sides:
        place = SIDES.index(side)
        found = _folded(found, place, _fold(shape, place, rule, thickness, skin_side))
    return found


def tangent_length(rule: ReturnRule, thickness: float, angle: float) -> float:
    """How far a fold reaches from the outermost line on either side of it, mm."""
    return (rule.inner_radius + thickness) * math.tan(0.5 * angle)


def leg_behind(name: str, edge: str, rule: ReturnRule, thickness: float, reach: float) -> float:
    """What is left of a leg behind a fold that reaches so far, mm.

    Raises:
        PanelError: less than the sheet is thick.
    """
    leg = rule.length - reach
    if leg < thickness:
        raise PanelError(
            name,
            f"a return of {rule.length:g} mm leaves {max(leg, 0.0):.3g} mm behind its fold at {edge}; ask for "
            f"one of at least {math.ceil(reach + thickness)} mm, or for a smaller radius.",
        )
    return leg


def _fold(shape: Chain, place: int, rule: ReturnRule, thickness: float, skin_side: SkinSide) -> _Fold:
    outward = 1.0 if place else -1.0
    binormal = shape.binormals()[-place]
    lean = float(shape.side_leans[place])
    angle = 0.5 * math.pi + math.atan(outward * lean)
    reach = tangent_length(rule, thickness, angle)
    leg = leg_behind(shape.name, f"side {place}", rule, thickness, reach)
    # The outer face is that of the skin, or the other one; both have the fold's beginning at the same ruling.
    out = 0.0 if skin_side == "outer" else thickness
    begins = shape.points[-place] + (out * lean - outward * reach) * binormal
    return _Fold(begins, outward, angle, rule.inner_radius + thickness - out, leg)


def _folded(shape: SomeChain, place: int, fold: _Fold) -> SomeChain:
    """The chain with two more patches beyond one of its sides."""
    direction, normal, binormal = shape.directions[-place], shape.normals[-place], shape.binormals()[-place]
    cosine, sine = math.cos(fold.angle), math.sin(fold.angle)
    away = cosine * normal + fold.outward * sine * binormal
    onwards = cosine * binormal - fold.outward * sine * normal
    ends = fold.point + fold.radius * (away - normal)
    edge = ends + fold.outward * fold.leg * onwards
    kept = shape.points.copy()
    kept[-place] = fold.point

    def joined(own: Array, first: Array, last: Array) -> Array:
        return np.concatenate([own, [first, last]] if place else [[last, first], own])

    round_patch = ConePatch(radius=fold.radius, half_angle=0.0, sweep=fold.angle, kind="cylinder")
    new = (round_patch, PlanePatch())
    patches = (*shape.patches, *new) if place else (*new[::-1], *shape.patches)
    leans = shape.side_leans.copy()
    leans[place] = 0.0
    walked = shape.rewalked(
        joined(kept, ends, edge),
        joined(shape.directions, direction, direction),
        joined(shape.normals, away, away),
        patches,
    )
    return walked.trimmed(shape.cut_points, shape.cut_normals, leans)
