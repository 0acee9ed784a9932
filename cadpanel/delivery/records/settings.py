"""The settings of a fit as report.json and compare.json hold them: enough to run it again with the same numbers."""

from __future__ import annotations

from dataclasses import asdict, fields
from importlib.metadata import version
from typing import Annotated, Any, Literal

from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegative, NonNegativeCount, Record, with_keys
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.bends.asked import Blend
from cadpanel.fitting.rules.book import Rules
from cadpanel.fitting.settings import FitSettings, Method, Weights
from cadpanel.reference.model import Reference
from cadpanel.terms.limits.catalogue import LIMITS

OF_A_COLUMN = ("feature", "max_deviation", "method", "rules", "energy", "tau")
"""The settings of a fit that a comparison chooses itself, for each column its own, or does without."""
# Where a record calls a setting by another name.
_KEYS = {"schema": "step_schema"}


class WeightsModel(Record):
    """Weights of the paper's objective, where they were asked for instead of a tolerance."""

    gap: NonNegative
    deviation: NonNegative
    drift: NonNegative


@with_keys(limit.name for limit in LIMITS if limit.asked)
class ComparisonSettingsModel(Record):
    """What all columns of a comparison were fitted under; of every limit that can be set there is what was allowed.

    Attributes:
        cadpanel_version: of the program that wrote the file.
        tilt: "free" where cut planes may tilt, "fixed" where they stand upright.
        gap_tolerance: largest gap allowed between neighbours, mm; None where it was not asked for, or weights ruled.
        joint_tolerance, step, shift: the same of its parts, mm.
        gaps: what was held of gaps, mm: "gap" the whole, "width", "step" and "shift" its parts; empty where weights
            ruled.
        weights: the weights, or None where a tolerance was held.
        drift_along: how far a corner might move along its free edge, a share of the panel's length.
        drift_across: the same across its free edge.
        drift_outline: how far the free outline might leave the drawn one; 0.5 for any.
        min_radius: tightest radius that was allowed anywhere, mm.
        blend: which stretches were to become curved patches, where the user said so.
        restarts: further starts.
        seed: of the random numbers.
        seam_tolerance: how far the ends of two panels that meet might lie apart in the reference, mm.
    """

    cadpanel_version: str
    tilt: Literal["free", "fixed"]
    gap_tolerance: Annotated[float, Field(gt=0.0)] | None
    joint_tolerance: Annotated[float, Field(gt=0.0)] | None = None
    step: Annotated[float, Field(gt=0.0)] | None = None
    shift: Annotated[float, Field(gt=0.0)] | None = None
    gaps: dict[str, Annotated[float, Field(gt=0.0)]] = Field(default_factory=dict)
    weights: WeightsModel | None
    drift_along: NonNegative
    drift_across: NonNegative
    drift_outline: NonNegative = 0.5
    min_radius: NonNegative = 0.0
    blend: tuple[str, ...] = ()
    restarts: NonNegativeCount
    seed: int
    seam_tolerance: NonNegative


