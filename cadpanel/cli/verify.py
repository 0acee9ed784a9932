"""The command `cadpanel verify`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.printable import complain
from cadpanel.cli.steps import steps
from cadpanel.errors import DeliveryError, SettingsError


def verify(
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="DIR",
            help="A folder that 'cadpanel fit' or 'cadpanel run' wrote, or a file to be held against a delivery.",
        ),
    ],
    reference: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="What the panels approximate: deviation and drift are proved as well."),
    ] = None,
    reference_delivery: Annotated[
        Path | None,
        typer.Option(
            "--reference-delivery",
            metavar="DIR",
            help="Look for this delivery's solids in a STEP file that came back from another program.",
        ),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Read a delivery's files again and hold them against its report: every face, edge and vertex, names, gaps, flats.

    What needs the reference, deviation, drift and the turn of seams, is proved with --reference, and else listed.
    'cadpanel verify FILE.step --reference-delivery DIR' finds a delivery's solids in a file that another program wrote,
    by where they lie, whatever they are called there. Of a folder that 'cadpanel run' wrote every delivery is verified,
    and where building.step hangs them.

    Exit codes: 0 all holds; 1 something does not, and it says what; 2 a file is missing or cannot be read.
    """
    if reference_delivery is not None:
        if reference is not None:
            raise SettingsError("--reference measures a delivery, and --reference-delivery a file: give one of them")
        _came_back(folder, reference_delivery, quiet=quiet)
        return
    start_reader()
    if _is_a_jobs(folder):
        if reference is not None:
            raise SettingsError(f"--reference measures one delivery: name that of a region, '{folder}/NAME'")
        _whole_job(folder, quiet=quiet)
        return
    with steps(quiet=quiet) as shown:
        shown.begin("Read back and verify", folder.name)
        # Here, not above: help should not wait for them.
        from cadpanel.cli.tables import console, print_certificate
        from cadpanel.delivery.verify import verify as verify_delivery

        found = verify_delivery(folder, reference, progress=shown.count)
    if not quiet:
        print_certificate(found.certificate, str(folder))
        if not found.report.summary.tolerance_met:
            console().print("Note: the report says that its tolerance is not met.")
    if not found.holds:
        complain("\n".join(("The proof does not hold:", *found.failures, "")))
        raise typer.Exit(1)
    if not quiet:
        console().print("Everything holds.")
        console().print(f"Not proved: {', '.join(found.unproved)}.")


def _is_a_jobs(folder: Path) -> bool:
    from cadpanel.jobs.verified import is_folder_of_a_job

    try:
        return is_folder_of_a_job(folder)
    except OSError as error:
        raise DeliveryError(f"'{folder}' cannot be read: {error.strerror or error}.") from error


def _whole_job(folder: Path, *, quiet: bool) -> None:
    """Every delivery in the folder of a job, and the assembly on top of them."""
    from cadpanel.jobs.verified import assembly_faults, delivered_regions, verified_region

    found = []
    for name in delivered_regions(folder):
        with steps(quiet=quiet) as shown:
            shown.begin("Read back and verify", name)
            found.append(verified_region(folder / name, progress=shown.count))
    said = [f"{one.name}: {why}" for one in found for why in (one.refused, *one.failures) if why]
    said += assembly_faults(folder, {one.name: one.hung for one in found if one.hung is not None})
    if not quiet:
        from cadpanel.cli.tables import console, counted

        held, panels = sum(one.holds for one in found), sum(one.panels for one in found)
        console().print(f"Deliveries that hold: {held} of {len(found)}, with {counted(panels, 'panel')}.")
    if said:
        complain("\n".join(("The proof does not hold:", *said, "")))
        raise typer.Exit(2 if any(one.refused for one in found) else 1)
    if not quiet:
        console().print("Everything holds.")


def _came_back(file: Path, delivery: Path, *, quiet: bool) -> None:
    """A file that another program wrote, against a delivery."""
    with steps(quiet=quiet) as shown:
        shown.begin("Read and compare", file.name)
        start_reader()
        from cadpanel.cli.returned_table import print_solids_back
        from cadpanel.cli.tables import console
        from cadpanel.delivery.came_back import check_returned

        found = check_returned(file, delivery)
    if not quiet:
        print_solids_back(found.solids, str(file))
    if not found.holds:
        complain("\n".join(("The file is not what was delivered:", *found.failures, "")))
        raise typer.Exit(1)
    if not quiet:
        console().print(f"All {len(found.solids)} solids of the delivery are there.")
