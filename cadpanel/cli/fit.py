"""The command `cadpanel fit`."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.steps import Steps, steps
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.settings import Schema, SheetSettings
from cadpanel.fitting.settings import FitSettings, Method
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.reference.settings import ReferenceSettings

_READ, _FIRST, _CONCURRENT = "Read reference", "Fit each alone, two-stage", "Fit all at once"


def fit(
    reference: options.ReferenceFile,
    out: options.Out,
    feature: options.FeatureOption = "plane-cone-plane",
    max_deviation: options.MaxDeviation = None,
    tilt: options.TiltOption = "free",
    method: Annotated[
        Method, typer.Option("--method", help="Each panel alone; then moved about; or all at once.")
    ] = "concurrent",
    gap_tolerance: options.GapTolerance = None,
    weights: options.WeightsOption = None,
    drift_along: options.DriftAlong = 5.0,
    drift_across: options.DriftAcross = 2.0,
    min_radius: options.MinRadius = 10.0,
    blend: options.BlendOption = None,
    thickness: Annotated[float, typer.Option("--thickness", metavar="MM", help="Of the sheet.")] = 3.0,
    skin_side: Annotated[
        SkinSide, typer.Option("--skin-side", help="Is the fitted skin the sheet's outer or inner face?")
    ] = "outer",
    restarts: options.Restarts = 0,
    seed: options.Seed = 0,
    seam_tolerance: options.SeamTolerance = 1.0,
    unit: options.Unit = None,
    faces: options.Faces = None,
    divide: options.Divide = None,
    lip: options.LipBand = None,
    grid: options.Grid = None,
    by: options.GridBy = None,
    stations: options.Stations = None,
    spine: options.Spine = None,
    network: options.Network = None,
    mesh: options.Mesh = None,
    junctions: options.Junctions = False,
    schema: Annotated[Schema, typer.Option("--schema", help="Of the STEP files.")] = "AP242",
    overwrite: options.Overwrite = False,
    quiet: options.Quiet = False,
) -> None:
    """Fit panels to a reference and deliver them as exact solids, with the proof beside them.

    The smallest deviation is found at which every gap stays within --gap-tolerance.

    Exit codes: 0 all is well; 1 it ran, but the tolerance or the proof does not hold; 2 refused.
    """
    began = time.perf_counter()
    settings = options.fit_settings(
        feature=feature,
        max_deviation=max_deviation,
        method=method,
        tilt=tilt,
        gap_tolerance=gap_tolerance,
        weights=weights,
        drift_along=drift_along,
        drift_across=drift_across,
        min_radius=min_radius,
        blend=blend,
        restarts=restarts,
        seed=seed,
    )
    how = options.reference_settings(
        seam_tolerance=seam_tolerance,
        unit=unit,
        faces=faces,
        divide=divide,
        lip=lip,
        grid=grid,
        by=by,
        stations=stations,
        spine=spine,
        network=network,
        mesh=mesh,
        junctions=junctions,
    )
    sheet = SheetSettings(thickness=thickness, skin_side=skin_side, schema=schema)
    with delivery_folder(out, overwrite=overwrite) as folder, steps(quiet=quiet) as shown:
        report, shortfall = _run(reference, how, settings, sheet, folder, shown)
    if not quiet:
        # The tables are for people; numbers for programs are in report.json.
        from cadpanel.cli.tables import print_report

        print_report(report, out, time.perf_counter() - began)
    if shortfall is not None:
        words = " ".join(shortfall.split())  # on one line, whatever the panels' names hold
        sys.stderr.write(f"{words[0].upper()}{words[1:]}.\n")
        raise typer.Exit(1)


def _run(
    file: Path, how: ReferenceSettings, settings: FitSettings, sheet: SheetSettings, folder: Path, shown: Steps
) -> tuple[ReportModel, str | None]:
    """Read, fit, build, write and verify; the report, and what the tolerance lacks."""
    shown.begin(_READ, file.name)
    # Here, not above: the CAD kernel takes seconds to load, and neither help nor a refusal should wait for it.
    start_reader()
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.deliver import fill_delivery
    from cadpanel.fitting.run import fit as fit_reference

    began = time.perf_counter()
    reference = read_reference(file, how)
    seconds_to_read = time.perf_counter() - began
    shown.begin(_FIRST)
    result = fit_reference(
        reference, settings, lambda _method, round_, excess: shown.round(_CONCURRENT, round_, excess)
    )
    report = fill_delivery(result, folder, sheet, seconds_to_read=seconds_to_read, progress=shown.count)
    return report, result.shortfall()
