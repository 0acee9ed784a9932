"""Which sides of a panel are folded, and what is said of those that are not."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.returns import SIDES, ReturnRule, foldable_sides, with_returns


@dataclass(frozen=True, slots=True, kw_only=True)
class Returned:
    """A panel with its returns.

    Attributes:
        shape: the panel.
        sides: that have one.
        notes: which have none, and why; one sentence.
    """

    shape: Panel
    sides: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def returned(shape: Panel, meeting: Collection[str], sheet: SheetSettings, shop: ShopSettings) -> Returned:
    """A panel with the returns that are asked for.

    Args:
        shape: as it is cut.
        meeting: its edges at which it meets another one.
        sheet: of what it is made.
        shop: what is asked for.

    Raises:
        PanelError: nothing is left of a return behind its fold.
    """
    if shop.returns is None:
        return Returned(shape=shape)
    if not isinstance(shape, Chain):
        return Returned(shape=shape, notes=("It has no returns: only panels with two sides have.",))
    length, radius = shop.returns
    flat = foldable_sides(shape)
    sides = tuple(side for side in flat if side not in meeting)
    why = {side: "meets a neighbour" if side in flat else "is rolled round" for side in SIDES if side not in sides}
    rule = ReturnRule(length=length, inner_radius=radius)
    return Returned(
        shape=with_returns(shape, sides, rule, sheet.thickness, sheet.skin_side),
        sides=sides,
        notes=tuple(f"It has no return along {side}, which {reason}." for side, reason in why.items()),
    )
