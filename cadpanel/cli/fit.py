"""The command `cadpanel fit`."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import typer

from cadpanel.brep.files.text_check import require_files
from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.interrupt import first_interrupt_ends
from cadpanel.cli.printable import complain
from cadpanel.cli.steps import Steps, steps
from cadpanel.delivery.chosen_panels import chosen_panels, names_along
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.outputs.catalogue import chosen_outputs
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.source_date import source_date
from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.reference.texts import AUTO

if TYPE_CHECKING:
    from cadpanel.reference.model import Reference


class Asked(NamedTuple):
    """What is to be delivered."""

    sheet: SheetSettings
    shop: ShopSettings


_READ, _FIRST, _CONCURRENT = "Read reference", "Fit each alone", "Fit all at once"


@options.made_of_settings
def fit(
    reference: options.ReferenceFile,
    out: options.Out,
    settings: FitSettings,
    sheet: SheetSettings,
    shop: ShopSettings,
    how: ReferenceSettings,
    overwrite: options.Overwrite = False,
    quiet: options.Quiet = False,
    time_limit: options.TimeLimit = None,
    tell_steps: options.TellSteps = False,
) -> None:
    """Fit panels to a reference and deliver them as exact solids, with the proof beside them.

    The smallest deviation is found at which every gap stays within --gap-tolerance. Ctrl-C while all panels are fitted
    at once delivers the best so far, a second one leaves nothing.

    Exit codes: 0 all is well; 1 it ran, but the tolerance, the stock or the proof does not hold; 2 refused.
    """
    began = time.perf_counter()
    chosen_outputs(shop.outputs)  # refused before anything else is done, and so is a date that is none
    source_date()
    with delivery_folder(out, overwrite=overwrite) as folder, steps(quiet=quiet, told=tell_steps) as shown:
        run = _find if how.divide == AUTO else _run
        report, shortfall = run(reference, how, settings, Asked(sheet, shop), folder, shown, time_limit)
    if not quiet:
        # The tables are for people; numbers for programs are in report.json.
        from cadpanel.cli.tables import print_report

        print_report(report, out, time.perf_counter() - began)
    if shortfall is not None:
        complain(f"{shortfall}.\n")
        raise typer.Exit(1)


def _sentence(said: str) -> str:
    """On one line, whatever the panels' names hold."""
    words = " ".join(said.split())
    return f"{words[0].upper()}{words[1:]}"


def _begin_to_read(file: Path, how: ReferenceSettings, shown: Steps) -> None:
    """Refuse files that are not there, and start what reads: it takes seconds, and no refusal should wait for it."""
    shown.begin(_READ, file.name)
    require_files(file, how)
    start_reader()


def _run(
    file: Path,
    how: ReferenceSettings,
    settings: FitSettings,
    asked: Asked,
    folder: Path,
    shown: Steps,
    time_limit: float | None,
) -> tuple[ReportModel, str | None]:
    """Read, fit, build, write and verify; the report, and what the tolerance or the stock lacks."""
    _begin_to_read(file, how, shown)
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.deliver import fill_delivery
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.fitting.run import fit as fit_reference

    began = time.perf_counter()
    reference = read_reference(file, how)
    seconds_to_read = time.perf_counter() - began
    chosen_panels([panel.name for panel in reference.panels], asked.shop.only)  # refused before the fit
    settings = with_earlier(settings, reference)
    shown.begin(_FIRST)
    with first_interrupt_ends() as interrupted:

        def tell(_method: str, count: int, excess: float, rms: float) -> bool:
            shown.solving(_CONCURRENT, count, excess, rms)
            return not interrupted.heard()

        result = fit_reference(reference, settings, tell, time_limit=time_limit)
    report = fill_delivery(
        result, folder, asked.sheet, asked.shop, seconds_to_read=seconds_to_read, progress=shown.count
    )
    return report, _lacking(result.shortfall(), report)


def _lacking(shortfall: str | None, report: ReportModel) -> str | None:
    """What the tolerance and the stock lack, in sentences."""
    from cadpanel.delivery.records.stock import stock_shortfall

    said = [sentence for sentence in (shortfall, stock_shortfall(report)) if sentence is not None]
    return ". ".join(_sentence(words) for words in said) or None


def _find(
    file: Path,
    how: ReferenceSettings,
    settings: FitSettings,
    asked: Asked,
    folder: Path,
    shown: Steps,
    time_limit: float | None,
) -> tuple[ReportModel, str | None]:
    """The same with the fewest panels along each strip that hold everything."""
    if settings.max_deviation is None:
        raise SettingsError(f"--divide {AUTO} is chosen by the largest deviation: give --max-deviation, too.")
    _begin_to_read(file, how, shown)
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.deliver import fill_delivery
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.studies.fewest_panels import MOST, fewest_panels

    seconds_to_read = 0.0

    def read(count: int) -> Reference:
        nonlocal seconds_to_read
        began = time.perf_counter()
        reference = read_reference(file, replace(how, divide=count))
        if seconds_to_read == 0.0:  # what fits no panel of any number is refused before the first fit
            chosen_panels(names_along((panel.name for panel in reference.panels), MOST), asked.shop.only)
        seconds_to_read += time.perf_counter() - began
        return reference

    with first_interrupt_ends() as interrupted:

        def tell(count: int, step: int, excess: float, rms: float) -> bool:
            name = f"Fit {count} along each strip"
            if step == 0:
                shown.begin(name)
            else:
                shown.solving(name, step, excess, rms)
            return not interrupted.heard()

        found = fewest_panels(read, settings, progress=tell, time_limit=time_limit, prepare=with_earlier)
    report = fill_delivery(
        found.result, folder, asked.sheet, asked.shop, seconds_to_read=seconds_to_read, progress=shown.count
    )
    return report, _lacking(found.shortfall(), report)
