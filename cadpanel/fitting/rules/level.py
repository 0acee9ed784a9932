"""Seams that are level: the rings of columns and towers, which people see against the horizon."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.panel_edges import Edge
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.boundary import boundary_of, places_in
from cadpanel.fitting.rules.rule import Fitted, Outcome, Place, Posed, Rule, seams_between, words_of
from cadpanel.reference.model import Reference
from cadpanel.setting import require
from cadpanel.terms.limits.limit import Panels
from cadpanel.terms.limits.planes import PlaneTerm
from cadpanel.terms.term import HeldTerm

UP = np.array([0.0, 0.0, 1.0])
# A drawn edge that rises by less than this share of its length is meant to be level.
_LEVEL = 0.05
_MARGIN = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelRule(Rule):
    """The seams that are level in the drawing stay so, at the heights at which they are drawn.

    Attributes:
        between: two words: seams between a panel that the first means and one that the second means; all if not given.
        within: mm from the highest to the lowest corner of seams that are drawn at one height.
    """

    table: ClassVar[str] = "level"

    between: tuple[str, ...] = ("*", "*")
    within: float = 2.0

    def __post_init__(self) -> None:
        """Refuse what names no seams, or no length.

        Raises:
            SettingsError: saying what is wanted.
        """
        object.__setattr__(self, "between", words_of(self.between, "the two panels that a [[level]] lies between"))
        require("height within which a [[level]] holds", self.within, least=1e-3, unit=" mm")

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        names = [panel.name for panel in reference.panels]
        pairs = np.array([seam.panels for seam in reference.seams], dtype=np.intp).reshape(-1, 2)
        own, where, heights = [], [], []
        for place in np.flatnonzero(seams_between(self.between, names, pairs, self.table)).tolist():
            seam = reference.seams[place]
            drawn = reference.panels[seam.panels[0]].edges[seam.edges[0]]
            length = float(np.linalg.norm(np.diff(drawn, axis=0), axis=1).sum())
            if float(np.ptp(drawn @ UP)) > _LEVEL * length:
                continue
            height = 0.5 * float((drawn @ UP).min() + (drawn @ UP).max())
            for panel, edge in zip(seam.panels, seam.edges, strict=True):
                points = _points(features[panel].edges[edge], features[panel].corner_count)
                own += [panel] * len(points)
                where += points
                heights += [height] * len(points)
        if not own:
            raise SettingsError("a [[level]] is about seams that are level in the drawing, and none of these is")
        rule = f"level seams {'|'.join(self.between)}"
        return [_Level(rule, np.array(own), np.array(where), np.array(heights), self.within)]


def _points(edge: Edge, corners: int) -> list[int]:
    """Which of a panel's own boundary points lie on an edge: corners, and behind all of them those on arcs."""
    return [*edge.corners, *(corners + arc for arc in edge.arcs)]


class _Level(Posed):
    """Boundary points at heights."""

    def __init__(self, rule: str, own: IntArray, where: IntArray, heights: Array, within: float) -> None:
        self._rule, self._own, self._where, self._heights, self._within = rule, own, where, heights, within

    def held(self, panels: Panels, pair_of: Mapping[tuple[int, int], int]) -> list[HeldTerm]:
        """See `Posed.held`."""
        del pair_of
        place = panels.place
        # The places of a panel's own points among all that stand in one row.
        found = {panel: places_in(panels.layout, panel) for panel in np.unique(self._own).tolist()}
        places = np.array([found[panel][point] for panel, point in zip(self._own, self._where, strict=True)])
        # In a panel's own frame: which way is up, and how high over its origin the seam is drawn.
        up = UP @ place.axes[self._own]
        heights = (self._heights - (place.origins[self._own] + place.centre) @ UP) / place.length
        within = np.full(len(places), 0.5 * (1.0 - _MARGIN) * self._within / place.length)
        return [PlaneTerm(self._own, places, up, heights, within, panels.layout.panels, gives_way=True)]

    def places(self) -> list[Place]:
        """See `Posed.places`: where in x and y does not matter."""
        within = (math.inf, math.inf, 0.5 * self._within)
        points = zip(self._own.tolist(), self._where.tolist(), self._heights.tolist(), strict=True)
        return [Place(self._rule, panel, point, (0.0, 0.0, height), within) for panel, point, height in points]

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`: twice the largest distance from a height."""
        off = np.zeros(len(self._own))
        for panel in np.unique(self._own).tolist():
            mine = self._own == panel
            off[mine] = np.abs(boundary_of(fitted.shapes[panel])[self._where[mine]] @ UP - self._heights[mine])
        return Outcome(
            rule=self._rule,
            measure="from the highest to the lowest",
            found=2.0 * float(off.max()),
            allowed=self._within,
        )
