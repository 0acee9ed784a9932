"""Keywords that a step does not know, and the sentence that says which was meant, or which step it belongs to."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields
from typing import Any, TypedDict, TypeVar

from cadpanel.delivery.settings import Ends, Schema, SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.near import near_names
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.setting import options_of

Function = TypeVar("Function", bound=Callable[..., Any])
_WIDTH = 120
_SHARES = " A share: 0.01 is 1 %."


class MadeKeywords(TypedDict, total=False):
    """How sheets are made: walls in the planes of joints or square to the sheet, holes and returns, as `deliver` does.

    Attributes:
        ends: "bevel" or "square".
        fixings: diameter of fixing holes, their largest pitch and the distance of their middles from the edge, mm.
        returns: length of folded sides on their outer face and their inner radius, mm.
    """

    ends: Ends
    fixings: Sequence[float] | None
    returns: Sequence[float] | None


class SheetKeywords(TypedDict, total=False):
    """What a sheet is, for those who build it."""

    thickness: float
    joint: float
    skin_side: SkinSide
    schema: Schema


_SETTINGS = {
    "read": (ReferenceSettings,),
    "fit": (FitSettings,),
    "deliver": (SheetSettings, ShopSettings),
}
"""What each step is told by keywords."""


def check_keywords(step: str, given: Iterable[str]) -> None:
    """Refuse keywords that a step does not know.

    Args:
        step: "read", "fit" or "deliver".
        given: the keywords' names.

    Raises:
        SettingsError: naming the step that knows it, or the keyword that it is nearly like.
    """
    known = {name: [one.name for kind in kinds for one in fields(kind)] for name, kinds in _SETTINGS.items()}
    for keyword in given:
        if keyword in known[step]:
            continue
        home = next((other for other, names in known.items() if keyword in names), None)
        if home is not None:
            raise SettingsError(f"'{keyword}' is no setting of {step}(): give it to {home}()")
        raise SettingsError(f"{step}() knows no setting '{keyword}'; {near_names(keyword, known[step])}")


def check_made(given: Iterable[str]) -> None:
    """Refuse keywords by which no sheet is made.

    Raises:
        SettingsError: naming the keyword that it is nearly like.
    """
    known = [*SheetKeywords.__annotations__, *MadeKeywords.__annotations__]
    for keyword in given:
        if keyword not in MadeKeywords.__annotations__:
            raise SettingsError(f"sheets are made by no setting '{keyword}'; {near_names(keyword, known)}")


def spells_keywords(step: str) -> Callable[[Function], Function]:
    """Spell out at the end of a function's docstring the keywords of a step, each with its default and its meaning.

    Args:
        step: "read", "fit" or "deliver".
    """

    def spelled(function: Function) -> Function:
        named = inspect.signature(function).parameters
        lines = [
            f"{field.name}={field.default!r}: {option.help}{_SHARES if option.metavar == 'PERCENT' else ''}"
            for kind in _SETTINGS[step]
            for field, option in options_of(kind)
            if field.name not in named
        ]
        filled = (
            textwrap.fill(line, _WIDTH, initial_indent=8 * " ", subsequent_indent=12 * " ", break_on_hyphens=False)
            for line in lines
        )
        function.__doc__ = "\n".join([f"{(function.__doc__ or '').rstrip()}\n", "    Keywords:", *filled, "    "])
        return function

    return spelled
