"""What rules on radii see of panels: how many bends each has, and their radii and half angles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.rule import Bends
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch

NUMBERS = ("radius", "half_angle")
"""What is fixed of a bend, in the order of `rule.Bends`."""


def bends_of(shapes: Sequence[Panel]) -> Array:
    """(panels, c, 2) radius in mm and half angle in radians of all bends; see `rule.Bends`."""
    found = [[_bend(patch) for patch in shape.patches if isinstance(patch, ConePatch)] for shape in shapes]
    values = np.full((len(shapes), max(map(len, found), default=0), 2), np.nan)
    for panel, bends in enumerate(found):
        values[panel, : len(bends)] = np.array(bends).reshape(-1, 2)
    return values


def _bend(patch: ConePatch) -> tuple[float, float]:
    return abs(patch.radius), patch.half_angle if patch.radius > 0.0 else -patch.half_angle


def numbers_of(feature: PanelFeature, what: str) -> list[int | None]:
    """For each bend of a feature which of its numbers is its radius or half angle; None where others tell it."""
    names = [number.name for number in feature.numbers]
    curved = [i for i, bent in enumerate(feature.curved) if bent]
    found = [f"patch {i}: {what}" for i in curved]
    return [names.index(name) if name in names else None for name in found]


def require_bends(names: Sequence[str], panels: Sequence[int], features: Sequence[PanelFeature], rule: str) -> int:
    """How many bends panels have.

    Raises:
        SettingsError: one has none, or another number of them than the others, or its radius is told otherwise.
    """
    counts = [sum(features[i].curved) for i in panels]
    for panel, count in zip(panels, counts, strict=True):
        if count == 0:
            raise SettingsError(
                f"the rule [{rule}] is about the bend of panel '{names[panel]}', which is flat as a "
                f"{features[panel].name}: leave that panel out"
            )
        if count != counts[0]:
            raise SettingsError(
                f"the rule [{rule}] makes panels alike that have other numbers of bends: '{names[panels[0]]}' has "
                f"{counts[0]}, '{names[panel]}' has {count}"
            )
        if None in numbers_of(features[panel], "radius"):
            raise SettingsError(
                f"the rule [{rule}] sets the radius of panel '{names[panel]}', which '{features[panel].name}' tells by "
                "other numbers: give that panel a feature of the catalogue"
            )
    return counts[0]


def common(bends: Bends, panels: IntArray) -> Array:
    """(c, 2) what the bends of panels come nearest to together: the geometric mean of radii, the mean of angles.

    Where one of the panels is made already, the bends of that one.
    """
    own = bends.values[panels]
    if bends.frozen[panels].any():
        own = own[bends.frozen[panels]][:1]
    return np.stack([np.exp(np.log(own[..., 0]).mean(axis=0)), own[..., 1].mean(axis=0)], axis=-1)
