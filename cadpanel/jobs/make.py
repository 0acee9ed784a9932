"""One reference to one delivery: read, fit, build, write and prove, told step by step."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from cadpanel.brep.files.text_check import require_files
from cadpanel.brep.isolation.client import start_reader
from cadpanel.delivery.chosen_panels import chosen_panels, names_along
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings
from cadpanel.garbage import keep_what_is_loaded
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.reference.texts import AUTO, BY_FITS, STRIPS

if TYPE_CHECKING:
    from cadpanel.fitting.result import FitResult
    from cadpanel.reference.model import Reference

_READ, _FIRST, _CONCURRENT = "Read reference", "Fit each alone", "Fit all at once"
_AT_ONCE = 1e-3
"""Seconds after which a fit ends whose time is up before it begins."""


class Told(Protocol):
    """Who is told how far it is; `cli.steps.Steps` is such a one."""

    def begin(self, step: str, detail: str = "") -> None:
        """A step begins, and those before it are done."""

    def count(self, step: str, done: int, of: int) -> None:
        """So much of a step is done."""

    def solving(self, step: str, count: int, excess: float, rms: float) -> None:
        """How far a fit is from its tolerances and the reference."""


class Ending(Protocol):
    """Somebody who may want a fit to end."""

    def heard(self) -> bool:
        """Whether it is to end with the best so far."""


class _Nobody:
    def heard(self) -> bool:
        return False


def _never() -> AbstractContextManager[Ending]:
    return nullcontext(_Nobody())


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """What is to be made of a reference.

    Attributes:
        file: the reference.
        how, settings, sheet, shop: how it is read, fitted, built and delivered.
        folder_of: where the earlier delivery of a name lies, for rules that lock panels to one.
    """

    file: Path
    how: ReferenceSettings
    settings: FitSettings
    sheet: SheetSettings
    shop: ShopSettings
    folder_of: Callable[[str], Path] = Path


def make_delivery(
    asked: Asked,
    folder: Path,
    shown: Told,
    *,
    time_limit: float | None = None,
    ending: Callable[[], AbstractContextManager[Ending]] = _never,
) -> tuple[ReportModel, str | None]:
    """Read, fit, build, write and verify into a folder that is there.

    Args:
        asked: what.
        folder: as `delivery_folder` gives it.
        shown: told of the steps.
        time_limit: seconds after which the fit ends with the best so far.
        ending: who may end the fit, asked as long as it runs.

    Returns:
        The report, and what the tolerance or the stock lacks, in sentences; None where they lack nothing.

    Raises:
        CadpanelError: the reference or a setting is refused, or the proof does not hold.
    """
    make = _fewest if asked.how.divide == AUTO else _strips if asked.how.divide == STRIPS else _once
    if asked.how.divide in BY_FITS and asked.settings.max_deviation is None:
        raise SettingsError(
            f"--divide {asked.how.divide} is chosen by the largest deviation: give --max-deviation, too."
        )
    shown.begin(_READ, asked.file.name)
    # Refused before what reads is started: it takes seconds, and no refusal should wait for it.
    require_files(asked.file, asked.how)
    start_reader()
    return make(asked, folder, shown, time_limit, ending)


class _Reading:
    """Reads a reference however it is cut, and counts the seconds of all readings."""

    def __init__(self, file: Path) -> None:
        self._file, self.seconds = file, 0.0

    def __call__(self, how: ReferenceSettings) -> Reference:
        from cadpanel.brep.read import read_reference

        began = time.perf_counter()
        reference = read_reference(self._file, how)
        self.seconds += time.perf_counter() - began
        return reference


class _Fitting:
    """Fits of one file that is cut in one way or another, which share what time there is.

    Attributes:
        read: reads it, and counts the seconds of that.
    """

    def __init__(
        self,
        asked: Asked,
        shown: Told,
        time_limit: float | None,
        ending: Callable[[], AbstractContextManager[Ending]],
    ) -> None:
        self.read = _Reading(asked.file)
        self._asked, self._shown, self._ending = asked, shown, ending
        self._limit, self._until, self._heard = time_limit, math.inf, False

    def fit(self, how: ReferenceSettings) -> FitResult:
        """Read and fit; the time of all fits begins with the first one."""
        from cadpanel.delivery.earlier import with_earlier
        from cadpanel.fitting.run import fit

        reference = self.read(how)
        # Refused before the fit.
        chosen_panels([panel.name for panel in reference.panels], self._asked.shop.only)
        settings = with_earlier(self._asked.settings, reference, self._asked.folder_of)
        self._shown.begin(_FIRST)
        if self._limit is not None and self._until == math.inf:
            self._until = time.perf_counter() + self._limit
        with self._ending() as interrupted:

            def tell(_method: str, count: int, excess: float, rms: float) -> bool:
                self._shown.solving(_CONCURRENT, count, excess, rms)
                return not interrupted.heard()

            left = None if self._limit is None else max(self._until - time.perf_counter(), _AT_ONCE)
            result = fit(reference, settings, tell, time_limit=left)
            self._heard |= interrupted.heard()
        return result

    def over(self) -> bool:
        """Whether somebody wants it to end, or the time is up."""
        return self._heard or time.perf_counter() > self._until


def _once(
    asked: Asked,
    folder: Path,
    shown: Told,
    time_limit: float | None,
    ending: Callable[[], AbstractContextManager[Ending]],
) -> tuple[ReportModel, str | None]:
    from cadpanel.delivery.blanks_fit import blanks_fit
    from cadpanel.jobs.stocked import fitted_to_stock

    fitting = _Fitting(asked, shown, time_limit, ending)
    fits = partial(blanks_fit, sheet=asked.sheet, shop=asked.shop)
    result = fitted_to_stock(asked.how, fitting.fit, fits, fitting.over)
    return _delivered(asked, result, folder, shown, fitting.read.seconds, result.shortfall())


def _fewest(
    asked: Asked,
    folder: Path,
    shown: Told,
    time_limit: float | None,
    ending: Callable[[], AbstractContextManager[Ending]],
) -> tuple[ReportModel, str | None]:
    """The same with the fewest panels along each strip that hold everything."""
    from cadpanel.delivery.blanks_fit import blanks_fit
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.studies.fewest_panels import MOST, fewest_panels

    reading = _Reading(asked.file)

    def read(count: int) -> Reference:
        first = not reading.seconds
        reference = reading(replace(asked.how, divide=count))
        if first:  # what fits no panel of any number is refused before the first fit
            chosen_panels(names_along((panel.name for panel in reference.panels), MOST), asked.shop.only)
        return reference

    with ending() as interrupted:

        def tell(count: int, step: int, excess: float, rms: float) -> bool:
            name = f"Fit {count} along each strip"
            if step == 0:
                shown.begin(name)
            else:
                shown.solving(name, step, excess, rms)
            return not interrupted.heard()

        prepare = partial(with_earlier, folder_of=asked.folder_of)
        fit_stock = partial(blanks_fit, sheet=asked.sheet, shop=asked.shop)
        found = fewest_panels(
            read, asked.settings, progress=tell, time_limit=time_limit, prepare=prepare, admitted=fit_stock
        )
    return _delivered(asked, found.result, folder, shown, reading.seconds, found.shortfall())


def _strips(
    asked: Asked,
    folder: Path,
    shown: Told,
    time_limit: float | None,
    ending: Callable[[], AbstractContextManager[Ending]],
) -> tuple[ReportModel, str | None]:
    """The same with panels one after the other, each as wide as the largest deviation allows."""
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.studies.widest_strips import uncut, widest_strips

    reading = _Reading(asked.file)

    with ending() as interrupted:

        def tell(seams: int, place: float) -> bool:
            shown.begin(f"Strip {seams}, to {place:.0f} mm")
            return not interrupted.heard()

        found = widest_strips(
            lambda cuts: reading(uncut(asked.how, cuts)),
            asked.settings,
            progress=tell,
            time_limit=time_limit,
            prepare=partial(with_earlier, folder_of=asked.folder_of),
        )
    chosen_panels([panel.name for panel in found.result.reference.panels], asked.shop.only)
    return _delivered(asked, found.result, folder, shown, reading.seconds, found.result.shortfall())


def _delivered(
    asked: Asked, result: FitResult, folder: Path, shown: Told, seconds_to_read: float, shortfall: str | None
) -> tuple[ReportModel, str | None]:
    from cadpanel.delivery.deliver import fill_delivery
    from cadpanel.delivery.records.stock import stock_shortfall

    keep_what_is_loaded()
    report = fill_delivery(
        result, folder, asked.sheet, asked.shop, seconds_to_read=seconds_to_read, progress=shown.count
    )
    said = [sentence for sentence in (shortfall, stock_shortfall(report)) if sentence is not None]
    return report, ". ".join(_sentence(words) for words in said) or None


def _sentence(said: str) -> str:
    """On one line, whatever the panels' names hold."""
    words = " ".join(said.split())
    return f"{words[0].upper()}{words[1:]}"
