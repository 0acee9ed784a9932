"""Level seams: how far the rings of a column or tower may leave the planes in which they are drawn.

The turn of a seam is limited in the skin, and three degrees are a decimetre on a panel of 2 m: rings would still wave.
Which seams are drawn level is told by `reference.level_seams`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.edge_pieces import places
from cadpanel.terms.limits.limit import Limit, Measured, Panels, Row
from cadpanel.terms.limits.planes import PlaneTerm
from cadpanel.terms.term import HeldTerm


class SeamLevel(Limit):
    """Of the corners of level seams, and of points on their arcs, mm to either side."""

    name = "seam_level"
    what = "distance of level seams from their planes"
    default = 1.0
    least, most = 0.01, 1000.0
    help = "How far rings of seams that are drawn in a plane may leave it to either side; 1000 for any."
    yields = True
    yields_last = True
    remedy = "seams that are less level"
    rows = (Row("max_off_level", "Level seams off their planes, mm", "{:.2f}"),)

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`."""
        level = panels.outline.level
        if allowed[self.name] >= self.most or not len(level.panels):
            return []
        padded = max(group.feature.corner_count for group in panels.layout.groups)
        within = np.full(len(level.panels), (1.0 - margin) * allowed[self.name] / panels.place.length)
        at = places(level.points, padded)
        return [PlaneTerm(level.panels, at, level.normals, level.offsets, within, panels.layout.panels)]

    def measure(self, measured: Measured) -> Array:
        """See `Limit.measure`."""
        return np.nan_to_num(measured.off_level, nan=0.0)

    def worst(self, measured: Measured) -> float | None:
        """See `Limit.worst`: nothing where no seam is drawn level."""
        return None if np.isnan(measured.off_level).all() else super().worst(measured)

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        del length
        return (
            f"a level seam of panel '{panel}' lies {value:.2f} mm off the plane in which it is drawn, where "
            f"{allowed:g} mm are allowed"
        )
