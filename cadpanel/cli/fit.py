"""The command `cadpanel fit`."""

from __future__ import annotations

import time

import typer

from cadpanel.cli import options
from cadpanel.cli.interrupt import first_interrupt_ends
from cadpanel.cli.printable import complain
from cadpanel.cli.steps import steps
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.outputs.catalogue import chosen_outputs
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.source_date import source_date
from cadpanel.fitting.settings import FitSettings
from cadpanel.jobs.make import Asked, make_delivery
from cadpanel.reference.settings import ReferenceSettings


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
    verbose: options.Verbose = False,
    time_limit: options.TimeLimit = None,
    tell_steps: options.TellSteps = False,
) -> None:
    """Fit panels to a reference and deliver them as exact solids, with the proof beside them.

    The smallest deviation is found at which every gap and every limit is held. Ctrl-C while all panels are fitted
    at once delivers the best so far, a second one leaves nothing.

    Exit codes: 0 all is well; 1 it ran, but the tolerance, the stock or the proof does not hold; 2 refused.
    """
    began = time.perf_counter()
    chosen_outputs(shop.outputs)  # refused before anything else is done, and so is a date that is none
    source_date()
    asked = Asked(file=reference, how=how, settings=settings, sheet=sheet, shop=shop)
    with delivery_folder(out, overwrite=overwrite) as folder, steps(quiet=quiet, told=tell_steps) as shown:
        report, shortfall = make_delivery(asked, folder, shown, time_limit=time_limit, ending=first_interrupt_ends)
    if not quiet:
        # The tables are for people; numbers for programs are in report.json.
        from cadpanel.cli.tables import print_report

        print_report(report, out, time.perf_counter() - began, verbose=verbose)
    if shortfall is not None:
        complain(f"{shortfall}.\n")
        raise typer.Exit(1)
