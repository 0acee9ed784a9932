"""The command `cadpanel compare`."""

from __future__ import annotations

from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.steps import Steps, steps
from cadpanel.delivery.folder import COMPARISON, delivery_folder
from cadpanel.delivery.records.comparison import ComparisonModel, write_comparison
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.settings import ReferenceSettings


def compare(
    reference: options.ReferenceFile,
    out: options.Out,
    tilt: options.TiltOption = "free",
    gap_tolerance: options.GapTolerance = None,
    weights: options.WeightsOption = None,
    drift_along: options.DriftAlong = 5.0,
    drift_across: options.DriftAcross = 2.0,
    min_radius: options.MinRadius = 10.0,
    blend: options.BlendOption = None,
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
    overwrite: options.Overwrite = False,
    quiet: options.Quiet = False,
) -> None:
    """Fit a reference four ways, two-stage and all at once, with cylinders and with cones: one row a seam.

    Nothing is built; compare.json holds the numbers.

    Exit codes: 0 the comparison is written; 2 refused.
    """
    settings = options.fit_settings(
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
    with delivery_folder(out, overwrite=overwrite) as folder, steps(quiet=quiet) as shown:
        comparison = _run(reference, how, settings, shown)
        write_comparison(comparison, folder / COMPARISON)
    if not quiet:
        from cadpanel.cli.tables import console, print_comparison

        print_comparison(comparison)
        console().print(f"Written: {out}", soft_wrap=True)


def _run(file: options.ReferenceFile, how: ReferenceSettings, settings: FitSettings, shown: Steps) -> ComparisonModel:
    shown.begin("Read reference", file.name)
    # Here, not above: the CAD kernel takes seconds to load, and neither help nor a refusal should wait for it.
    start_reader()
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.records.table1 import comparison_record
    from cadpanel.studies.table1 import compare as compare_reference

    def tell(feature: str, method: str, round_: int, excess: float) -> None:
        step = f"{method.replace('_', '-')}, {feature}"
        if round_ == 0:
            shown.begin(step)
        else:
            shown.round(step, round_, excess)

    panels = read_reference(file, how)
    return comparison_record(panels, settings, compare_reference(panels, settings, progress=tell))
