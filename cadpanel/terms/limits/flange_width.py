"""Flange width: no flat patch narrows to nothing, or turns inside out, at either end."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Group
from cadpanel.features.rulings import Points, Walk
from cadpanel.geometry.vectors import cross, dot
from cadpanel.terms.limits.chains import chains_of
from cadpanel.terms.limits.limit import Limit, Panels, Row, Shapes
from cadpanel.terms.limits.lower_bound import LackTerm
from cadpanel.terms.term import HeldTerm


class FlangeWidth(Limit):
    """The least width of a flat patch beside a curved one, mm; it is the same for every shop and no setting."""

    name = "flange_width"
    what = "least width of a flange"
    default = 1.0
    asked = False
    at_least = True
    remedy = "more drift"
    rows = (Row("least_flange_width", "Narrowest flange, mm", "{:.1f}", "flat beside a bend"),)

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`; a `LackTerm` has a margin of its own."""
        del margin
        least, groups = allowed[self.name] / panels.place.length, panels.layout.groups
        return [
            WidthTerm(group, place, panels.layout.panels, least)
            for place, group in enumerate(groups)
            if any(group.feature.curved) and not all(group.feature.curved)
        ]

    def measure(self, measured: Shapes) -> Array:
        """See `Limit.measure`."""
        least = np.full(len(measured.shapes), np.inf)
        for chains in chains_of(measured.shapes):
            if len(chains.curved):
                least[chains.panels] = chains.widths[:, :, chains.flat].min(axis=(1, 2), initial=np.inf)
        return least

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        del length
        return f"a flange of panel '{panel}' is {value:.2f} mm wide at an end, where {allowed:g} mm are the least"

    def bound(self, dimension: str) -> float | None:
        """The width that a flange has in its middle."""
        return self.default if dimension == "width" else None


class WidthTerm(LackTerm):
    """Holds the widths of the flat patches of one group of panels, at both ends, above a least one."""

    def __init__(self, group: Group, place: int, panels: int, least: float) -> None:
        """See `LackTerm`; the feature is a chain with a flat patch."""
        flat = [i for i, curved in enumerate(group.feature.curved) if not curved]
        self._which = np.repeat(flat, 2)
        self._places = self._which + np.tile([0, len(group.feature.curved) + 1], len(flat))
        super().__init__(group, place, panels, least, 2 * len(flat))

    def lengths(self, walked: Walk, corners: Points, *, derivatives: bool) -> tuple[Array, Array]:
        """From each first ruling square across to the corner on the next, at both ends of every flat patch."""
        edges, which, places = walked.edges, self._which, self._places
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
