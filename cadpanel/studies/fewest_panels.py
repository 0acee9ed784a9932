"""The fewest panels along each strip that hold everything: gaps, limits and the largest deviation.

First every panel is fitted alone, which is quick: what is too far off by itself will not come nearer for having to meet
its neighbours. The deviation of a panel falls with the square of its length, which tells where to look; from the first
number that will do alone, all panels are fitted at once with more and more of them until everything is held, and the
last step is halved down. A larger number need not hold what a smaller one does, as shorter panels may move less: what
lies between two numbers that were tried is not known, and all that were tried are told.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.errors import PanelError, ReferenceFileError, SettingsError
from cadpanel.fitting.measures.verdict import limits_of
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.studies.prepared import Prepare, unprepared

TOO_LARGE = "a blank fits no sheet"
MOST = 200
"""Panels along a strip at most, where nothing else is said."""
# The number that is tried first, fits of every panel alone at most, and of all panels at once.
FIRST, MOST_ALONE, MOST_FITS = 6, 12, 14
# By which factor the number grows at most, and where the deviation does not tell how much.
FASTEST, SLOWEST = 1.6, 1.25

Progress = Callable[[int, int, float, float], bool | None]
"""Told the number of panels, the step (0 where a fit begins), the largest excess over a tolerance and the RMS deviation
in mm; where it returns False, the search ends with the best so far."""
Admitted = Callable[[FitResult], bool]
"""Whether panels that hold everything will do besides, as their blanks fit the sheets of the store."""


def _any(_result: FitResult) -> bool:
    return True


@dataclass(frozen=True, slots=True, kw_only=True)
class Tried:
    """What came of one number of panels along each strip.

    Attributes:
        count: the number.
        held: whether everything was held.
        max_deviation: largest deviation, mm; None where no fit was possible.
        gap: the widest, at corners or along seams, mm; None with it.
        missed: what is not held, or why there is no fit; empty where all is held.
    """

    count: int
    held: bool
    max_deviation: float | None
    gap: float | None
    missed: str

    def __str__(self) -> str:
        """As a list of what was tried names it."""
        if self.max_deviation is None or self.gap is None:
            return f"{self.count} (no fit)"
        word = "held" if self.held else TOO_LARGE if self.missed == TOO_LARGE else "not held"
        return f"{self.count} ({word}: {self.max_deviation:.3g} mm off at most, gaps up to {self.gap:.3g} mm)"


@dataclass(frozen=True, slots=True, kw_only=True)
class Fewest:
    """What the search found.

    Attributes:
        result: the fit with the fewest panels that holds everything; where none does, that which misses least.
        tried: every number for which all panels were fitted at once, in the order in which they were.
        least: the number from which every panel alone is near enough.
        most: the number up to which was looked.
    """

    result: FitResult
    tried: tuple[Tried, ...]
    least: int
    most: int

    @property
    def held(self) -> bool:
        """Whether everything is held."""
        return self.result.tolerance_met

    def note(self) -> str:
        """What was tried, in one sentence."""
        return (
            "The number of panels along each strip was found by fits: each alone, they are near enough from "
            f"{self.least} on; tried together: {', '.join(map(str, self.tried))}."
        )

    def shortfall(self) -> str | None:
        """None where everything is held, else one sentence with the numbers."""
        missed = self.result.shortfall()
        if missed is None:
            return None
        counts = ", ".join(str(one.count) for one in self.tried)
        return (
            f"no number of panels along each strip from {self.least} to {self.most} was found to hold everything "
            f"(tried: {counts}); with {_count(self.result)}, the best of them, {missed}"
        )


def fewest_panels(
    read: Callable[[int], Reference],
    settings: FitSettings,
    *,
    most: int = MOST,
    progress: Progress | None = None,
    time_limit: float | None = None,
    prepare: Prepare = unprepared,
    admitted: Admitted = _any,
) -> Fewest:
    """Find the fewest panels along each strip that hold everything that is asked.

    Args:
        read: the reference cut into so many panels along each strip.
        settings: with a largest deviation.
        most: panels along a strip.
        progress: told of every step.
        time_limit: seconds after which the search ends with the best so far.
        prepare: see `Prepare`.
        admitted: what else is asked of a result that holds everything; its panels are taken to be too large if not.

    Raises:
        PanelError: what is asked besides cannot be told of panels that hold everything.
        ReferenceFileError: the reference cannot be cut along strips at all.
        PanelError: no number of panels could be fitted.
        SettingsError: no largest deviation is given, or weights instead of a tolerance.
    """
    if settings.max_deviation is None:
        raise SettingsError("the number of panels is chosen by a largest deviation: give one, too")
    if settings.weights is not None:
        raise SettingsError("the number of panels is chosen by what is held, and weights hold nothing: leave them out")
    search = _Search(read, settings, most, progress, time_limit, prepare, admitted)
    least = search.least_alone()
    search.run(least)
    if search.best is None:
        assert search.refused is not None
        raise search.refused
    found = Fewest(result=search.best, tried=tuple(search.tried.values()), least=least, most=most)
    reference = search.best.reference
    noted = replace(reference, notes=(*reference.notes, found.note()))
    baselines = search.best.baselines.told_of(noted)
    return replace(found, result=replace(search.best, reference=noted, baselines=baselines))


class _Search:
    """What is known so far.

    Attributes:
        tried: by number.
        best: the fewest that holds, or what misses least.
        most: the number up to which is looked.
        refused: why a number could not be fitted, the last time.
    """

    def __init__(
        self,
        read: Callable[[int], Reference],
        settings: FitSettings,
        most: int,
        progress: Progress | None,
        time_limit: float | None,
        prepare: Prepare,
        admitted: Admitted,
    ) -> None:
        self._prepare, self._admitted = prepare, admitted
        self._rank: tuple[bool, float] | None = None
        self.tried: dict[int, Tried] = {}
        self.best: FitResult | None = None
        self.most = most
        self.refused: PanelError | ReferenceFileError | SettingsError | None = None
        self._read, self._settings, self._progress = read, settings, progress
        self._until = None if time_limit is None else time.perf_counter() + time_limit
        self._told = False
        self._references: dict[int, Reference | None] = {}

    @property
    def _over(self) -> bool:
        return self._told or (self._until is not None and time.perf_counter() > self._until)

    def least_alone(self) -> int:
        """The least number with which every panel alone is near enough, as far as that can be told; at most `most`."""
        allowed = self._settings.max_deviation or np.inf
        low, high, count = 0, self.most + 1, min(FIRST, self.most)
        for _ in range(MOST_ALONE):
            far = self._alone(count) / allowed
            low, high = (count, high) if far > 1.0 else (low, count)
            if high - low <= 1 or self._over:
                break
            # Near by as the square of the length tells, between what is known.
            guess = math.ceil(count * math.sqrt(min(far, 16.0)))
            if low > 0 and high <= self.most:
                guess = min(max(guess, (3 * low + high) // 4), (low + 3 * high) // 4)
            count = min(max(guess, low + 1), high - 1)
        return min(high, self.most)

    def run(self, least: int) -> None:
        """Fit all panels at once with more and more of them, and go back to the fewest that hold."""
        low, count = least - 1, least
        while not self._done() and not self._fits(count):
            low = count
            if count >= self.most:
                return
            count = min(max(count + 1, math.floor(count * self._growth(count))), self.most)
        high = count
        while high - low > 1 and not self._done():
            middle = (low + high) // 2
            low, high = (low, middle) if self._fits(middle) else (middle, high)

    def _done(self) -> bool:
        return bool(self.tried) and (self._over or len(self.tried) >= MOST_FITS)

    def _growth(self, count: int) -> float:
        found, allowed = self.tried[count].max_deviation, self._settings.max_deviation
        if found is None or allowed is None or found <= allowed:
            return SLOWEST
        return min(math.sqrt(found / allowed), FASTEST)

    def _alone(self, count: int) -> float:
        """The largest deviation of every panel alone, mm; infinite where there is no fit."""
        reference = self._reference(count)
        if reference is None:
            return np.inf
        try:
            alone = fit(reference, self._settings.alone())
        except (PanelError, SettingsError) as error:
            self.refused = error
            return np.inf
        return float(alone.measures.max_deviation.max())

    def _fits(self, count: int) -> bool:
        """Fit so many panels at once, and whether everything is held."""
        reference = self._reference(count)
        result = None if reference is None else self._together(reference, count)
        if result is None:
            self.tried[count] = Tried(
                count=count, held=False, max_deviation=None, gap=None, missed=str(self.refused or "")
            )
            return False
        measures = result.measures
        held = result.tolerance_met and self._admitted(result)
        self.tried[count] = Tried(
            count=count,
            held=held,
            max_deviation=float(measures.max_deviation.max()),
            gap=max(measures.max_corner_gap, measures.max_seam_gap),
            missed=result.shortfall() or ("" if held else TOO_LARGE),
        )
        rank = _misses(result, held=held)
        if self._rank is None or rank < self._rank:
            self.best, self._rank = result, rank
        return held

    def _together(self, reference: Reference, count: int) -> FitResult | None:
        def tell(_method: str, step: int, excess: float, rms: float) -> bool:
            if self._progress is not None:
                answer = self._progress(count, step, excess, rms)
                self._told |= answer is not None and not answer
            return not self._told

        tell("", 0, 0.0, 0.0)
        left = None if self._until is None else max(self._until - time.perf_counter(), 1e-3)
        try:
            return fit(reference, self._prepare(self._settings, reference), tell, time_limit=left)
        except (PanelError, SettingsError) as error:  # a rule may name panels that only other numbers have
            self.refused = error
            return None

    def _reference(self, count: int) -> Reference | None:
        """The reference in so many panels; None where it cannot be cut into them, but could be into others."""
        if count not in self._references:
            try:
                self._references[count] = self._read(count)
            except (PanelError, ReferenceFileError, SettingsError) as error:
                if not self._references:
                    raise
                self.refused = error
                self._references[count] = None
        return self._references[count]


def _misses(result: FitResult, *, held: bool) -> tuple[bool, float]:
    """By what a result is ranked: one that holds by its number of panels, another by the most that it exceeds."""
    if held:
        return False, float(len(result.shapes))
    if result.tolerance_met:  # only too large for the store's sheets: the smaller, the better
        return True, 1.0 / len(result.shapes)
    measures, how = result.measures, result.settings
    shares = [float(limit.excess(measures, allowed).max()) for limit, allowed in limits_of(how)]
    gaps = measures.gaps
    shares += [float(gaps[what].max(initial=0.0)) / most for what, most in how.gaps.items()]
    shares.append(float(measures.max_deviation.max()) / (how.max_deviation or np.inf))
    return True, max(shares)


def _count(result: FitResult) -> int:
    divide = result.reference.settings.divide
    return divide if isinstance(divide, int) else len(result.shapes)
