"""The settings of a fit as report.json and compare.json hold them: enough to run it again with the same numbers."""

from __future__ import annotations

from dataclasses import asdict, fields
from importlib.metadata import version
from typing import Annotated, Any, Literal

from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegative, NonNegativeCount, Record, with_keys
from cadpanel.delivery.settings import SheetSettings
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.bends.asked import Blend
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.reference.model import Reference
from cadpanel.terms.limits.catalogue import LIMITS

OF_A_COLUMN = ("feature", "max_deviation", "method")
"""The settings of a fit that a comparison chooses itself, for each column its own."""
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
        gap_tolerance: largest gap allowed between neighbours, mm; None where weights ruled instead.
        weights: the weights, or None where a tolerance was held.
        drift_along: how far a corner might move along its free edge, a share of the panel's length.
        drift_across: the same across its free edge.
        min_radius: tightest radius that was allowed anywhere, mm.
        blend: which stretches were to become curved patches, where the user said so.
        restarts: further starts.
        seed: of the random numbers.
        seam_tolerance: how far the ends of two panels that meet might lie apart in the reference, mm.
    """

    cadpanel_version: str
    tilt: Literal["free", "fixed"]
    gap_tolerance: Annotated[float, Field(gt=0.0)] | None
    weights: WeightsModel | None
    drift_along: NonNegative
    drift_across: NonNegative
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
        thickness: of the sheet, mm.
        joint: clear width between sheets that was asked for, mm; None in reports from before there was one: then
            nothing is said of sheets that overlap, either.
        skin_side: "outer" where the skin is the sheet's outer face.
        step_schema: of the STEP files.
    """

    feature: str
    composition: tuple[str, ...] | None = None
    max_deviation: Annotated[float, Field(gt=0.0)] | None = None
    method: str
    thickness: NonNegative
    joint: NonNegative | None = None
    skin_side: Literal["outer", "inner"]
    step_schema: Literal["AP242", "AP214"]


def settings_record(reference: Reference, settings: FitSettings, sheet: SheetSettings) -> SettingsModel:
    """The settings of one fit and its delivery."""
    feature = settings.feature
    composition = tuple(map(repr, feature.patches)) if isinstance(feature, PanelFeature) else None
    return SettingsModel.model_validate(
        {**_of_fit(reference, settings), "composition": composition, **_plain_fields(sheet)}
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
    return record if settings.weights is None else {**record, "gap_tolerance": None}


def _plain_fields(settings: Any) -> dict[str, object]:
    return {_KEYS.get(one.name, one.name): _plain(getattr(settings, one.name)) for one in fields(settings)}


def _plain(value: object) -> object:
    """A setting as JSON has it: features by their names, blends as they are asked for."""
    if isinstance(value, PanelFeature):
        return value.name
    if isinstance(value, Weights):
        return asdict(value)
    if isinstance(value, Blend):
        return str(value)
    return tuple(map(_plain, value)) if isinstance(value, tuple) else value
