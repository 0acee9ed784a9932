"""The outputs of a delivery, in the order in which they are written. A new one is a file of its own and a line here."""

from __future__ import annotations

from cadpanel.delivery.outputs.output import Output
from cadpanel.delivery.outputs.step_files import PanelsStep, SkinsStep

OUTPUTS: tuple[Output, ...] = (
    SkinsStep(),  # first: a second interpreter reads them back while the panels are being written
    PanelsStep(),
)
