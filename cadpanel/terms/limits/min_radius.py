"""Rolling radius: no cone or cylinder gets tighter at its corners than a shop can roll, and no apex falls inside.

Along a generatrix the normal radius changes evenly: at a distance h from the level where it is r it is r + h tan(g). It
is least at a corner, so that is where it is held.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.distance import patch_outer
from cadpanel.features.layout import Group
from cadpanel.features.rulings import Points, Walk
from cadpanel.geometry.frames import point_velocity
from cadpanel.geometry.vectors import dot
from cadpanel.terms.limits.lower_bound import LackLimit


class RadiusLimit(LackLimit):
    """Holds the normal radii at the corners of the curved patches of one group of panels above a least one."""

    def __init__(self, group: Group, place: int, panels: int, least: float) -> None:
        """See `LackLimit`; the feature has a curved patch."""
        self._curved = [i for i, curved in enumerate(group.feature.curved) if curved]
        super().__init__(group, place, panels, least, 4 * len(self._curved))

    def lengths(self, walked: Walk, corners: Points, *, derivatives: bool) -> tuple[Array, Array]:
        """The radii at four corners of every curved patch, positive on its own side of the axis."""
        parts = [_radii(walked, corners, patch, derivatives=derivatives) for patch in self._curved]
        return np.concatenate([part[0] for part in parts], axis=1), np.concatenate([part[1] for part in parts], axis=1)


def _radii(walked: Walk, corners: Points, patch: int, *, derivatives: bool) -> tuple[Array, Array]:
    edges, rulings = walked.edges, walked.edges.p.shape[1]
    which = np.array([patch, patch + 1, patch, patch + 1])
    places = which + np.array([0, 0, rulings, rulings])
    radius, angle = (walked.dimensions[patch].values[:, i, None] for i in (0, 1))
    sign, widening = np.sign(radius), np.tan(angle)
    height = dot(corners.position[:, places] - edges.p[:, which], edges.t[:, which])
    radii = sign * (radius + height * widening)
    if not derivatives:
        return radii, np.zeros((*radii.shape, 0))
    if corners.jacobian is None or edges.twist is None:
        raise ValueError("the state was walked without derivatives")
    # The corner lies on the ruling, so turning the ruling does not change its height to first order.
    moved = corners.jacobian[:, places] - point_velocity(edges.twist[:, which], edges.p[:, which])
    slope = widening[..., None] * (edges.t[:, which][..., None, :] @ moved)[..., 0, :]
    inner = np.stack([np.ones_like(height), height * (1.0 + widening**2)], axis=-1)
    slope += inner @ patch_outer(walked, patch)[:, 6:]
    return radii, sign[..., None] * slope
