"""Panels coloured by one of their numbers, or by their feature."""

from __future__ import annotations

from typing import Any, Sequence, Tuple

from .documents import panels_of

Color = Tuple[float, float, float]

BY = {"deviation": "LargestDeviation", "gap": "LargestGap", "kink": "LargestKink", "radius": "LeastRadius"}
"""The property that each way of colouring looks at; "feature" looks at no number."""
FEATURE = "feature"
_STOPS = ((0.27, 0.00, 0.33), (0.23, 0.32, 0.55), (0.13, 0.57, 0.55), (0.37, 0.79, 0.38), (0.99, 0.91, 0.14))
_KINDS = ((0.23, 0.32, 0.55), (0.99, 0.55, 0.14), (0.13, 0.57, 0.55), (0.75, 0.22, 0.27), (0.60, 0.60, 0.20))
_NOTHING = (0.60, 0.60, 0.60)


def color_by(document: Any, what: str) -> str:
    """Colour the panels of a document by "deviation", "gap", "kink", "radius" or "feature".

    Returns:
        What the colours mean, in one line.
    """
    panels = panels_of(document)
    colors, legend = _by_feature(panels) if what == FEATURE else _by_number(panels, what)
    for panel, color in zip(panels, colors):
        panel.ViewObject.ShapeColor = color
    return f"{what}: {legend}"


def _by_feature(panels: Sequence[Any]) -> tuple[list[Color], str]:
    kinds = sorted({panel.Feature for panel in panels})
    colors = {kind: _KINDS[place % len(_KINDS)] for place, kind in enumerate(kinds)}
    return [colors[panel.Feature] for panel in panels], ", ".join(kinds)


def _by_number(panels: Sequence[Any], what: str) -> tuple[list[Color], str]:
    name = BY[what]
    quantities = [getattr(panel, name) if name in panel.PropertiesList else None for panel in panels]
    numbers = [quantity.Value for quantity in quantities if quantity is not None]
    if not numbers:
        return [_NOTHING] * len(panels), "no panel has one"
    least, largest = min(numbers), max(numbers)
    ends = [next(one for one in quantities if one is not None and one.Value == end) for end in (least, largest)]
    words = [one.UserString for one in ends]
    if words[0] == words[1]:  # with more digits, where FreeCAD's few say the same of both
        words = [f"{one.Value:.6g} {word.split()[-1]}" for one, word in zip(ends, words)]
    legend = " to ".join(words)
    if len(numbers) < len(panels):
        legend += "; grey has none"
    return [_NOTHING if one is None else _ramp(one.Value, least, largest) for one in quantities], legend


def _ramp(value: float, least: float, largest: float) -> Color:
    place = 0.0 if largest <= least else (value - least) / (largest - least) * (len(_STOPS) - 1)
    step = min(int(place), len(_STOPS) - 2)
    low, high = _STOPS[step], _STOPS[step + 1]
    red, green, blue = (a + (b - a) * (place - step) for a, b in zip(low, high))
    return red, green, blue
