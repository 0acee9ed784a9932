"""The command `cadpanel compare`."""

from __future__ import annotations

from typing import Annotated

from cadpanel.brep.files.text_check import require_files
from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.steps import Steps, steps
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.own_files import COMPARISON
from cadpanel.delivery.records.comparison import ComparisonModel, write_comparison
from cadpanel.delivery.records.settings import OF_A_COLUMN
from cadpanel.fitting.settings import LIKE_THE_PAPER, FitSettings
from cadpanel.reference.settings import ReferenceSettings


@options.made_of_settings
def compare(
    reference: options.ReferenceFile,
    out: options.Out,
    settings: Annotated[FitSettings, options.Without(OF_A_COLUMN), options.Usual(LIKE_THE_PAPER)],
    how: ReferenceSettings,
    overwrite: options.Overwrite = False,
    quiet: options.Quiet = False,
) -> None:
    """Fit a reference four ways, two-stage and all at once, with cylinders and with cones: one row a seam.

    Nothing is built; compare.json holds the numbers.

    Exit codes: 0 the comparison is written; 2 refused.
    """
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
    require_files(file, how)
    start_reader()
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.delivery.records.table1 import comparison_record
    from cadpanel.studies.table1 import compare as compare_reference

    def tell(feature: str, method: str, count: int, excess: float, rms: float) -> None:
        step = f"{method.replace('_', '-')}, {feature}"
        if count == 0:
            shown.begin(step)
        else:
            shown.solving(step, count, excess, rms)

    panels = read_reference(file, how)
    settings = with_earlier(settings, panels)
    return comparison_record(panels, settings, compare_reference(panels, settings, progress=tell))
