"""Keywords that a step does not know, and the sentence that says which was meant, or which step it belongs to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings
from cadpanel.near import near_names
from cadpanel.reference.settings import ReferenceSettings

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
