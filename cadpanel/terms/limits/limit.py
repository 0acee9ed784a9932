"""What a limit is: a setting, the terms that hold panels to it, the measure that tells whether they keep it, its rows.

Everything that goes through all limits (checks of settings, bounds, the methods, verdict and advice, report and tables,
the command line) asks the limits of the catalogue and names none of them.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.layout import Layout
from cadpanel.features.rulings import PanelFeature
from cadpanel.geometry.panel import Panel
from cadpanel.reference.across_seams import AcrossSeams
from cadpanel.setting import Option, Range, setting
from cadpanel.terms.outline import Outline
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import SeamBatch
from cadpanel.terms.term import HeldTerm


class Panels(Protocol):
    """What a limit sees of the panels that it holds; `fitting.problem.Problem` is such a thing."""

    @property
    def layout(self) -> Layout:
        """Which panels have which feature."""
        ...

    @property
    def place(self) -> Placement:
        """The panels' own frames, and the solver's unit of length in mm."""
        ...

    @property
    def outline(self) -> Outline:
        """The reference's corners."""
        ...

    @property
    def lengths(self) -> Array:
        """(panels,) the panels' lengths in units of the solver's length."""
        ...

    @property
    def seams(self) -> tuple[SeamBatch, ...]:
        """Who meets whom, in batches of seams that are alike."""
        ...

    @property
    def across(self) -> AcrossSeams:
        """The lines that go on across seams."""
        ...

    @property
    def pair_of(self) -> IntArray:
        """(seams,) which pair of coupled panels meets there."""
        ...


class Shapes(Protocol):
    """What a limit sees that hangs on the panels alone."""

    @property
    def shapes(self) -> Sequence[Panel]:
        """The panels themselves, mm."""
        ...


