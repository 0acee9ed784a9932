"""One flat pattern as a picture: its outline, and dashed where it bends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cadpanel.delivery.page.flats import flat_lines
from cadpanel.delivery.pictures.colours import ACCENT, require_matplotlib
from cadpanel.geometry.unroll import FlatPattern

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZE, _DOTS = (7.0, 7.0), 110


def draw_flat(pattern: FlatPattern) -> Figure:
    """Draw a flat pattern, seen from outside.

    Raises:
        SettingsError: matplotlib is missing.
    """
    require_matplotlib()
    from cadpanel.delivery.pictures.figure import Picture

    outline, bends = flat_lines(pattern)
    figure = Picture(figsize=_SIZE, dpi=_DOTS, layout="constrained")
    axes = figure.add_subplot()
    axes.fill(*outline.T, facecolor="#eef3f8", edgecolor="#1c2733", linewidth=1.2)
    for line in bends:
        axes.plot(*np.transpose(line), color=ACCENT, linewidth=1.0, linestyle=(0, (5, 4)))
    axes.set_aspect("equal")
    axes.set_xlabel("mm")
    axes.set_ylabel("mm")
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(f"{pattern.name}: flat pattern, seen from outside", fontsize=11, parse_math=False)
    return figure
