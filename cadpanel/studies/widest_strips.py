"""Panels along a strip one after the other, each as wide as the largest deviation allows.

From the last seam the next one is looked for as far away as the panel between them, fitted alone, stays within the
bound: the largest distance of the drawing's samples and outline from it. That distance grows nearly with the square of
the width, which tells where to look; widths that were tried hold the true one between them, and the last that was near
enough is taken. (The paper's [9] marches so over a surface with ruled strips; here seams are planes across the strip,
and panels the features that are asked for.)

Panels that have to meet are farther off than each alone. Where they then miss the bound or a limit, the march is done
again with a tighter bound for panels alone; and where that was much tighter than it need be, with one in between.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

from cadpanel.errors import CadpanelError, PanelError, ReferenceFileError, SettingsError
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.polyline import arc_length
from cadpanel.reference.model import PanelReference, Reference
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.studies.prepared import Prepare, unprepared

MOST_STRIPS = 200
"""Panels along the strip at most."""
# A width is found where its deviation is within this share of the bound, or it is known to this share.
_NEAR, _KNOWN = 0.03, 0.01
# Widths tried for a panel, bounds tried for all together, and the first width tried, as a share of the strip.
_TRIES, _ROUNDS, _FIRST = 12, 5, 0.2
# What is tried is this far inside of what is known to be too wide, and of a bound that was missed together.
_INSIDE, _TIGHTER = 0.95, 0.9
# Where it is not the deviation that is missed, or panels cannot be fitted together at all, the next bound is this part.
_MUCH_TIGHTER = 0.5
# Between a bound that held and one so many times as wide that did not, another is tried.
_WORTH = 1.25
# No panel is narrower than this share of the strip.
_LEAST = 1e-3

Cuts = tuple[float, ...]
Progress = Callable[[int, float], bool | None]
"""Told how many seams are found and where the last one lies, mm; where it returns False, the search ends with the best
so far."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Widest:
    """What the march found.

    Attributes:
        result: the fit of all panels at once.
        stations: lengths along the strip at which it is cut, mm.
        length: of the strip, mm.
        bound: the largest deviation that panels alone were allowed, mm.
    """

    result: FitResult
    stations: Cuts
    length: float
    bound: float

    @property
    def widths(self) -> tuple[float, ...]:
        """Of the panels along the strip, mm."""
        return tuple(after - before for before, after in pairwise((0.0, *self.stations, self.length)))

    def note(self) -> str:
        """What was found, in one sentence."""
        return (
            f"Panels are as wide as {self.bound:.3g} mm of deviation allow each alone: "
            f"{', '.join(f'{width:.0f}' for width in self.widths)} mm along the strip."
        )


def widest_strips(
    read: Callable[[Cuts], Reference],
    settings: FitSettings,
    *,
    progress: Progress | None = None,
    time_limit: float | None = None,
    prepare: Prepare = unprepared,
) -> Widest:
    """Cut a strip into panels as wide as a largest deviation allows, and fit them all at once.

    Args:
        read: the reference cut at such lengths along the strip, mm; whole where there are none.
        settings: with a largest deviation.
        progress: told of every seam that is found.
        time_limit: seconds after which no other bound is tried.
        prepare: see `Prepare`.

    Raises:
        ReferenceFileError: the reference cannot be cut along a strip.
        SettingsError: no largest deviation is given, there is more than one strip, no panel however narrow will do, or
            panels as wide as that cannot be fitted together.
    """
    if settings.max_deviation is None:
        raise SettingsError("strips are as wide as a largest deviation allows: give one, too")
    if settings.weights is not None:
        raise SettingsError("strips are as wide as what is held allows, and weights hold nothing: leave them out")
    march = _March(read, settings, progress)
    until = math.inf if time_limit is None else time.perf_counter() + time_limit
    bounds = _Bounds(settings.max_deviation)
    for _ in range(_ROUNDS):
        bound = bounds.next
        try:
            stations = march.to_the_end(bound)
            reference = read(stations)
            result = fit(reference, prepare(settings, reference), time_limit=_left(until))
        except _EndedError:
            break
        except PanelError as error:
            bounds.refuse(error, march.farthest)
        else:
            bounds.tell(Widest(result=result, stations=stations, length=march.length, bound=bound))
        if bounds.settled or time.perf_counter() > until:
            break
    best = bounds.found()
    noted = replace(best.result.reference, notes=(*best.result.reference.notes, best.note()))
    told = replace(best.result, reference=noted, baselines=best.result.baselines.told_of(noted))
    return replace(best, result=told)


def uncut(how: ReferenceSettings, cuts: Cuts) -> ReferenceSettings:
    """How a reference is read at such cuts, where it is asked for strips."""
    return replace(how, divide=None, stations=cuts) if cuts else replace(how, divide=1)


def _left(until: float) -> float | None:
    return None if until == math.inf else max(until - time.perf_counter(), 1e-3)


def _off(result: FitResult) -> float:
    return float(result.measures.max_deviation.max())


