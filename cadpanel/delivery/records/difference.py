"""What differs between two deliveries, as records. Millimetres and degrees."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegative, Record

Status = Literal["same", "renamed", "moved", "changed", "new", "gone"]


class PanelDifference(Record):
    """A panel of two deliveries.

    Attributes:
        name: in the later delivery; in the earlier one where it is gone.
        before: its name in the earlier delivery; None where it is new.
        status: "same", or "renamed" where only its name differs; "moved" where the part is the same and hangs
            elsewhere; "changed" where the part is another one; "new" or "gone" where one delivery has no such panel.
        cut_again: whether its blank must be cut again: it is new, or another sheet, contour or
            hole.
        bend_again: whether it must be bent otherwise: other radii or sweeps, or bends elsewhere on the blank.
        moved: how far its farthest corner went, in the model's coordinates; None where corners do not correspond.
        contour: how far the farthest place of the flat contour lies from the old one, laid upon it; the same.
        bend_lines: the same for the lines of its bends.
        holes: the same for the middles of its holes; None also where they are others in number or diameter.
        radius: largest difference of an inner radius; None where bends do not correspond, as are the next ones.
        sweep: largest difference of a sweep.
        bevel: largest difference of an edge's bevel.
        area: by how much the blank's area grew, mm2; None where there is but one.
        mass: by how much the panel became heavier, kg; the same.
        features: names of the shape features, before and now, where they differ.
    """

    name: str
    before: str | None
    status: Status
    cut_again: bool
    bend_again: bool
    moved: NonNegative | None = None
    contour: NonNegative | None = None
    bend_lines: NonNegative | None = None
    holes: NonNegative | None = None
    radius: NonNegative | None = None
    sweep: NonNegative | None = None
    bevel: NonNegative | None = None
    area: float | None = None
    mass: float | None = None
    features: tuple[str, str] | None = None


class DifferenceModel(Record):
    """Two deliveries against each other.

    Attributes:
        before, now: the two folders as they were named.
        tolerance: lengths that differ by no more are the same, mm.
        sheet: what differs of the sheet that all panels are made of: "thickness", before and now.
        panels: every panel of either, in the order of the later one, and then those that are gone.
    """

    schema_name: Literal["cadpanel.diff/1"] = Field(default="cadpanel.diff/1", alias="schema")
    before: str
    now: str
    tolerance: NonNegative
    sheet: dict[str, tuple[str, str]] = Field(default_factory=dict)
    panels: tuple[PanelDifference, ...]

    @property
    def same(self) -> bool:
        """Whether nothing differs."""
        return not self.sheet and all(panel.status == "same" for panel in self.panels)
