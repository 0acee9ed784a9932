"""report.json: the numbers of one delivery, as records that refuse what does not belong in them.

Millimetres, square and cubic millimetres, and degrees throughout; the one exception, `max_tangency_error`, is in
radians and says so.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from cadpanel.delivery.records.blanks import BendModel, BlankModel, CutModel, FixingModel, Pair
from cadpanel.delivery.records.certified import CertificateModel, ClearModel, TimingModel
from cadpanel.delivery.records.jsonfile import (
    NonNegative,
    NonNegativeCount,
    Positive,
    Record,
    Vector,
    read_json,
    with_keys,
    write_json,
)
from cadpanel.delivery.records.patches import PatchModel, RulingModel
from cadpanel.delivery.records.settings import SettingsModel
from cadpanel.terms.limits.catalogue import LIMITS

Edge = Annotated[str, Field(pattern=r"^(end [01]|side [01]|edge \d+)$")]
Setting = bool | str | int | float | tuple[str | int | float, ...]


class UnitsModel(Record):
    """The units of every length and angle in the file."""

    length: Literal["mm"] = "mm"
    angle: Literal["deg"] = "deg"


class ReferenceModel(Record):
    """What was approximated.

    Attributes:
        file: name of the file.
        panels, seams: how many there are.
        notes: what was mended, moved, guessed or left out when it was read, one sentence each.
        reading: how it was read and cut, by the options that were not left at their defaults.
    """

    file: str
    panels: NonNegativeCount
    seams: NonNegativeCount
    notes: tuple[str, ...] = ()
    reading: dict[str, Setting] = Field(default_factory=dict)


class OriginModel(Record):
    """Where the coordinates of this report and of local files lie in the model's.

    Attributes:
        kept: whether the STEP files have the model's own coordinates.
        offset: what has to be added to local coordinates, mm; whole metres.
    """

    kept: bool = True
    offset: Vector = (0.0, 0.0, 0.0)


class SolveModel(Record):
    """How the result was reached.

    Attributes:
        iterations: linear systems solved.
        starts: how many starts were made.
        agreed: how many of them ended within 1 % of the best.
        prices: by how much the RMS deviation, mm, would fall for one unit more of what is held, to first order: of gaps
            and their parts a mm, of other limits a mm, a degree or a percent of the panel's length; empty where nothing
            is held at its tolerance.
    """

    iterations: NonNegativeCount
    starts: NonNegativeCount
    agreed: NonNegativeCount
    prices: dict[str, NonNegative] = Field(default_factory=dict)


class RuleModel(Record):
    """What was measured of a rule for single panels or seams.

    Attributes:
        rule: in a few words, with the names of what it is about.
        measure: what was measured.
        found: the number.
        allowed: what it may be at most.
        unit: "mm" or "degrees"; empty of what is counted.
        kept: whether it holds.
        values: the numbers of single panels behind it, by their names: of radii those halfway between the ends.
    """

    rule: str
    measure: str
    found: NonNegative
    allowed: NonNegative
    unit: Literal["mm", "degrees", ""]
    kept: bool
    values: dict[str, float] = Field(default_factory=dict)


class FittedModel(Record):
    """A panel as it was fitted, before it was cut back from its seams.

    Attributes:
        corners: as `PanelModel.corners`, mm; by them gaps are measured.
        cuts: the planes that cut end 0 and end 1; none of a polygon.
        rulings: as `PanelModel.rulings`.
    """

    corners: tuple[tuple[Vector, ...], ...]
    cuts: tuple[CutModel, ...] = ()
    rulings: tuple[RulingModel, ...] = ()

    def check_that_all_is_there(self, *, polygon: bool) -> None:
        """Refuse rows, cuts and rulings that do not belong together.

        Raises:
            ValueError: saying so.
        """
        rows = [len(row) for row in self.corners]
        whole = rows == rows[:1] and rows[0] >= 3 if polygon else len(rows) == 2 and rows[0] == rows[1] >= 2
        rulings = len(self.rulings) in ((0,) if polygon else (0, *rows[:1]))
        if not (whole and rulings and len(self.cuts) == (0 if polygon else 2)):
            raise ValueError(
                f"corners in rows of {rows}, {len(self.cuts)} cuts and {len(self.rulings)} rulings make no fitted panel"
            )


class PanelModel(Record):
    """One panel as it was fitted and built.

    Attributes:
        name: the panel's stable name.
        feature: name of its shape feature.
        rms_deviation: root mean square distance of the reference's samples to their patches, mm.
        max_deviation: largest distance of the reference, its outline included, to the patches, mm.
        hausdorff: two-sided distance between the trimmed skin and the reference, mm.
        max_corner_drift: largest distance of a corner from its reference corner, mm.
        max_drift_along: the same, counted along the strip only, mm.
        max_free_edge_drift: the same, counted across the free edges only, mm.
        outline_drift: largest distance of its free edges from the drawn ones, anywhere along them, mm.
        area: of the skin, mm^2.
        volume: of the solid, from the formula, mm^3.
        surface: area of all faces of the solid, mm^2; None in reports from before it was told, as are the next two.
        centroid: of the solid, mm.
        skin_centroid: of the skin, mm.
        corners: of the skin as it is built, mm; by them the files are held against the report. In rows: [end][ruling]
            of a chain, one row round a polygon. Half a joint back from the seams.
        fitted: the same before it was cut back; None in reports from before panels were.
        patches: in the order of the walk across the panel, as they are built.
        rulings: its straight lines in the order of the walk, to the last digit, each with the patch that begins there;
            none of a polygon. What else is told of its shape follows from them and its cuts.
        taken: which part of the reference each patch stands for: the places where patches begin and end, mm from side 0
            along the reference's end 0 and end 1; empty for polygons.
        moved: how far a corner was moved from where the fit had it, mm; 0 unless a cone became a cylinder.
        notes: what the fabricator should know, one sentence each; also of a bend that is not where it was told to be.
        blank: the panel as a flat part; None in reports from before it was known, as are the next ones.
        mass: of the sheet, kg.
        bends: its curved patches in the order of the walk, as they are bent.
        other_face: corners of the sheet's other face, in the same rows as those of the skin: by them the walls at its
            sides, or of a polygon, may lean.
        cuts: the planes in which its ends lie; none of a polygon.
        side_cuts: the planes in which side 0 and side 1 of a cone stand, half a joint back from their seams, their
            normals out of the panel; None of one along its ruling. Empty where both are.
        bevels: of each edge the least and the largest angle between wall and sheet normal, square to the edge; positive
            where the outer face is the shorter one. Along straight edges both are one; 0 where the wall is square.
        fixings: its holes, in the order of the flat pattern's outline.
        returns: its edges that are folded inwards; of a panel with bends each is two patches, a cylinder and a plane
            beyond it.
        tray: of a flat panel that is folded round its edges, the length of its returns on their outer face and their
            inner radius, mm. Corners are then where the planes of its walls meet, and the one patch is its flat part.
    """

    name: str
    feature: str
    rms_deviation: NonNegative
    max_deviation: NonNegative
    hausdorff: NonNegative
    max_corner_drift: NonNegative
    max_drift_along: NonNegative
    max_free_edge_drift: NonNegative
    outline_drift: NonNegative = 0.0
    area: Positive
    volume: Positive
    surface: Positive | None = None
    centroid: Vector | None = None
    skin_centroid: Vector | None = None
    corners: tuple[tuple[Vector, ...], ...]
    fitted: FittedModel | None = None
    patches: tuple[PatchModel, ...]
    rulings: tuple[RulingModel, ...] = ()
    taken: tuple[tuple[NonNegative, ...], ...] = ()
    moved: NonNegative = 0.0
    notes: tuple[str, ...] = ()
    blank: BlankModel | None = None
    mass: Positive | None = None
    bends: tuple[BendModel, ...] = ()
    other_face: tuple[tuple[Vector, ...], ...] = ()
    cuts: tuple[CutModel, ...] = ()
    side_cuts: tuple[CutModel | None, ...] = ()
    bevels: dict[Edge, Pair] = Field(default_factory=dict)
    fixings: tuple[FixingModel, ...] = ()
    returns: tuple[Edge, ...] = ()
    tray: Pair | None = None

    @model_validator(mode="after")
    def _check_that_corners_enclose_patches(self) -> PanelModel:
        rows = [len(row) for row in self.corners]
        chain = rows == 2 * [len(self.patches) + 1] and len(self.patches) >= 1
        polygon = len(rows) == 1 and rows[0] >= 3 and len(self.patches) == 1
        if not (chain or polygon):
            raise ValueError(f"corners in rows of {rows} do not fit {len(self.patches)} patches")
        if self.other_face and [len(row) for row in self.other_face] != rows:
            raise ValueError("the other face has other corners than the skin")
        if self.rulings and (polygon or len(self.rulings) != rows[0]):
            raise ValueError(f"{len(self.rulings)} rulings do not fit corners in rows of {rows}")
        if self.side_cuts and (polygon or len(self.side_cuts) != 2):
            raise ValueError(f"{len(self.side_cuts)} planes of sides do not fit corners in rows of {rows}")
        for side, cut in enumerate(self.side_cuts):
            if cut is not None and self.patches[-side].kind == "plane":
                raise ValueError(f"side {side} is flat, and needs no plane of its own")
        if self.fitted is not None:
            self.fitted.check_that_all_is_there(polygon=polygon)
        return self


class SeamModel(Record):
    """Two panels that meet edge to edge, and how well they do.

    Attributes:
        panels: the two names.
        edges: which edge of each panel lies on the seam: "end 0", "end 1", "side 0", "side 1"; of a polygon "edge 0"
            and so on.
        reversed: whether the first corner of one edge meets the last corner of the other.
        corner_gaps: distance between corresponding corners, in the order of the first panel's edge, mm; only the two
            outermost correspond where the edges are of different kinds.
        max_corner_gap: the largest of them, mm.
        max_seam_gap: symmetric Hausdorff distance between the two edges, mm.
        width, step, shift: largest parts of the gap along the whole seam, mm: in the skins and square to the seam,
            along the skins' normal, along the seam at its outermost corners.
        turn: largest angle of the two edges with the drawn seam, degrees.
        unevenness: how far the seam's corners lie off the middle between those before and after it, against the
            drawing, mm; 0 where a panel has no ends.
        max_kink: largest angle between the two skins' normals across the seam, degrees.
        price: by how much the RMS deviation of all panels, mm, would fall for one mm more of the gap, or of all its
            parts, at this seam alone, to first order; None where nothing is held at its tolerance.
        plane: in the middle of the joint, its normal out of the first panel; None in reports from before there were
            joints.
        joint: clear width that was asked for of this seam alone, mm; None where it is that of all.
        recut: how far a corner of either edge was from that plane, at most, mm: so far the edges were moved to lie in
            it; the same.
        clear: the clear width between the two sheets along the whole seam, measured in panels.step; the same, and None
            where one of the panels is not delivered.
    """

    panels: tuple[str, str]
    edges: tuple[Edge, Edge]
    reversed: bool
    corner_gaps: tuple[NonNegative, ...]
    max_corner_gap: NonNegative
    max_seam_gap: NonNegative
    width: NonNegative = 0.0
    step: NonNegative = 0.0
    shift: NonNegative = 0.0
    turn: NonNegative = 0.0
    unevenness: NonNegative = 0.0
    max_kink: NonNegative
    price: NonNegative | None = None
    plane: CutModel | None = None
    joint: NonNegative | None = None
    recut: NonNegative | None = None
    clear: ClearModel | None = None


@with_keys(limit.rows[-1].key for limit in LIMITS)
class SummaryModel(Record):
    """The measures of a whole fit, mm and degrees; gaps and kink are 0 where there is no seam.

    Of every limit in the catalogue there is the worst of all panels, None where a panel has nothing to limit.

    Attributes:
        max_corner_gap: largest distance between two corresponding corners.
        max_seam_gap: largest distance between two end curves, along the whole seam.
        max_width, max_step, max_shift: the largest of their parts.
        max_kink: largest angle between two neighbouring skins' normals.
        max_unevenness: how far a corner on a seam lies off the middle between those before and after it.
        max_off_level: largest distance of a level seam from its drawn plane; None where no seam is drawn level.
        rms_deviation: root mean square over all samples.
        max_deviation: largest distance of the reference, its outline included, to the patches.
        hausdorff: two-sided distance between the trimmed skin and the reference.
        max_corner_drift: largest distance of a corner from its reference corner.
        max_drift_along: the same, counted along the strip only.
        max_free_edge_drift: the same, counted across the free edges only.
        max_outline_drift: largest distance of a free edge from the drawn outline, anywhere along it.
        drift_along_percent, drift_across_percent: the two before it as the largest share of a panel's own length,
            percent.
        local_rms_multiple: the RMS deviation divided by the local fit's; None where the local fit is exact.
        tolerance_met: whether every gap is within the tolerance and every limit is kept; always true where weights
            ruled, which have no tolerance to miss.
    """

    max_corner_gap: NonNegative
    max_seam_gap: NonNegative
    max_width: NonNegative = 0.0
    max_step: NonNegative = 0.0
    max_shift: NonNegative = 0.0
    max_kink: NonNegative
    max_unevenness: NonNegative = 0.0
    max_off_level: NonNegative | None = None
    rms_deviation: NonNegative
    max_deviation: NonNegative
    hausdorff: NonNegative
    max_corner_drift: NonNegative
    max_drift_along: NonNegative
    max_free_edge_drift: NonNegative
    max_outline_drift: NonNegative = 0.0
    drift_along_percent: NonNegative
    drift_across_percent: NonNegative
    local_rms_multiple: NonNegative | None
    tolerance_met: bool


class BaselinesModel(Record):
    """The same measures for the methods that ours is held against."""

    local: SummaryModel
    two_stage: SummaryModel


class ReportModel(Record):
    """report.json as a whole; its parts must agree with one another."""

    schema_name: Literal["cadpanel.report/1"] = Field(default="cadpanel.report/1", alias="schema")
    units: UnitsModel = UnitsModel()
    reference: ReferenceModel
    origin: OriginModel = OriginModel()
    settings: SettingsModel
    solve: SolveModel
    panels: tuple[PanelModel, ...]
    seams: tuple[SeamModel, ...]
    features: dict[str, NonNegativeCount] = Field(default_factory=dict)
    rules: tuple[RuleModel, ...] = ()
    summary: SummaryModel
    baselines: BaselinesModel
    certificate: CertificateModel
    timing: TimingModel

    @model_validator(mode="after")
    def _check_that_parts_agree(self) -> ReportModel:
        names = {panel.name for panel in self.panels}
        if len(names) != len(self.panels):
            raise ValueError("two panels have the same name")
        if not self.panels:
            raise ValueError("it tells of no panel")
        if len(self.panels) != self.reference.panels:
            raise ValueError(f"the reference counts {self.reference.panels} panels, the list {len(self.panels)}")
        if len(self.seams) != self.reference.seams:
            raise ValueError(f"the reference counts {self.reference.seams} seams, the list {len(self.seams)}")
        for seam in self.seams:
            for name in seam.panels:
                if name not in names:
                    raise ValueError(f"a seam names the panel '{name}', which is not in the list")
        return self


def read_report(path: Path) -> ReportModel:
    """The report in a file.

    Raises:
        DeliveryError: it cannot be read or is not a report; one sentence says where.
    """
    return read_json(path, ReportModel, schema="cadpanel.report/1", what="a cadpanel report")


def write_report(report: ReportModel, path: Path) -> None:
    """Write the report; the same report gives the same bytes.

    Raises:
        DeliveryError: it cannot be written.
    """
    write_json(report, path)
