"""Can a sheet of this thickness be built on a panel's skin? Refuses with the panel's name and one clear reason."""

from __future__ import annotations

from numbers import Real
from typing import Literal, get_args

from cadpanel.errors import PanelError
from cadpanel.geometry.limits import THICKEST_SHEET, THINNEST_SHEET
from cadpanel.geometry.panel import Panel, Shape

SkinSide = Literal["outer", "inner"]


def check_buildable(shape: Panel, thickness: float, skin_side: SkinSide = "outer") -> None:
    """Refuse a panel whose sheet of `thickness` mm cannot be built; "outer": the sheet lies at -n, "inner": at +n.

    Raises:
        PanelError: for the reasons of `Panel.check` and `Panel.check_sheet`, or a thickness or side that is none.
    """
    given: object = thickness
    if isinstance(given, bool) or not isinstance(given, Real) or not THINNEST_SHEET <= thickness <= THICKEST_SHEET:
        raise PanelError(
            shape.name,
            f"the sheet thickness is {thickness!r} mm; give a number from {THINNEST_SHEET:g} to {THICKEST_SHEET:g}.",
        )
    if skin_side not in get_args(SkinSide):
        raise PanelError(shape.name, f"the skin side is '{skin_side}'; give {' or '.join(get_args(SkinSide))}.")
    shape.check()
    shape.check_sheet(other_face(shape, thickness, skin_side), thickness)


def other_face(shape: Shape, thickness: float, skin_side: SkinSide) -> Shape:
    """The parallel skin on the far face of the sheet."""
    return shape.offset(sheet_depth(thickness, skin_side))


def sheet_depth(thickness: float, skin_side: SkinSide) -> float:
    """Where the far face of the sheet lies, mm along the skin's normal."""
    return -thickness if skin_side == "outer" else thickness


def skin_side_of(depth: float) -> SkinSide:
    """On which side of the sheet the skin is, of which the other face lies at a depth, mm along the normal."""
    return "outer" if depth < 0.0 else "inner"
