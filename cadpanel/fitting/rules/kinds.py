"""At most K kinds of bends: how many tools or moulds are made decides what a facade costs.

After Eigensatz et al., Paneling architectural freeform surfaces, ACM Transactions on Graphics 29 (2010): panels are put
into kinds, and then all is solved again with those that share one held together. Here a kind is a radius: radii are
parted by dynamic programming such that the squares of their logarithms' distances from the kinds' means are least.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.bends import bends_of, require_bends
from cadpanel.fitting.rules.equal import SAME_RADIUS, Alike
from cadpanel.fitting.rules.rule import Fitted, Outcome, Posed, Rule, places_of, words_of
from cadpanel.reference.model import Reference
from cadpanel.setting import Range

# So many numbers of kinds are tried, the largest first.
_TRIED = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class KindsRule(Rule):
    """Panels whose bends have no more than so many radii.

    Attributes:
        most: kinds.
        panels: names; all panels if not given, and all of them must bend.
    """

    table: ClassVar[str] = "kinds"
    several: ClassVar[bool] = False

    most: int
    panels: tuple[str, ...] = ("*",)

    def __post_init__(self) -> None:
        """Refuse what is no number of kinds.

        Raises:
            SettingsError: saying what it may be.
        """
        if isinstance(self.most, bool):
            raise SettingsError("the most [kinds] are a number")
        Range(what="number of [kinds]", least=1, whole=True).check(self.most)
        object.__setattr__(self, "panels", words_of(self.panels, "the panels of [kinds]"))

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        names = [panel.name for panel in reference.panels]
        panels = places_of(self.panels, names, self.table)
        bends = require_bends(names, panels, features, self.table)
        if bends > 1:
            raise SettingsError(f"[kinds] are counted of panels with one bend, and '{names[panels[0]]}' has {bends}")
        return [Kinds(names, np.array(panels), self.most)]


class Kinds(Posed):
    """Panels whose bends have no more than so many radii."""

    def __init__(self, names: Sequence[str], panels: IntArray, most: int) -> None:
        self._all, self._panels, self._most = names, panels, most
        self._names = [names[i] for i in panels.tolist()]

    def groupings(self, bends: Array) -> list[tuple[Posed, ...]]:
        """Panels of one kind held alike, by what bends (panels, c, 2) came out without kinds.

        Which kinds cost least is seen when all is solved again: fewer may be better than more that are parted badly.
        """
        counts = range(self._most, max(0, self._most - _TRIED), -1)
        return [self._alike(np.log(bends[self._panels, 0, 0]), count) for count in counts]

    def _alike(self, values: Array, count: int) -> tuple[Posed, ...]:
        kinds = parted(values, count)
        members = [self._panels[kinds == kind] for kind in range(int(kinds.max()) + 1)]
        return tuple(Alike(self._all, own, 1, "radius") for own in members if len(own) > 1)

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
