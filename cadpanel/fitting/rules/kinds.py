"""At most K kinds of bends: how many moulds or settings of the rollers are made decides what a facade costs.

After Eigensatz et al., Paneling architectural freeform surfaces, ACM Transactions on Graphics 29 (2010): panels are put
into kinds, and then all is solved again with those that share one held together. A kind is what a mould or a setting
is: the cone that a bend is a part of, told by the radius halfway between its ends and the half angle, from which the
radii at both ends follow; which end is the wider one does not matter, as the panel is turned about. Kinds are parted by
Ward's method, such that the squares of the distances of the radii at both ends from the kinds' means stay small. Where
a kind is only a radius, dynamic programming finds the best of all partitions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.bends import NUMBERS, bends_of, numbers_of, require_bends
from cadpanel.fitting.rules.equal import SAME_ANGLE, SAME_RADIUS, Alike
from cadpanel.fitting.rules.rule import Fitted, Outcome, Posed, Rule, places_of, words_of
from cadpanel.reference.model import Reference
from cadpanel.setting import Range

# So many numbers of kinds are tried, the largest first.
_TRIED = 3
# Half angles that are nearer to a cylinder, radians, count as widening to the same side as all.
_STRAIGHT = 1e-4
# What is parted is told to so many digits: rounding must not part kinds otherwise on another processor.
_DIGITS = 7
OF = ("bends", "radii")
"""What kinds may be of."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KindsRule(Rule):
    """Panels whose bends are of no more than so many kinds.

    Attributes:
        most: kinds.
        panels: names; all panels if not given, and all of them must bend.
        of: "bends": a kind is a radius with a half angle, what a mould is made for and rollers are set to; "radii": a
            kind is a radius alone, as with a press that follows any half angle.
    """

    table: ClassVar[str] = "kinds"
    several: ClassVar[bool] = False

    most: int
    panels: tuple[str, ...] = ("*",)
    of: str = "bends"

    def __post_init__(self) -> None:
        """Refuse what is no number of kinds.

        Raises:
            SettingsError: saying what it may be.
        """
        if isinstance(self.most, bool):
            raise SettingsError("the most [kinds] are a number")
        Range(what="number of [kinds]", least=1, whole=True).check(self.most)
        if self.of not in OF:
            raise SettingsError(f"[kinds] are of '{OF[0]}' or of '{OF[1]}', not of {self.of!r:.80}")
        object.__setattr__(self, "panels", words_of(self.panels, "the panels of [kinds]"))

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        names = [panel.name for panel in reference.panels]
        panels = places_of(self.panels, names, self.table)
        bends = require_bends(names, panels, features, self.table)
        if bends > 1:
            raise SettingsError(f"[kinds] are counted of panels with one bend, and '{names[panels[0]]}' has {bends}")
        if self.of == OF[1]:
            return [KindsOfRadii(names, np.array(panels), self.most)]
        length = float(np.mean([reference.panels[panel].length for panel in panels]))
        tapered = np.array([numbers_of(features[panel], NUMBERS[1]) != [None] for panel in panels])
        return [KindsOfBends(names, np.array(panels), self.most, length, tapered)]


class _Kinds(Posed):
    """Panels of a few kinds."""

    def __init__(self, names: Sequence[str], panels: IntArray, most: int) -> None:
        self._all, self._panels, self._most = names, panels, most
        self._names = [names[i] for i in panels.tolist()]

    def _counts(self) -> range:
        """The numbers of kinds that are tried."""
        return range(self._most, max(0, self._most - _TRIED), -1)

    def _members(self, kinds: IntArray) -> list[IntArray]:
        """The places, among all that are parted, of the panels of each kind that has several."""
        own = [np.flatnonzero(kinds == kind) for kind in range(int(kinds.max()) + 1)]
        return [places for places in own if len(places) > 1]


class KindsOfRadii(_Kinds):
    """Panels whose bends have no more than so many radii."""

    def groupings(self, bends: Array) -> list[tuple[Posed, ...]]:
        """Panels of one kind held alike, by what bends (panels, c, 2) came out without kinds.

        Which kinds cost least is seen when all is solved again: fewer may be better than more that are parted badly.
        """
        parts = [parted(np.log(bends[self._panels, 0, 0]), count) for count in self._counts()]
        return [
            tuple(Alike(self._all, self._panels[own], 1, NUMBERS[0]) for own in self._members(kinds)) for kinds in parts
        ]

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        radii = bends_of([fitted.shapes[i] for i in self._panels])[:, 0, 0]
        return Outcome(
            rule=f"at most {self._most} radii",
            measure="different radii",
            found=float(1 + np.sum(np.diff(np.sort(radii)) > SAME_RADIUS)),
            allowed=float(self._most),
            unit="",
            values=dict(zip(self._names, radii.tolist(), strict=True)),
        )


