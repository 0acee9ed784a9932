"""Every list of settings names the same ones: fields, keywords, records and options."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import MISSING, asdict, fields, replace
from fractions import Fraction
from inspect import signature
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from cadpanel.cli.compare import compare
from cadpanel.cli.fit import fit
from cadpanel.cli.inspect import inspect
from cadpanel.cli.study import study
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.records.comparison import read_comparison, write_comparison
from cadpanel.delivery.records.from_fit import reference_record
from cadpanel.delivery.records.report import ReferenceModel, read_report
from cadpanel.delivery.records.settings import OF_A_COLUMN, ComparisonSettingsModel, SettingsModel, settings_record
from cadpanel.delivery.records.table1 import comparison_record
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopKeywords, ShopSettings
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Plane
from cadpanel.fitting.bends.asked import Blend
from cadpanel.fitting.run import fit as fit_reference
from cadpanel.fitting.settings import FitKeywords, FitSettings, Weights
from cadpanel.reference.settings import ReferenceKeywords, ReferenceSettings
from cadpanel.setting import options_of
from cadpanel.terms.limits.catalogue import LIMITS
from tests.delivered import strip

# What a command has besides settings.
OF_THE_COMMAND = {"out", "overwrite", "quiet", "verbose", "time_limit", "tell_steps"}
# What a record has besides settings: who wrote it, and what a feature is that has no name in the catalogue.
OF_THE_RECORD = {"cadpanel_version", "composition"}
# The one setting of the reading that stands among the others; the rest is under reference.reading, where it was given.
OF_THE_READING = {"seam_tolerance"}
# The report calls it by another name, as it has a schema of its own.
SCHEMA = "step_schema"


def names(settings: type[Any]) -> set[str]:
    return {one.name for one in fields(settings)}


FIT, READ, SHEET, SHOP = map(names, (FitSettings, ReferenceSettings, SheetSettings, ShopSettings))


ALL_SETTINGS = (FitSettings, ReferenceSettings, SheetSettings, ShopSettings)
NUMBERS_WITHOUT_A_DEFAULT = {
    *("max_deviation", "gap_tolerance", "joint_tolerance", "step", "shift", "energy", "panel_length", "lip"),
}


def options(command: Callable[..., None]) -> set[str]:
    return set(signature(command).parameters)


@pytest.mark.parametrize("settings", [FitSettings, ReferenceSettings, SheetSettings, ShopSettings])
def test_every_setting_says_how_it_is_asked_for(settings: type[Any]) -> None:
    for field, option in options_of(settings):
        assert option.help.endswith((".", "?", "...")), field.name
        assert field.default is not MISSING


@pytest.mark.parametrize("settings", ALL_SETTINGS)
def test_numbers_of_any_kind_make_the_same_setting(settings: type[Any]) -> None:
    for one in fields(settings):
        usual = one.default
        if one.name in NUMBERS_WITHOUT_A_DEFAULT:
            usual = 2.0
        elif isinstance(usual, bool) or not isinstance(usual, int | float):
            continue
        for kind in (np.float64, np.int64, int, Fraction):
            if kind(usual) != usual or (isinstance(usual, int) and kind in (np.float64, Fraction)):
                continue
            kept = getattr(settings(**{"divide": 3} if one.name == "lip" else {}, **{one.name: kind(usual)}), one.name)
            assert (type(kept), kept) == (type(usual), usual), one.name


def test_weights_of_any_kind_are_the_same_weights() -> None:
    kept = Weights(gap=1, deviation=np.float32(1.0), drift=np.int64(1))  # type: ignore[arg-type] # as users may
    assert {type(value) for value in asdict(kept).values()} == {float}


def test_the_number_of_panels_is_a_whole_number_of_pythons() -> None:
    assert type(ReferenceSettings(divide=np.int64(4)).divide) is int  # type: ignore[arg-type] # as users may


def test_keywords_are_the_fields() -> None:
    assert set(FitKeywords.__annotations__) == FIT
    assert set(ReferenceKeywords.__annotations__) == READ
    assert set(ShopKeywords.__annotations__) == SHOP


def test_the_limits_that_can_be_set_are_fields_with_their_defaults() -> None:
    usual = FitSettings()
    assert {limit.name for limit in LIMITS if limit.asked} <= FIT
    assert usual.allowed == {limit.name: limit.default for limit in LIMITS}
    assert len(usual.allowed) == len(LIMITS)
    assert len({row.key for limit in LIMITS for row in limit.rows}) == sum(len(limit.rows) for limit in LIMITS)


def test_the_reports_settings_are_those_of_the_fit_and_of_the_sheet() -> None:
    sheet = SHEET - {"schema"} | {SCHEMA}
    assert set(SettingsModel.model_fields) == FIT | sheet | SHOP | OF_THE_RECORD | OF_THE_READING | {"gaps"}


def test_the_comparisons_settings_are_those_that_all_columns_share() -> None:
    shared = FIT - set(OF_A_COLUMN) | OF_THE_READING | {"cadpanel_version", "gaps"}
    assert set(ComparisonSettingsModel.model_fields) == shared


def test_the_options_are_the_settings() -> None:
    assert options(fit) == FIT | READ | SHEET | SHOP | OF_THE_COMMAND | {"reference"}
    assert options(compare) == options(fit) - SHEET - SHOP - set(OF_A_COLUMN) - {"verbose", "time_limit", "tell_steps"}
    assert options(study) == options(compare) - {"weights"} | {"feature", "max_deviation"}
    assert options(inspect) == {"file", "unit", "faces", "seam_tolerance", "as_json"}


ASKED = FitSettings(
    tilt="fixed",
    method="two_stage",
    gap_tolerance=3.0,
    drift_along=0.04,
    drift_across=0.015,
    min_radius=25.0,
    blend=(Blend(first=40.0, last=60.5, percent=True), Blend(first=500.0, last=900.0, panel="N 2")),
    rules={"feature": [{"panels": "N 2", "feature": "plane-cylinder-plane"}]},  # type: ignore[arg-type] # as users may
    restarts=1,
    seed=7,
)


def asked_again(record: ComparisonSettingsModel) -> FitSettings:
    """The settings that a record tells of, by its keys alone; with weights there was no tolerance."""
    told = {name: getattr(record, name) for name in FIT if hasattr(record, name)}
    if record.weights is not None:
        told |= {"weights": Weights(**record.weights.model_dump())}
    return FitSettings(**told)


@pytest.mark.parametrize(
    "settings",
    [ASKED, FitSettings(weights=Weights(gap=3.0), seed=1), FitSettings(feature="auto", max_deviation=4.0)],
    ids=["everything", "weights", "auto"],
)
def test_settings_are_read_back_from_a_comparison_as_they_were_asked_for(tmp_path: Path, settings: FitSettings) -> None:
    write_comparison(comparison_record(strip(), settings, ()), tmp_path / "compare.json")
    read = asked_again(read_comparison(tmp_path / "compare.json").settings)
    for name in FIT - set(OF_A_COLUMN):
        assert getattr(read, name) == getattr(settings, name), name


def test_a_fit_is_run_again_from_its_report_with_the_same_numbers(tmp_path: Path) -> None:
    sheet = SheetSettings(thickness=2.0, skin_side="inner", schema="AP214", ends="square")
    shop = ShopSettings(
        outputs="flats", only="N 2", k_factor=0.4, stock=[(3000.0, 6000.0)], dxf_layers=[("CUT", "0")], density=7850.0
    )
    for name in ("first", "again"):
        settings = ASKED if name == "first" else asked_again(read_report(tmp_path / "first" / "report.json").settings)
        assert settings == ASKED
        deliver(fit_reference(strip(), settings), tmp_path / name, sheet, shop)
    first, again = (json.loads((tmp_path / name / "report.json").read_text("utf-8")) for name in ("first", "again"))
    assert first.pop("timing") != again.pop("timing")
    assert first == again
    kept = read_report(tmp_path / "again" / "report.json").settings
    assert (kept.sheet(), kept.shop()) == (sheet, shop)


@pytest.mark.parametrize(
    "settings",
    [
        ReferenceSettings(),
        ReferenceSettings(divide=9, lip=200.0, unit="m", faces=("1-3", "layer=Skin, north"), seam_tolerance=0.5),
        ReferenceSettings(panel_length=1500.0, seams="conjugate", cut_turn=12.0),
        ReferenceSettings(grid=(20, 10), by="parameter", junctions=True),
        ReferenceSettings(panel_size=(1500.0, 800.0)),
        ReferenceSettings(stations=(1200.0, 2400.0), spine=Path("spine.step")),
        ReferenceSettings(network=Path("curves.3dm")),
        ReferenceSettings(mesh=Path("roof.obj")),
    ],
    ids=lambda settings: settings.way or "whole",
)
def test_how_a_reference_was_read_is_read_back_from_the_record(settings: ReferenceSettings) -> None:
    record = reference_record(replace(strip(), settings=settings))
    reading = ReferenceModel.model_validate_json(record.model_dump_json()).reading
    assert ReferenceSettings(**cast("dict[str, Any]", reading)) == settings


def test_a_composed_feature_is_told_by_its_patches() -> None:
    composed = Feature(Plane(width=200.0), Cone(), Plane(), name="bracket")
    record = settings_record(strip(), FitSettings(feature=composed), SheetSettings())
    assert record.feature == "bracket"
    assert record.composition == tuple(map(repr, composed.patches))
