"""Flange width: no flat patch narrows to nothing, or turns inside out, at either end."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Group
from cadpanel.features.rulings import Points, Walk
from cadpanel.geometry.vectors import cross, dot
from cadpanel.terms.limits.lower_bound import LackLimit


class WidthLimit(LackLimit):
    """Holds the widths of the flat patches of one group of panels, at both ends, above a least one."""

    def __init__(self, group: Group, place: int, panels: int, least: float) -> None:
        """See `LackLimit`; the feature is a chain with a flat patch."""
        self._flat = [i for i, curved in enumerate(group.feature.curved) if not curved]
        super().__init__(group, place, panels, least, 2 * len(self._flat))

    def lengths(self, walked: Walk, corners: Points, *, derivatives: bool) -> tuple[Array, Array]:
        """From each first ruling square across to the corner on the next, at both ends of every flat patch."""
        edges, rulings = walked.edges, walked.edges.p.shape[1]
        which = np.repeat(self._flat, 2)
        places = which + np.tile([0, rulings], len(self._flat))
        across = corners.position[:, places + 1] - corners.position[:, places]
        b = edges.b[:, which]
        widths = dot(across, b)
        if not derivatives:
            return widths, np.zeros((*widths.shape, 0))
        if corners.jacobian is None or edges.twist is None:
            raise ValueError("the state was walked without derivatives")
        moved = corners.jacobian[:, places + 1] - corners.jacobian[:, places]
        turned = cross(b, across)  # d(across . b) = omega . (b x across)
        omega = edges.twist[:, which][:, :, :3]
        return widths, (b[..., None, :] @ moved)[..., 0, :] + (turned[..., None, :] @ omega)[..., 0, :]
