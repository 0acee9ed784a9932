"""Panels that need not be built anew to be held against their files: they were, from the numbers of their records."""

from __future__ import annotations

from collections.abc import Sequence

from cadpanel.brep.proof.inspection import boundary_of
from cadpanel.brep.proof.rebuilt import Rebuilt
from cadpanel.delivery.sheets import PanelSheet
from cadpanel.geometry.alike import alike
from cadpanel.geometry.panel import Panel


def built_already(panels: Sequence[PanelSheet], shapes: Sequence[Panel]) -> dict[str, Rebuilt]:
    """By name, what bounds the sheets without holes that were built from what the records say, but for rounding.

    Args:
        panels: as they were built.
        shapes: the same as their records give them back.
    """
    return {
        panel.shape.name: Rebuilt(solid=boundary_of(panel.solid), skin=boundary_of(panel.skin))
        for panel, shape in zip(panels, shapes, strict=True)
        if panel.fixings is None and alike(panel.shape, shape)
    }
