"""Which edges of a panel are folded, and what is said of those that are not."""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.returns import SIDES, ReturnRule, foldable_sides, with_returns
from cadpanel.geometry.trays import edges_round, foldable_edges, folded_tray, is_flat


@dataclass(frozen=True, slots=True, kw_only=True)
class Returned:
    """A panel with its returns.

    Attributes:
        shape: the panel.
        edges: that have one.
        notes: which have none, and why; one sentence.
        tray: of a flat panel their length and inner radius, mm.
    """

    shape: Panel
    edges: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    tray: tuple[float, float] | None = None


def returned(shape: Panel, sheet: SheetSettings, shop: ShopSettings) -> Returned:
    """A panel with the returns that are asked for: all round a flat one, along the flat sides of one with bends.

    Args:
        shape: as it is cut.
        sheet: of what it is made.
        shop: what is asked for.

    Raises:
        PanelError: nothing is left of a return behind its fold, or returns would meet inside of the panel.
    """
    if shop.returns is None:
        return Returned(shape=shape)
    length, radius = shop.returns
    rule = ReturnRule(length=length, inner_radius=radius)
    if is_flat(shape):
        return _tray(shape, rule, sheet)
    if not isinstance(shape, Chain):
        return Returned(shape=shape, notes=("It has no returns: nobody has said how panels of its kind are folded.",))
    sides = foldable_sides(shape)
    why = {
        **{side: "is rolled round" for side in SIDES if side not in sides},
        **dict.fromkeys(("end 0", "end 1"), "is curved"),
    }
    return Returned(
        shape=with_returns(shape, sides, rule, sheet.thickness, sheet.skin_side),
        edges=sides,
        notes=tuple(f"It has no return along {edge}, which {reason}." for edge, reason in why.items()),
    )


def _tray(shape: Panel, rule: ReturnRule, sheet: SheetSettings) -> Returned:
    edges, why = foldable_edges(shape, rule, sheet.thickness, sheet.skin_side)
    if not edges:
        reason = "its edges are too short" if why is None else why
        return Returned(shape=shape, notes=(f"It has no returns: {reason}.",))
    short = [edge for edge in edges_round(shape) if edge not in edges]
    return Returned(
        shape=folded_tray(shape, edges, rule, sheet.thickness, sheet.skin_side),
        edges=edges,
        notes=tuple(f"It has no return along {edge}, which is too short for one." for edge in short),
        tray=(rule.length, rule.inner_radius),
    )
