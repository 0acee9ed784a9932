"""What the command line says of faces and cuts, as text, and what it means."""

from __future__ import annotations

import re
from typing import Literal

from cadpanel.errors import SettingsError

Auto = Literal["auto", "strips"]
AUTO: Auto = "auto"
STRIPS: Auto = "strips"
BY_FITS = (AUTO, STRIPS)
"""Numbers of panels that are found by fits: the fewest equal ones, and panels each as wide as a deviation allows."""
"""Instead of a number of panels: as few as hold what is asked of a fit."""

# One choice of faces and the comma behind it: what holds a comma stands in quotation marks, "" for one of them.
CHOICE = re.compile(
    r'\s*(?:(?P<key>\w+\s*=\s*)?"(?P<quoted>(?:[^"]|"")*)"|(?P<bare>(?!\w+\s*=\s*")[^",][^,]*|))\s*(?:,|$)'
)


def choices_of(text: str, what: str = "faces") -> tuple[str, ...]:
    """The choices in a text with commas between them: '3, layer="Skin, north"' are 3 and layer=Skin, north.

    Args:
        text: as users write it.
        what: is chosen, for messages.

    Raises:
        SettingsError: a quotation mark is not closed, or something follows it.
    """
    found, start = [], 0
    while start <= len(text):
        choice = CHOICE.match(text, start)
        if choice is None:
            raise SettingsError(
                f"{what}: the quotation marks in {text!r} do not enclose one choice each; write them like "
                '\'"Roof, north",layer="Skin, east",3\''
            )
        quoted = choice["quoted"]
        found.append(choice["bare"] if quoted is None else (choice["key"] or "") + quoted.replace('""', '"'))
        start = choice.end() if choice[0].endswith(",") else len(text) + 1
    return tuple(found)


def choice_named(word: str) -> str:
    """How a name or layer is written among choices."""
    found = CHOICE.fullmatch(word)
    return word if found is not None and found["bare"] == word else '"{}"'.format(word.replace('"', '""'))


def parse_divide(text: str) -> int | Auto:
    """A number of panels, "auto" or "strips".

    Raises:
        SettingsError: the text is none of these.
    """
    for word in BY_FITS:
        if text.strip() == word:
            return word
    if re.fullmatch(r"\s*-?\d{1,9}\s*", text) is None:
        raise SettingsError(f"--divide is a number of panels, {AUTO} or {STRIPS}, not '{text}'.")
    return int(text)


def parse_grid(text: str) -> tuple[int, int]:
    """Two numbers of panels from "20x10".

    Raises:
        SettingsError: the text is not of that form.
    """
    found = re.fullmatch(r"\s*(\d{1,7})\s*[xX]\s*(\d{1,7})\s*", text)
    if found is None:
        raise SettingsError(f"--grid is two numbers of panels like 20x10, not '{text}'.")
    return int(found[1]), int(found[2])


def parse_panel_size(text: str) -> tuple[float, float]:
    """Two lengths from "1500x800".

    Raises:
        SettingsError: the text is not of that form.
    """
    words = re.split("[xX]", text)
    try:
        u, v = (float(word) for word in words)
    except ValueError:
        raise SettingsError(f"--panel-size is two lengths in mm like 1500x800, not '{text}'.") from None
    return u, v


def parse_stations(text: str) -> tuple[float, ...]:
    """Lengths from "1200,2400,3600".

    Raises:
        SettingsError: one of them is no number.
    """
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError:
        raise SettingsError(f"--stations are lengths in mm like 1200,2400,3600, not '{text}'.") from None
