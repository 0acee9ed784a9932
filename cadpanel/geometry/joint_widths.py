"""How wide a joint may be before a panel is too small for it. Millimetres."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from cadpanel.errors import PanelError
from cadpanel.geometry.edge_planes import SeamEdges
from cadpanel.geometry.joints import seam_planes, walls_of
from cadpanel.geometry.panel import CutPlane, Panel
from cadpanel.geometry.sheet_checks import SkinSide, check_buildable, sheet_depth

HALVINGS = 12
"""Of the span in which the widest joint is sought: to a part in four thousand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TooWide:
    """The panel that is the first to be too small as the joint gets wider, and what to say of it."""

    panel: str
    reason: str


def widest_joint(
    shapes: Sequence[Panel],
    seams: Sequence[SeamEdges],
    joint: float,
    thickness: float,
    skin_side: SkinSide,
    *,
    square: bool = False,
) -> TooWide | None:
    """Which panel is too small for a joint of that width, and what width all of them have room for.

    None where it is not for the joint that a panel cannot be built: then it cannot without one, either.
    """
    planes = seam_planes(shapes, seams)

    def failing(width: float) -> list[int]:
        walls = walls_of(len(shapes), seams, planes, width)
        return [i for i in sought if _refused(shapes[i], walls[i], thickness, skin_side, square=square)]

    sought = list(range(len(shapes)))
    sought = failing(joint)
    if not sought or failing(0.0):
        return None
    low, high = 0.0, joint
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        found = failing(middle)
        if found:
            high, sought = middle, found
        else:
            low = middle
    return TooWide(
        panel=shapes[sought[0]].name,
        reason=f"it is too small for a joint of {joint:g} mm all round: ask for one of at most {_below(low):g} mm, or "
        "divide the reference into fewer panels.",
    )


def _refused(shape: Panel, walls: dict[str, CutPlane], thickness: float, skin_side: SkinSide, *, square: bool) -> bool:
    depth = sheet_depth(thickness, skin_side)
    try:
        cut = shape.cut_back(walls, depth) if walls else shape
        check_buildable(cut.squared(depth) if square else cut, thickness, skin_side)
    except PanelError:
        return True
    return False


def _below(width: float) -> float:
    """The width, rounded down to two digits."""
    if width <= 0.0:
        return 0.0
    step = 10.0 ** (math.floor(math.log10(width)) - 1)
    return math.floor(width / step) * step
