"""What the files of a delivery tell of, and what they show when they are read back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings

if TYPE_CHECKING:  # they take their time to load, and a refusal asks for names only
    from cadpanel.delivery.records.flat_parts import FlatPart
    from cadpanel.delivery.records.report import PanelModel, SeamModel, SummaryModel
    from cadpanel.geometry.panel import Panel


@dataclass(frozen=True, slots=True, kw_only=True)
class Contents:
    """What a delivery's files tell of, in the order of the panels that are delivered.

    Attributes:
        title: the reference's name without its ending.
        sheet: thickness, side and schema.
        shop: what was asked for besides the solids, and how.
        records: the panels as the report tells of them.
        seams: all seams of the reference.
        parts: the panels as flat parts.
        shapes: the panels as the records give them back, to be built anew from them.
        joint: clear width between sheets that is promised, mm; None where none is, not even that sheets touch, as in
            reports from before there were joints.
        origin: what has to be added to local coordinates to have the model's, mm.
        summary: what the whole fit is judged by; None where no file tells of it.
        drawn: of the drawings that were made of all this, by their names, the digest of each file as it was to be
            written, until they are proved; `dataclasses.replace` forgets them.
    """

    title: str
    sheet: SheetSettings
    shop: ShopSettings
    records: tuple[PanelModel, ...]
    seams: tuple[SeamModel, ...]
    parts: tuple[FlatPart, ...]
    shapes: tuple[Panel, ...] = ()
    joint: float | None = 0.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    summary: SummaryModel | None = None
    drawn: dict[str, str] = field(init=False, default_factory=dict, repr=False, compare=False)

    @property
    def placed(self) -> tuple[float, float, float]:
        """Where the local origin lies in STEP files, mm."""
        return self.origin if self.shop.origin == "keep" else (0.0, 0.0, 0.0)

    @property
    def where(self) -> str:
        """Where the local origin lies in the model, for files in local coordinates; empty where it is the model's."""
        if not any(self.origin) or self.shop.origin == "keep":
            return ""
        return "local origin at {:.0f}, {:.0f}, {:.0f} mm of the model".format(*self.origin)


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """What the files of an output showed when they were read back.

    Attributes:
        numbers: what was measured, by name.
        failures: one sentence for everything that does not hold, naming the file.
    """

    numbers: dict[str, float] = field(default_factory=dict)
    failures: tuple[str, ...] = ()
