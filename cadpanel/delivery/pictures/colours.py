"""What panels can be coloured by, in the colours of the page."""

from __future__ import annotations

import math
from collections.abc import Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Literal, get_args

from cadpanel.errors import SettingsError

if TYPE_CHECKING:
    from matplotlib.colors import Colormap

Colour = Literal["deviation", "gap", "step", "kink", "feature", "radius"]
COLOURS: tuple[Colour, ...] = get_args(Colour)
OF_SEAMS = frozenset({"gap", "step", "kink"})
"""These are seen along seams, the others on panels."""
DIVERGING = ("#1f5fa8", "#6fa6d6", "#f1f1ee", "#ec9178", "#ad1f2d")
SEQUENTIAL = ("#f6e3bd", "#f3b266", "#e2704f", "#b23a6b", "#5c1b73")
CATEGORIES = ("#4e79a7", "#f0a43a", "#6aa36f", "#b07aa1", "#8c6d4f", "#d4a6a0", "#59a5b8", "#8a8f98")
NEUTRAL, FLAT, LINE, ACCENT = "#c3ccd4", "#d9dee2", "#4a5662", "#0b5cad"
_STEPS = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


def require_matplotlib() -> None:
    """Refuse to draw without the library that draws.

    Raises:
        SettingsError: it is not installed; the message says how to install it.
    """
    if find_spec("matplotlib") is None:
        raise SettingsError("pictures need matplotlib: install it with pip install 'cadpanel[plot]'")


def require_colour(color: str) -> None:
    """Refuse what panels cannot be coloured by.

    Raises:
        SettingsError: naming what they can.
    """
    if color not in COLOURS:
        raise SettingsError(f"panels cannot be coloured by '{color}'; choose from {', '.join(COLOURS)}")


def colour_map(stops: Sequence[str]) -> Colormap:
    """The colours between some."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("cadpanel", list(stops))


def rounded_up(value: float) -> float:
    """The least round number that is not below a value: ends of scales are read, not measured."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    # A value that rounding has put above the last step is that step.
    return next((step * power for step in _STEPS if step * power >= value * (1.0 - 1e-6)), 10.0 * power)