class Measured(Shapes, Protocol):
    """What a limit sees of panels that are measured; `fitting.measures.fit.Measures` is such a thing."""

    @property
    def lengths(self) -> Array:
        """(panels,) the panels' lengths, mm."""
        ...

    @property
    def turn(self) -> Array:
        """(panels,) of the edge that turns most from the drawn one, radians."""
        ...

    @property
    def seam_panels(self) -> IntArray:
        """(seams, 2) which panels meet there."""
        ...

    @property
    def uneven(self) -> Array:
        """(seams,) how far a seam's corners lie off the middle between those before and after them, mm."""
        ...

    @property
    def kink(self) -> Array:
        """(seams,) radians."""
        ...

    @property
    def drift_along(self) -> Array:
        """(panels,) of the corner that drifted most along the strip, mm."""
        ...

    @property
    def drift_across(self) -> Array:
        """(panels,) of the outer corner that drifted most across its free edge, mm."""
        ...

    @property
    def outline_drift(self) -> Array:
        """(panels,) of the place on a free edge that is farthest from the drawn outline, mm."""
        ...


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the tables that are printed.

    Attributes:
        key: under which the report's summary has the number.
        heading: of the row.
        form: how the number is written, for `str.format`.
        meaning: what it is, in a fabricator's words and so few that they stand on the row.
    """

    key: str
    heading: str
    form: str
    meaning: str = ""


class Limit(ABC):
    """One limit; a kind of limit is one subclass and one file.

    Attributes:
        name: of the setting, as `FitSettings`, report and command line call it.
        what: the setting in messages, "least radius".
        default: in mm or degrees, or as a share of the panel's length.
        least, most: what may be asked for.
        percent: whether it is a share of the panel's length, which people read in percent.
        unit: of what is no share, "mm" or "degrees".
        help: of the command line's option.
        asked: whether it is a setting at all, or always the default.
        at_least: whether the measure must not fall below the limit; else it must not exceed it.
        yields: whether it gives way where what panels must keep to cannot be kept with it.
        remedy: what to allow where it cannot be kept, "more drift".
        rows: of report and tables; the last is what the limit holds, its worst over all panels.
        weight: which of the paper's weights rules its terms where weights are given instead of a tolerance.
    """

    name: str
    what: str
    default: float
    least: float = 0.0
    most: float = math.inf
    percent: bool = False
    unit: str = "mm"
    help: str = ""
    asked: bool = True
    at_least: bool = False
    yields: bool = False
    remedy: str
    rows: tuple[Row, ...]
    weight: str | None = None

    @abstractmethod
    def held(self, panels: Panels, allowed: Mapping[str, float], margin: float) -> list[HeldTerm]:
        """The terms that hold panels to it.

        Args:
            panels: who.
            allowed: all limits by their names, mm or shares.
            margin: relative, by how much to stay inside it.
        """

    @abstractmethod
    def measure(self, measured: Measured) -> Array:
        """(panels,) what is held against it, mm or shares; infinite where a least one has nothing to hold."""

    @abstractmethod
    def missed(self, panel: str, value: float, allowed: float, length: float) -> str:
        """What to say of a panel that does not keep it, in words that another sentence can go on from.

        Args:
            panel: its name.
            value: what was measured, mm or a share.
            allowed: mm or a share.
            length: of the panel, mm.
        """

    def bound(self, dimension: str) -> float | None:
        """The least value in mm that the fit may give to what patches measure ("width"), None where it has no say."""
        del dimension
        return None

    def check_feature(self, feature: PanelFeature, allowed: float) -> None:
        """Refuse a composed feature that cannot keep it.

        Raises:
            SettingsError: saying which of its numbers is in the way.
        """
        del feature, allowed

    def allowed(self, settings: object) -> float:
        """What settings allow, mm or a share."""
        return float(getattr(settings, self.name)) if self.asked else self.default

    def kept(self, measured: Measured, allowed: float) -> BoolArray:
        """(panels,) which panels keep it."""
        found = self.measure(measured)
        return np.asarray(found >= allowed if self.at_least else found <= allowed)

    def excess(self, measured: Measured, allowed: float) -> Array:
        """(panels,) by how much it is used up: 1 where it is just kept."""
        share = self.measure(measured) / allowed
        return np.asarray(2.0 - share if self.at_least else share)

    def worst(self, measured: Measured) -> float | None:
        """The worst of all panels as reports state it, in mm or percent; None where there is nothing to limit."""
        found = self.measure(measured)
        worst = float(found.min() if self.at_least else found.max())
        return self.stated(worst) if math.isfinite(worst) else None

    def stated(self, value: float) -> float:
        """A value as people read it, in mm or percent."""
        return 100.0 * value if self.percent else value


def of_both_panels(measured: Measured, seams: Array) -> Array:
    """(panels,) the largest of what the seams of a panel have (seams,): it counts for both panels that meet there."""
    found = np.zeros(len(measured.lengths))
    for side in (0, 1):
        np.maximum.at(found, measured.seam_panels[:, side], seams)
    return found


def limit_setting(limit: type[Limit]) -> float:
    """The field of `FitSettings` that asks for a limit."""
    what = Range(what=limit.what, least=limit.least, most=limit.most, unit="" if limit.percent else f" {limit.unit}")
    if not limit.percent:
        return setting(limit.default, within=what, option=Option(metavar=limit.unit.upper(), help=limit.help))
    return setting(
        limit.default,
        within=what,
        option=Option(
            metavar="PERCENT",
            help=limit.help,
            read=lambda option, percent: _share(option, percent, limit),
            show=lambda share: float(f"{100.0 * share:.12g}"),  # 7, not 7.000000000000001
        ),
    )


def _share(option: str, percent: float, limit: type[Limit]) -> float:
    least, most = 100.0 * limit.least, 100.0 * limit.most
    if not least <= percent <= most:
        raise SettingsError(
            f"{option} must be between {least:g} and {most:g} percent of the panel's length, not {percent:g}."
        )
    return percent / 100.0