class _Bounds:
    """The bounds for panels alone that were tried, and which one is next.

    Attributes:
        next: the bound to be tried, mm.
    """

    def __init__(self, allowed: float) -> None:
        self.next = self._allowed = allowed
        self._held: Widest | None = None
        self._nearest: Widest | None = None
        self._missed = math.inf
        self._refused: PanelError | None = None

    @property
    def settled(self) -> bool:
        """Whether a wider bound than one that held is not worth trying."""
        return self._held is not None and not _WORTH * self._held.bound < self._missed < math.inf

    def refuse(self, error: PanelError, farthest: float) -> None:
        """Learn that panels that were `farthest` mm off alone could not be fitted together at all."""
        self._refused, self._missed = error, min(self.next, farthest)
        self._choose(_MUCH_TIGHTER)

    def tell(self, found: Widest) -> None:
        """Learn what came of the bound."""
        if found.result.tolerance_met:
            self._held = found
        else:
            self._missed = found.bound
            if self._nearest is None or _off(found.result) < _off(self._nearest.result):
                self._nearest = found
        share = self._allowed / max(_off(found.result), 1e-9)
        self._choose(min(_TIGHTER, share) if share < 1.0 else _MUCH_TIGHTER)

    def _choose(self, tighter: float) -> None:
        """Between what held and what did not; where nothing held yet, by this share tighter than what did not."""
        self.next = tighter * self._missed if self._held is None else math.sqrt(self._held.bound * self._missed)

    def found(self) -> Widest:
        """The widest panels that held, or those that came nearest to it.

        Raises:
            SettingsError: panels so wide cannot be fitted together.
            CadpanelError: nothing was made.
        """
        best = self._held or self._nearest
        if best is not None:
            return best
        if self._refused is not None:
            raise SettingsError(
                f"panels as wide as {self._allowed:.6g} mm of deviation allow cannot be fitted together, nor can those "
                f"within {self._missed:.3g} mm: allow less ({self._refused})"
            )
        raise CadpanelError("the search for strips was ended before the first seams were found: nothing was made")


class _EndedError(Exception):
    """Somebody wants the march to end."""


class _March:
    """From seam to seam along one strip.

    Attributes:
        length: of the strip, mm.
        farthest: the largest deviation that any panel of the last march has alone, mm.
    """

    def __init__(self, read: Callable[[Cuts], Reference], settings: FitSettings, progress: Progress | None) -> None:
        self._read, self._alone, self._progress = read, settings.alone(), progress
        self._whole = read(())
        self.farthest = 0.0
        if len(self._whole.panels) != 1:
            raise SettingsError(
                f"strips are found along one strip, and '{self._whole.source}' has {len(self._whole.panels)} surfaces: "
                "choose the faces of one"
            )
        self.length = _length(self._whole.panels[0])
        self._refused: CadpanelError | None = None

    def to_the_end(self, bound: float) -> Cuts:
        """The seams of panels that are each as wide as the bound, mm, allows."""
        seams: list[float] = []
        self.farthest = 0.0
        guess = _FIRST * self.length
        while True:
            start = seams[-1] if seams else 0.0
            found = self._widest(start, guess, bound)
            if found is None:
                return tuple(seams)
            guess = found
            seams.append(start + guess)
            if len(seams) >= MOST_STRIPS:
                raise SettingsError(
                    f"more than {MOST_STRIPS} panels along the strip would be needed for {bound:.3g} mm: allow more"
                )
            if self._progress is not None and self._progress(len(seams), seams[-1]) is False:
                raise _EndedError

    def _widest(self, start: float, guess: float, bound: float) -> float | None:
        """The largest width from a seam on, as far as that is known; None where all that is left will do."""
        rest = self.length - start
        low, high, width, reached = 0.0, math.inf, guess, 0.0
        for _ in range(_TRIES):
            whole = width > _INSIDE * rest
            width = rest if whole else width
            far = self._far(start, None if whole else start + width)
            if far <= bound:
                low, reached = width, far
                if whole:
                    break
            else:
                high = width
            known = high < math.inf and high - low <= _KNOWN * high
            if low > 0.0 and (known or (1.0 - _NEAR) * bound <= far <= bound):
                break
            # A little inside of the bound, as the square of the width tells, and between what is known.
            width *= math.sqrt(min(max((1.0 - 0.5 * _NEAR) * bound / max(far, 1e-9), 1.0 / 16.0), 16.0))
            if width < _LEAST * self.length:
                break
            if high < math.inf:
                width = min(max(width, low + 0.1 * (high - low)), high - 0.1 * (high - low), _INSIDE * rest)
        if low == 0.0:
            raise SettingsError(
                f"no panel at {start:.0f} mm along the strip, however short, stays within {bound:.3g} mm: allow more, "
                "or choose another feature"
            ) from self._refused
        self.farthest = max(self.farthest, reached)
        return None if low >= rest else low

    def _far(self, start: float, stop: float | None) -> float:
        """The largest deviation of the panel between two places, fitted alone, mm; infinite where there is none."""
        cuts = tuple(place for place in (start, stop) if place)
        try:
            reference = self._read(cuts) if cuts else self._whole
            panel = reference.panels[1 if start else 0]
            alone = replace(reference, panels=(panel,), seams=())
            return _off(fit(alone, self._alone))
        except (PanelError, ReferenceFileError, SettingsError) as error:
            self._refused = error
            return math.inf


def _length(panel: PanelReference) -> float:
    """Of a strip along the middle between its two long edges, which are ends or sides, whichever way it bends, mm."""
    lengths = [float(arc_length(edge)[-1]) for edge in panel.edges]
    if len(lengths) != 4:
        raise PanelError(panel.name, f"it has {len(lengths)} edges, and strips have 4: cut it with a network of curves")
    return 0.5 * max(sum(lengths[:2]), sum(lengths[2:]))