class SettingsModel(ComparisonSettingsModel):
    """Everything that is needed to run a fit again; more settings may be added as further keys.

    Attributes:
        feature: name of the shape feature, "auto" where each panel has the cheapest that will do.
        composition: the patches of a feature that is not in the catalogue, as the program wrote them; else None.
        max_deviation: mm that no panel may deviate, where features are chosen automatically; else None.
        method: name of the method.
        energy, tau: of the method annealing, mm2 and mm.
        rules: for single panels and seams, as a file of rules has them; None without any.
        thickness: of the sheet, mm.
        joint: clear width between sheets that was asked for, mm; None in reports from before there was one: then
            nothing is said of sheets that overlap, either.
        ends: "square" where walls stand square to the sheet.
        skin_side: "outer" where the skin is the sheet's outer face.
        step_schema: of the STEP files.
        outputs: those that were asked for; None for all that need no asking.
        only: the panels that were asked for; all if empty.
        origin: "keep" where STEP files lie where the model does.
        k_factor: where the sheet keeps its lengths, a share of the thickness from the inner face of bends.
        chord: how far arcs in drawings may lie from the exact contour, mm.
        roll_pitch: largest distance between rulings, mm.
        dxf_entities, dxf_layers, dxf_contour_only, dxf_name_length: how drawings are made.
        density: of the material, kg/m3.
        stock: sheets of the store, mm.
        facet_height: of bends that are pressed, mm.
        mesh_chord: how far triangles may lie from exact faces, mm.
        mesh_colours: what colours of meshes tell.
        material, author, organization: as files name them; empty where they name none.
        fixings: of fixing holes the diameter, the largest pitch and the distance from edges, mm; None without.
        returns: of folded sides the length on the outer face and the inner radius, mm; None without.
    """

    feature: str
    composition: tuple[str, ...] | None = None
    max_deviation: Annotated[float, Field(gt=0.0)] | None = None
    method: Method
    energy: NonNegative | None = None
    tau: Annotated[float, Field(gt=0.0)] = 1e-3
    rules: dict[str, Any] | None = None
    thickness: NonNegative
    joint: NonNegative | None = None
    ends: Literal["bevel", "square"] = "bevel"
    skin_side: Literal["outer", "inner"]
    step_schema: Literal["AP242", "AP214"]
    outputs: tuple[str, ...] | None = None
    only: tuple[str, ...] = ()
    origin: Literal["local", "keep"] = "local"
    k_factor: NonNegative = 0.5
    chord: NonNegative = 0.01
    roll_pitch: NonNegative = 50.0
    dxf_entities: Literal["polyline", "lines"] = "polyline"
    dxf_layers: tuple[tuple[str, str], ...] = ()
    dxf_contour_only: bool = False
    dxf_name_length: NonNegativeCount = 80
    density: NonNegative = 2700.0
    stock: tuple[tuple[float, float], ...] = ()
    facet_height: NonNegative = 0.5
    mesh_chord: NonNegative = 0.5
    mesh_colours: Literal["feature", "deviation"] = "feature"
    material: str = ""
    author: str = ""
    organization: str = ""
    fixings: tuple[float, float, float] | None = None
    returns: tuple[float, float] | None = None

    def sheet(self) -> SheetSettings:
        """The settings of the sheet, as they were asked for."""
        return SheetSettings(
            thickness=self.thickness,
            joint=self.joint or 0.0,
            ends=self.ends,
            skin_side=self.skin_side,
            schema=self.step_schema,
        )

    def shop(self) -> ShopSettings:
        """The settings of the rest of the delivery, as they were asked for."""
        return ShopSettings(**{one.name: getattr(self, one.name) for one in fields(ShopSettings)})


def settings_record(
    reference: Reference, settings: FitSettings, sheet: SheetSettings, shop: ShopSettings | None = None
) -> SettingsModel:
    """The settings of one fit and its delivery."""
    feature = settings.feature
    composition = tuple(map(repr, feature.patches)) if isinstance(feature, PanelFeature) else None
    return SettingsModel.model_validate(
        {
            **_of_fit(reference, settings),
            "composition": composition,
            **_plain_fields(sheet),
            **_plain_fields(shop or ShopSettings()),
        }
    )


def comparison_settings_record(reference: Reference, settings: FitSettings) -> ComparisonSettingsModel:
    """The settings of all columns of a comparison."""
    record = _of_fit(reference, settings)
    return ComparisonSettingsModel.model_validate({key: record[key] for key in record if key not in OF_A_COLUMN})


def _of_fit(reference: Reference, settings: FitSettings) -> dict[str, object]:
    record = {
        "cadpanel_version": version("cadpanel"),
        **_plain_fields(settings),
        "seam_tolerance": reference.seam_tolerance,
    }
    if settings.weights is None:
        return {**record, "gaps": settings.gaps}
    return {**record, "gaps": {}, "gap_tolerance": None}


def _plain_fields(settings: Any) -> dict[str, object]:
    return {_KEYS.get(one.name, one.name): _plain(getattr(settings, one.name)) for one in fields(settings)}


def _plain(value: object) -> object:
    """A setting as JSON has it: features by their names, blends as they are asked for."""
    if isinstance(value, PanelFeature):
        return value.name
    if isinstance(value, Weights):
        return asdict(value)
    if isinstance(value, Rules):
        return value.plain()
    if isinstance(value, Blend):
        return str(value)
    return tuple(map(_plain, value)) if isinstance(value, tuple) else value
