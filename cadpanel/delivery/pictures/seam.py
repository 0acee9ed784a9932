"""One seam as a picture: gap, width, step and kink along its length."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cadpanel.delivery.page.scene import SeamScene
from cadpanel.delivery.pictures.colours import ACCENT, require_matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZE, _DOTS = (9.0, 5.0), 110


def draw_seam(seam: SeamScene) -> Figure:
    """Draw a seam's profile, from one end of its first panel's edge to the other.

    Raises:
        SettingsError: matplotlib is missing.
    """
    require_matplotlib()
    from cadpanel.delivery.pictures.figure import Picture

    profile = seam.profile
    rows = (
        ("gap, mm", profile.gap),
        ("width, mm", profile.width),
        ("step, mm", profile.step),
        ("kink, degrees", np.degrees(profile.kink)),
    )
    figure = Picture(figsize=_SIZE, dpi=_DOTS, layout="constrained")
    for axes, (label, values) in zip(figure.subplots(2, 2, sharex=True).flat, rows, strict=True):
        axes.plot(profile.along, values, color=ACCENT, linewidth=1.6)
        axes.fill_between(profile.along, values, color=ACCENT, alpha=0.12, linewidth=0.0)
        axes.set_ylim(bottom=0.0)
        axes.set_xlim(0.0, profile.along[-1])
        axes.set_title(f"{label}: at most {values.max():.2f}", loc="left", fontsize=10)
        axes.grid(visible=True, alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    figure.supxlabel("along the seam, mm", fontsize=10)
    # A dollar sign in a name would begin a formula.
    figure.suptitle(" | ".join(seam.panels), parse_math=False)
    return figure
