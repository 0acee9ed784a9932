"""Obliqueness: at which angle the planes that cut a panel's ends meet its rulings and its cones.

Seen along the axis of a cone of half angle g the section by a plane whose normal has the cosine c with the axis is a
conic of eccentricity tan(g) sqrt(1 - c^2) / c (geometry/cone_sections.py). It stays at or below e as long as
c sqrt(e^2 + tan(g)^2) >= |tan(g)|: the plane meets the axis at atan(|tan(g)| / e) or more.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.cut_planes import unit_cut_plane_rates, unit_cut_planes
from cadpanel.features.distance import patch_outers, round_numbers
from cadpanel.features.layout import Group
from cadpanel.features.rulings import Points, Walk
from cadpanel.geometry.chain_checks import LARGEST_ECCENTRICITY, SMALLEST_CUT_COSINE
from cadpanel.geometry.vectors import cross
from cadpanel.terms.limits.chains import chains_of
from cadpanel.terms.limits.limit import Limit, Panels, Row, Shapes
from cadpanel.terms.limits.lower_bound import LackTerm
from cadpanel.terms.term import HeldTerm

# Ends are held a little squarer than they must be, so that rounding cannot break them: panels of 12 degrees are cut so.
_SQUARER = 1.01


class Obliqueness(Limit):
    """The least angle between an end's cut and a ruling, degrees; it is the same for every shop and no setting.

    A cone is cut at that angle where the eccentricity of its section is the largest that can be built.
    """

    name = "obliqueness"
    what = "least angle of a cut"
    default = float(np.degrees(np.arcsin(SMALLEST_CUT_COSINE)))
    unit = "degrees"
    asked = False
    at_least = True
    remedy = "more drift"
    rows = (Row("least_cut_angle", "Most oblique cut of an end, degrees", "{:.1f}", "90 is square to the bend"),)

    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """See `Limit.held`; a `LackTerm` has a margin of its own."""
        del margin
        least, groups = np.sin(np.radians(allowed[self.name])), panels.layout.groups
        return [
            ObliquenessTerm(group, place, panels.lengths, least)
            for place, group in enumerate(groups)
            if len(group.feature.cut_numbers)
        ]

    def measure(self, measured: Shapes) -> Array:
        """See `Limit.measure`."""
        least = np.full(len(measured.shapes), np.inf)
        for chains in chains_of(measured.shapes):
            cuts = np.swapaxes(chains.cut_normals, 1, 2)
            met = np.arcsin(np.clip(chains.directions @ cuts, -1.0, 1.0)).min(axis=(1, 2))
            if len(chains.curved):
                angle = chains.half_angle[:, chains.curved]
                t, n = chains.directions[:, chains.curved], chains.normals[:, chains.curved]
                axes = np.cos(angle)[..., None] * t - np.sin(angle)[..., None] * n
                steep = np.arctan(np.abs(np.tan(angle)) / LARGEST_ECCENTRICITY)[..., None]
                spare = np.arcsin(np.clip(axes @ cuts, -1.0, 1.0)) - steep
                met = np.minimum(met, np.arcsin(SMALLEST_CUT_COSINE) + spare.min(axis=(1, 2)))
            least[chains.panels] = np.degrees(met)
        return least

    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """See `Limit.missed`."""
        del length
        return (
            f"an end of panel '{panel}' is cut too obliquely, at {value:.1f} degrees, where {allowed:g} are the least "
            "that can be built"
        )


class ObliquenessTerm(LackTerm):
    """Holds the ends of one group of panels square enough: sines, in the lengths of their panels."""

    def __init__(self, group: Group, place: int, lengths: Array, least: float) -> None:
        """Hold them above the sine `least`; panels have these lengths (panels,) in the solver's unit."""
        feature = group.feature
        self._cones = [i for i, patch in enumerate(feature.patches) if patch.kind == "cone"]
        self._far, self._sine = lengths[group.panels][:, None], least
        ends, rulings = len(feature.cut_numbers), len(feature.patches) + 1
        count = ends * (rulings + 2 * len(self._cones))
        super().__init__(group, place, len(lengths), _SQUARER * least * self._far, count)

    def lengths(self, walked: Walk, corners: Points, *, derivatives: bool) -> tuple[Array, Array]:
        """Sines of the angles to rulings, end by end, and what is left of those to cones, moved by the least sine."""
        del corners
        planes, rates = unit_cut_planes(walked)[0], unit_cut_plane_rates(walked)[0] if derivatives else None
        parts = [_rise(walked.edges.t, walked.edges.twist if derivatives else None, planes, rates)]
        if self._cones:
            parts.append(self._at_cones(walked, planes, rates))
        sines = self._far * np.concatenate([part[0] for part in parts], axis=1)
        if not derivatives:
            return sines, parts[0][1]
        return sines, self._far[..., None] * np.concatenate([part[1] for part in parts], axis=1)

    def _at_cones(self, walked: Walk, planes: Array, rates: Array | None) -> tuple[Array, Array]:
        """C sqrt(e^2 + tan(g)^2) -+ tan(g) of all cones, both of which are 0 or more where the section is an ellipse.

        Whichever sign the half angle has: their smaller one has a corner at a half angle of 0, each has none. First
        those with - of both ends, end by end, then those with +.
        """
        panels, ends = planes.shape[:2]
        t, n = walked.carriers.t[:, self._cones], walked.carriers.n[:, self._cones]
        angle = round_numbers(walked)[1][:, self._cones]
        cosine, sine, widening = np.cos(angle)[..., None], np.sin(angle)[..., None], np.tan(angle)[:, None]
        outer = None if rates is None else patch_outers(walked)[:, self._cones]
        rise, risen = _rise(cosine * t - sine * n, None if outer is None else outer[:, :, :6], planes, rates)
        rise = rise.reshape(panels, ends, -1)
        root = np.sqrt(LARGEST_ECCENTRICITY**2 + widening**2)
        values = np.concatenate([root * rise - widening, root * rise + widening], axis=1) + self._sine
        values = values.reshape(panels, -1)
        if outer is None:
            return values, np.zeros((*values.shape, 0))
        opened = outer[:, None, :, 7]
        risen = (
            risen.reshape(*rise.shape, -1) + (planes @ np.swapaxes(-sine * t - cosine * n, 1, 2))[..., None] * opened
        )
        steeper = (1.0 + widening**2)[..., None] * opened
        both = root[..., None] * risen + (rise * widening / root)[..., None] * steeper
        slopes = np.concatenate([both - steeper, both + steeper], axis=1)
        return values, slopes.reshape(*values.shape, -1)


def _rise(t: Array, twist: Array | None, planes: Array, rates: Array | None) -> tuple[Array, Array]:
    """(n, ends R) sines at which planes meet directions (n, R, 3), end by end, and their derivatives (n, ends R, N)."""
    sines = planes @ np.swapaxes(t, 1, 2)
    flat = sines.reshape(len(t), -1)
    if twist is None or rates is None:
        return flat, np.zeros((*flat.shape, 0))
    # A direction that is carried with a ruling turns by its twist: u . (omega x t) = omega . (t x u).
    turned = cross(t[:, None], planes[:, :, None])
    by_twist = np.swapaxes(np.swapaxes(turned, 1, 2) @ twist[:, :, :3], 1, 2)
    slopes = by_twist + t[:, None] @ rates
    return flat, slopes.reshape(*flat.shape, -1)
