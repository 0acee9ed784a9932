"""Rolling radius: no cone or cylinder gets tighter at its corners than a shop can roll, and no apex falls inside.

Along a generatrix the normal radius changes evenly: at a distance h from the level where it is r it is r + h tan(g). It
is least at a corner, so that is where it is held.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import SettingsError
from cadpanel.features.distance import patch_outers, round_numbers
from cadpanel.features.layout import Group
from cadpanel.features.patch_checks import greatest_radius
from cadpanel.features.rulings import PanelFeature, Points, Walk
from cadpanel.geometry.frames import velocity_of
from cadpanel.geometry.vectors import dot
from cadpanel.terms.limits.chains import chains_of
from cadpanel.terms.limits.limit import Limit, Panels, Row, Shapes
from cadpanel.terms.limits.lower_bound import LackTerm
from cadpanel.terms.term import HeldTerm


class MinRadius(Limit):
    """The tightest normal radius of a cone or cylinder that the shop can roll, mm."""

    name = "min_radius"
    what = "least radius"
    default = 10.0
    least = 0.1
    help = "Tightest radius that the shop can roll."
    at_least = True
    remedy = "a tighter radius"
    rows = (Row("least_radius", "Tightest radius, mm", "{:.1f}", "to roll or to bend"),)

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`; a `LackTerm` has a margin of its own."""
        del margin
        least, groups = allowed[self.name] / panels.place.length, panels.layout.groups
        return [
            RadiusTerm(group, place, panels.layout.panels, least)
            for place, group in enumerate(groups)
            if any(group.feature.curved)
        ]

    def measure(self, measured: Shapes) -> Array:
        """See `Limit.measure`."""
        least = np.full(len(measured.shapes), np.inf)
        for chains in chains_of(measured.shapes):
            for patch in chains.curved:
                radius, widening = chains.radius[:, patch, None, None], np.tan(chains.half_angle[:, patch, None, None])
                radii = np.sign(radius) * (radius + chains.heights(patch) * widening)
                least[chains.panels] = np.minimum(least[chains.panels], radii.min(axis=(1, 2)))
        return least

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        del length
        return f"the least radius of {allowed:g} mm is not met: panel '{panel}' gets as tight as {value:.2f} mm"

    def check_feature(self, feature: PanelFeature, allowed: float) -> None:
        """Refuse a feature whose author asks for a tighter radius than the shop can roll."""
        for i, patch in enumerate(feature.patches):
            if patch.kind != "plane" and greatest_radius(patch) < allowed:
                raise SettingsError(
                    f"the radius of patch {i} of '{feature.name}' is tighter than the least radius of {allowed:g} mm: "
                    "ask for a larger one, or allow a tighter one"
                )


class RadiusTerm(LackTerm):
    """Holds the normal radii at the corners of the curved patches of one group of panels above a least one."""

    def __init__(self, group: Group, place: int, panels: int, least: float) -> None:
        """See `LackTerm`; the feature has a curved patch."""
        self._curved = [i for i, curved in enumerate(group.feature.curved) if curved]
        rulings = len(group.feature.curved) + 1
        self._which = np.add.outer(self._curved, [0, 1, 0, 1]).reshape(-1)
        self._places = self._which + np.tile([0, 0, rulings, rulings], len(self._curved))
        super().__init__(group, place, panels, least, 4 * len(self._curved))

    def lengths(self, walked: Walk, corners: Points, *, derivatives: bool) -> tuple[Array, Array]:
        """The radii at four corners of every curved patch, positive on its own side of the axis."""
        edges, panels = walked.edges, len(walked.values)
        p, t = edges.p, edges.t
        radius, angle = (one[:, self._curved] for one in round_numbers(walked)[:2])
        sign, widening = np.sign(radius)[..., None], np.tan(angle)[..., None]
        # Each corner's height on its ruling (panels, ends * rulings), and then of the four of every curved patch.
        ends = corners.position.reshape(panels, 2, -1, 3)
        height = dot(ends - p[:, None], t[:, None]).reshape(panels, -1)[:, self._places].reshape(*radius.shape, 4)
        radii = (sign * (radius[..., None] + height * widening)).reshape(panels, -1)
        if not derivatives:
            return radii, np.zeros((*radii.shape, 0))
        if corners.jacobian is None or edges.twist is None:
            raise ValueError("the state was walked without derivatives")
        # The corner lies on the ruling, so turning the ruling does not change its height to first order.
        count = walked.values.shape[1]
        along = (t[:, None, :, None] @ corners.jacobian.reshape(*ends.shape, count))[..., 0, :]
        along -= ((t[:, :, None] @ velocity_of(p)) @ edges.twist)[:, None, :, 0]
        risen = along.reshape(panels, -1, count)[:, self._places].reshape(*height.shape, count)
        slope = (sign * widening)[..., None] * risen
        by_patch = patch_outers(walked)[:, self._curved, None, 6:]
        slope += sign[..., None] * by_patch[..., 0, :]
        slope += (sign * height * (1.0 + widening**2))[..., None] * by_patch[..., 1, :]
        return radii, slope.reshape(*radii.shape, count)