class KindsOfBends(_Kinds):
    """Panels whose bends are parts of no more than so many cones."""

    def __init__(self, names: Sequence[str], panels: IntArray, most: int, length: float, tapered: Array) -> None:
        """Besides: the panels' mean length, mm, and which of them have half angles (n,); others are cylinders."""
        super().__init__(names, panels, most)
        self._length, self._tapered = length, tapered

    def groupings(self, bends: Array) -> list[tuple[Posed, ...]]:
        """See `KindsOfRadii.groupings`; panels of a kind have one half angle, too, to either side."""
        own = bends[self._panels, 0]
        side = np.where(own[:, 1] < -_STRAIGHT, -1.0, 1.0)
        # Two numbers tell the cone: its radius in the middle, and by which share it is wider at the end of a panel.
        wider = 0.5 * self._length * np.tan(np.abs(own[:, 1])) / own[:, 0]
        told = np.stack([np.log(own[:, 0]), wider], axis=1)
        return [self._alike(nearest_kinds(told, count), side) for count in self._counts()]

    def _alike(self, kinds: IntArray, side: Array) -> tuple[Posed, ...]:
        found: list[Posed] = []
        for own in self._members(kinds):
            found.append(Alike(self._all, self._panels[own], 1, NUMBERS[0]))
            if self._tapered[own].any():
                found.append(Alike(self._all, self._panels[own], 1, NUMBERS[1], side[own]))
        return tuple(found)

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        found = bends_of([fitted.shapes[i] for i in self._panels])[:, 0]
        radii, angles = found[:, 0], np.degrees(np.abs(found[:, 1]))
        same = (np.abs(radii[:, None] - radii) <= SAME_RADIUS) & (np.abs(angles[:, None] - angles) <= SAME_ANGLE)
        return Outcome(
            rule=f"at most {self._most} kinds of bends",
            measure="different radii with their half angles",
            found=float(np.sum(same.argmax(axis=1) == np.arange(len(same)))),
            allowed=float(self._most),
            unit="",
            values=dict(zip(self._names, radii.tolist(), strict=True)),
        )


def nearest_kinds(values: Array, most: int) -> IntArray:
    """(n,) a kind for each of n points (n, d), no more than `most`, by Ward's method."""
    # Here, not above: help and refusals should not wait for scipy.
    from scipy.cluster.hierarchy import fcluster, linkage

    if len(values) == 1:
        return np.zeros(1, dtype=np.intp)
    joined = linkage(np.round(values - values.mean(axis=0), _DIGITS), method="ward")
    return np.asarray(fcluster(joined, most, criterion="maxclust") - 1, dtype=np.intp)


def parted(values: Array, most: int) -> IntArray:
    """(n,) a kind for each of n values, no more than `most`: kinds are stretches of the sorted values.

    The sum of squared distances from the kinds' means is the least that there is.
    """
    order = np.argsort(values, kind="stable")
    sorted_, count = values[order] - values.mean(), len(values)
    sums, squares = (np.concatenate([[0.0], np.cumsum(sorted_**power)]) for power in (1, 2))
    first, last = np.meshgrid(np.arange(count), np.arange(1, count + 1), indexing="ij")
    length = np.maximum(last - first, 1)
    cost = np.where(last > first, squares[last] - squares[first] - (sums[last] - sums[first]) ** 2 / length, np.inf)
    best, begins = np.where(np.arange(count + 1) > 0, np.inf, 0.0), []
    for _ in range(min(most, count)):
        trial = best[:-1, None] + cost
        begins.append(trial.argmin(axis=0))
        best = np.concatenate([[np.inf], trial.min(axis=0)])
    kinds, end = np.zeros(count, dtype=np.intp), count
    for kind, begin in reversed(list(enumerate(begins))):
        start = int(begin[end - 1])
        kinds[order[start:end]] = kind
        end = start
    return kinds
