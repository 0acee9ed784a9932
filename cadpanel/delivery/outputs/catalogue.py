"""The outputs of a delivery, in the order in which they are written. A new one is a file of its own and a line here."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec

from cadpanel.delivery.outputs.drawings_pdf import DrawingsPdf
from cadpanel.delivery.outputs.flat_dxf import FlatDxf
from cadpanel.delivery.outputs.freecad import FreecadDocument
from cadpanel.delivery.outputs.output import Output
from cadpanel.delivery.outputs.panels_glb import PanelsGlb
from cadpanel.delivery.outputs.panels_ifc import PanelsIfc
from cadpanel.delivery.outputs.report_html import ReportHtml
from cadpanel.delivery.outputs.schedule import Schedule
from cadpanel.delivery.outputs.schedule_xlsx import ScheduleXlsx
from cadpanel.delivery.outputs.setting_out import SettingOut
from cadpanel.delivery.outputs.step_files import STEP, PanelsStep, SkinsStep
from cadpanel.errors import SettingsError

OUTPUTS: tuple[Output, ...] = (
    SkinsStep(),  # first: a second interpreter reads them back while the panels are being written
    PanelsStep(),
    FlatDxf(),
    Schedule(),
    SettingOut(),
    PanelsGlb(),
    ReportHtml(),
    ScheduleXlsx(),
    DrawingsPdf(),
    PanelsIfc(),
    FreecadDocument(),
)


def chosen_outputs(names: Sequence[str] | None, outputs: Sequence[Output] = OUTPUTS) -> tuple[Output, ...]:
    """The outputs of a delivery by their names, with those that every delivery has; all that need no asking if None.

    Raises:
        SettingsError: there is no output of that name, or the package that it needs is missing.
    """
    known = [output.name for output in outputs if not output.always]
    for name in names or ():
        if name not in (STEP, *known):
            raise SettingsError(f"there is no output '{name}'; choose from {', '.join((STEP, *known))}")
    chosen = [
        output for output in outputs if output.always or (output.unasked if names is None else output.name in names)
    ]
    for output in chosen:
        missing = [package for package in output.needs if find_spec(package) is None]
        if missing:
            raise SettingsError(
                f"the output '{output.name}' needs {' and '.join(missing)}: install it with "
                f"pip install 'cadpanel[{output.name}]', or leave the output out"
            )
    return tuple(chosen)
