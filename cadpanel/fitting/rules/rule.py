"""What a rule is: a table of a rules file, what it holds of the panels that it names, and what comes of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Protocol, Self

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference
from cadpanel.reference.named import meant_by, near_names
from cadpanel.terms.limits.limit import Panels
from cadpanel.terms.term import HeldTerm

NO_LINKS: IntArray = np.empty((0, 2), dtype=np.intp)


class Fitted(Protocol):
    """What a rule sees of panels that are measured; `fitting.measures.fit.Measures` is such a thing."""

    @property
    def shapes(self) -> Sequence[Panel]:
        """The panels, mm."""
        ...

    @property
    def gaps(self) -> dict[str, Array]:
        """(seams,) each of what can be held of gaps, mm."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What was measured of a rule.

    Attributes:
        rule: the rule in a few words, with the names of what it is about.
        measure: what was measured, "spread of radii".
        found: the number.
        allowed: what it may be at most.
        unit: "mm" or "degrees", or "" of what is counted.
        values: the numbers of single panels behind it, by their names.
    """

    rule: str
    measure: str
    found: float
    allowed: float
    unit: str = "mm"
    values: Mapping[str, float] = field(default_factory=dict)

    @property
    def kept(self) -> bool:
        """Whether the rule holds."""
        return self.found <= self.allowed


@dataclass(frozen=True, slots=True)
class Bends:
    """Radii and half angles of the curved patches of all panels, at most c a panel.

    Attributes:
        values: (panels, c, 2) radius in mm, positive whichever way a patch bends, and half angle in radians, positive
            where it widens from end 0 to end 1; nan where a panel has fewer.
        held: (panels, c, 2) which of them are to be fixed at these values.
        frozen: (panels,) panels that are made already, whose bends nothing changes.
    """

    values: Array
    held: BoolArray
    frozen: BoolArray

    def same(self, other: Bends) -> bool:
        """Whether the same of them are to be fixed at the same values."""
        return bool(np.array_equal(self.held, other.held) and (self.values == other.values)[self.held].all())


@dataclass(frozen=True, slots=True)
class Place:
    """Where a rule wants a point of a panel's boundary.

    Attributes:
        rule: in a few words.
        panel: which.
        point: its place among the panel's own, see `boundary.boundary_of`.
        at: where, mm.
        within: how far from there in x, y and z; infinite where it does not matter.
    """

    rule: str
    panel: int
    point: int
    at: tuple[float, float, float]
    within: tuple[float, float, float]


class Posed(ABC):
    """A rule for the panels of one reference.

    Attributes:
        links: (n, 2) panels that it couples, the lower first.
        frozen: panels that are made already.
        choices: how many ways it knows to fix radii, the likeliest first.
    """

    links: IntArray = NO_LINKS
    frozen: tuple[int, ...] = ()
    choices: int = 1

    def held(self, panels: Panels, pair_of: Mapping[tuple[int, int], int]) -> list[HeldTerm]:
        """The terms that hold it while all panels are fitted; they may give way, as gaps do.

        Args:
            panels: who.
            pair_of: which pair of coupled panels two of them are.
        """
        del panels, pair_of
        return []

    def places(self) -> list[Place]:
        """Where it wants points of panels to be."""
        return []

    def settled(self, bends: Bends, choice: int) -> Bends:
        """What it makes of the radii and half angles that were found."""
        del choice
        return bends

    def groupings(self, bends: Array) -> list[tuple[Posed, ...]]:
        """What panels may be held to besides, by the bends (panels, c, 2) that came out without it: the best counts."""
        del bends
        return []

    @abstractmethod
    def outcome(self, fitted: Fitted) -> Outcome:
        """What came of it."""


class Rule(ABC):
    """One rule, a frozen dataclass: its fields are the keys of its table.

    Attributes:
        table: the heading of the rules file.
        several: whether a file may have several of them, [[table]], or only one, [table].
        of_fit: whether it needs a fit of all panels at once that holds tolerances.
    """

    table: ClassVar[str]
    several: ClassVar[bool] = True
    of_fit: ClassVar[bool] = True

    @classmethod
    def parse(cls, given: Mapping[str, Any]) -> Self:
        """The rule of a table.

        Raises:
            SettingsError: a key is none of its keys, or is missing, or the rule refuses a value.
        """
        known = [one.name for one in fields(cls)]  # type: ignore[arg-type] # every rule is a dataclass
        for key in given:
            if key not in known:
                near = near_names(key, known, 1)[0]
                raise SettingsError(f"the rule [{cls.table}] has no '{key}'; it has '{near}', for example")
        try:
            return cls(**given)
        except TypeError:
            wanted = ", ".join(f"'{name}'" for name in known)
            raise SettingsError(f"the rule [{cls.table}] lacks something: it can have {wanted}") from None

    def plain(self) -> dict[str, Any]:
        """Its table; what is left at its default is left out."""
        found: dict[str, Any] = {}
        for one in fields(self):  # type: ignore[arg-type]
            value = getattr(self, one.name)
            if value != one.default:
                found[one.name] = value
        return found

    def check(self, allowed: Mapping[str, float]) -> None:
        """Refuse what contradicts the limits, by their names, mm or shares: no search would find it.

        Raises:
            SettingsError: saying which limit is in the way.
        """
        del allowed

    def features(self, names: Sequence[str]) -> dict[int, str]:
        """The features that it gives to single panels, by their places."""
        del names
        return {}

    def gaps(self, names: Sequence[str], seam_panels: IntArray) -> dict[str, Array]:
        """(seams,) what it allows of gaps and their parts, mm; nan where it says nothing."""
        del names, seam_panels
        return {}

    def joints(self, names: Sequence[str], seam_panels: IntArray) -> dict[int, float]:
        """Clear widths that it gives to the joints of single seams, by their places, mm."""
        del names, seam_panels
        return {}

    @abstractmethod
    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """The rule for these panels with these features, once for everything that is measured of it.

        Raises:
            SettingsError: it names what is not there, or what it asks has no meaning for these panels.
        """


def words_of(value: object, what: str) -> tuple[str, ...]:
    """Names from what a table has: one, or a list.

    Raises:
        SettingsError: there is none, or one is no text.
    """
    given = (value,) if isinstance(value, str) else tuple(value) if isinstance(value, list | tuple) else ()
    if not given or not all(isinstance(one, str) and one for one in given):
        raise SettingsError(f"{what} are names like 'NW-03' or 'NW-*', not {value!r:.80}")
    return given


def places_of(words: Sequence[str], names: Sequence[str], rule: str) -> list[int]:
    """Indices of the panels that words mean, in the order of the panels.

    Raises:
        SettingsError: a word means none.
    """
    found: set[str] = set()
    for word in words:
        meant = meant_by(word, names)
        if not meant:
            near = " or ".join(f"'{name}'" for name in near_names(word, names))
            raise SettingsError(f"the rule [{rule}] names the panel '{word}', which is not there; did you mean {near}")
        found |= set(meant)
    return [place for place, name in enumerate(names) if name in found]


def seams_between(words: Sequence[str], names: Sequence[str], seam_panels: IntArray, rule: str) -> BoolArray:
    """(seams,) which seams lie between a panel that the first of two words means and one that the second means.

    Raises:
        SettingsError: a word means no panel, or no two such panels meet.
    """
    first, second = (np.isin(seam_panels, places_of([word], names, rule)) for word in words)
    own: BoolArray = (first[:, 0] & second[:, 1]) | (first[:, 1] & second[:, 0])
    if not own.any():
        beside = np.unique(seam_panels[first.any(axis=1)])
        near = ", ".join(f"'{names[i]}'" for i in beside[:3].tolist()) or "no other panel"
        raise SettingsError(
            f"the rule [{rule}] names the seam between '{words[0]}' and '{words[1]}', which do not meet; on seams of "
            f"'{words[0]}' there are {near}"
        )
    return own


def called(names: Sequence[str]) -> str:
    """A few names in a row."""
    shown = list(names) if len(names) <= 3 else [names[0], names[1], "...", names[-1]]
    return ", ".join(shown)
