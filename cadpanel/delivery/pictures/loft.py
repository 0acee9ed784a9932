"""A loft as a picture: its rulings in space, its flat pattern, and its warp along both rails."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cadpanel.delivery.pictures.colours import ACCENT, CATEGORIES, LINE, require_matplotlib
from cadpanel.lofting.loft import MEASURED, Loft

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE, _DOTS = (13.0, 4.6), 100
_RULINGS = 25
# Below this, degrees, warp is rounding, and the scale would show nothing else.
_NONE = 1e-6


def draw_loft(loft: Loft) -> Figure:
    """Draw a loft; each piece has a colour of its own.

    Raises:
        SettingsError: matplotlib is missing.
    """
    require_matplotlib()
    from cadpanel.delivery.pictures.figure import Picture

    figure = Picture(figsize=_SIZE, dpi=_DOTS, layout="constrained")
    space = figure.add_subplot(1, 3, 1, projection="3d")
    flat, along = figure.add_subplot(1, 3, 2), figure.add_subplot(1, 3, 3)
    for number, (a, b) in enumerate(loft.rulings(_RULINGS)):
        colour = CATEGORIES[number % len(CATEGORIES)]
        for one, other in zip(a, b, strict=True):
            space.plot(*np.stack([one, other]).T, color=colour, linewidth=0.7)
        for rail in (a, b):
            space.plot(*rail.T, color=LINE, linewidth=1.4)
    space.set_aspect("equal")
    space.set_title(f"{loft.name}: rulings", fontsize=10, parse_math=False)
    _draw_flat(flat, loft)
    _draw_warp(along, loft)
    return figure


def _draw_flat(axes: Axes, loft: Loft) -> None:
    u = np.linspace(0.0, 1.0, _RULINGS)
    fine = np.linspace(0.0, 1.0, MEASURED)
    for number, piece in enumerate(loft.flat[0]):
        colour = CATEGORIES[number % len(CATEGORIES)]
        for line in piece.rulings(u):
            axes.plot(*line.T, color=colour, linewidth=0.7)
        for edge in piece.edges:
            axes.plot(*np.asarray(edge(fine)).T, color=LINE, linewidth=1.4)
    axes.set_aspect("equal")
    axes.set_title(f"flat pattern, lengths off by {loft.flat[1].length:.2g} mm at most", fontsize=10)
    axes.set_xlabel("mm")


def _draw_warp(axes: Axes, loft: Loft) -> None:
    for number, (piece, warps) in enumerate(zip(loft.pieces, loft.warps, strict=True)):
        first, last = piece.shares.mean(axis=-1) * 100.0
        axes.plot(np.linspace(first, last, MEASURED), np.degrees(warps), color=CATEGORIES[number % len(CATEGORIES)])
    axes.axhline(0.0, color=LINE, linewidth=0.6)
    axes.set_ylim(bottom=0.0, top=max(1.1 * float(np.degrees(loft.warps.max())), _NONE))
    axes.set_title(f"warp, largest {np.degrees(loft.max_warp):.2g} degrees", fontsize=10, color=ACCENT)
    axes.set_xlabel("along the rails, %")
    axes.set_ylabel("degrees")
