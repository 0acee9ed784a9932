"""Which stretch across a panel becomes its curved patches, where the user says so instead of the surface's normals."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from cadpanel.errors import SettingsError

FORM = re.compile(
    r"(?:(?P<panel>.*\S)\s*=)?\s*(?P<first>\d+\.?\d*)\s*-\s*(?P<last>\d+\.?\d*)\s*(?P<percent>%?)\s*", re.DOTALL
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Blend:
    """A stretch across panels, between two flanges.

    Attributes:
        first, last: where it begins and ends on both ends of a panel, from side 0 on: mm along the end, or percent of
            the end's length.
        percent: whether they are percent.
        panel: name of the panel that is meant, all panels if None.
    """

    first: float
    last: float
    percent: bool = False
    panel: str | None = None

    def __post_init__(self) -> None:
        """Refuse what is no stretch.

        Raises:
            SettingsError: the numbers do not rise, or lie outside the panel.
        """
        if not (math.isfinite(self.last) and 0.0 < self.first < self.last and (not self.percent or self.last < 100.0)):
            raise SettingsError(
                f"the blend '{self}' must begin after side 0, end beyond its beginning and leave a flange on both sides"
            )

    def __str__(self) -> str:
        """As `parse` takes it."""
        panel = "" if self.panel is None else f"{self.panel}="
        return f"{panel}{self.first:.12g}-{self.last:.12g}{'%' if self.percent else ''}"

    @staticmethod
    def parse(text: str) -> Blend:
        """The stretch that "410-540", "40-55%" or "NW-03=410-540" means.

        Raises:
            SettingsError: the text is not of that form.
        """
        found = FORM.fullmatch(text)
        if found is None:
            raise SettingsError(
                f"a blend is a stretch across the panels like 410-540 (mm), 40-55% or NW-03=410-540, not '{text}'"
            )
        return Blend(
            first=float(found["first"]),
            last=float(found["last"]),
            percent=bool(found["percent"]),
            panel=found["panel"],
        )


def blends_of(value: object) -> tuple[Blend, ...]:
    """Blends from what a user may give: nothing, one, or several, as text or made already.

    Raises:
        SettingsError: one of them is none, or two are for the same panel.
    """
    if value is None:
        return ()
    given = [value] if isinstance(value, str | Blend) else list(value) if isinstance(value, Iterable) else [value]
    blends = []
    for one in given:
        if not isinstance(one, str | Blend):
            raise SettingsError(f"a blend is text like '410-540' or a Blend, not {one!r}")
        blends.append(Blend.parse(one) if isinstance(one, str) else one)
    panels = [one.panel for one in blends]
    for panel in panels:
        if panels.count(panel) > 1:
            raise SettingsError(f"two blends are for {'all panels' if panel is None else repr(panel)}: leave one out")
    return tuple(blends)
