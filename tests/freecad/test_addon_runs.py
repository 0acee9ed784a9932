"""The add-on's parts that need no FreeCAD: options from a report, rules of panels, cadpanel as a program."""

from __future__ import annotations

import json
import shlex
import sys
import time
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import typer

from cadpanel.cli import options
from cadpanel.cli.steps import steps
from cadpanel.delivery.records.from_fit import reference_record
from cadpanel.delivery.records.settings import settings_record
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.bends.asked import blends_of
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.freecad.addon import fits, runs
from cadpanel.freecad.addon.documents import DeliveryMissing, report_of
from cadpanel.reference.settings import ReferenceSettings
from tests.delivered import fitted

Settings = tuple[FitSettings, SheetSettings, ShopSettings]


def read_again(words: list[str]) -> Settings:
    """What `cadpanel fit` makes of options."""
    found: list[Settings] = []

    @options.made_of_settings
    def capture(settings: FitSettings, sheet: SheetSettings, shop: ShopSettings, how: ReferenceSettings) -> None:
        assert how.seam_tolerance == fitted().reference.seam_tolerance
        found.append((settings, sheet, shop))

    app = typer.Typer()
    app.command()(capture)
    app(args=words, standalone_mode=False)
    return found[0]


def told(settings: FitSettings, sheet: SheetSettings, shop: ShopSettings) -> dict[str, Any]:
    """A report's settings, as JSON has them."""
    reference = fitted().reference
    record = settings_record(reference, settings, sheet, shop).model_dump(mode="json")
    return {"settings": record, "reference": reference_record(reference).model_dump(mode="json")}


@pytest.mark.parametrize(
    "asked",
    [
        (FitSettings(), SheetSettings(), ShopSettings()),
        (
            FitSettings(
                feature="tri-cone",
                gap_tolerance=0.7,
                drift_along=0.03,
                evenness=0.0031,
                blend=blends_of("N 1=20-40%"),
                seed=3,
            ),
            SheetSettings(thickness=2.5, joint=7.0, skin_side="inner", schema="AP214"),
            ShopSettings(
                outputs="step,freecad",
                only='N 1,"a, b"',
                stock=[(1500.0, 3000.0), (2000.5, 4000.0)],
                dxf_layers=[("CUT", "0"), ("BEND", "my bends")],
                dxf_contour_only=True,
                density=7850.0,
            ),
        ),
        (FitSettings(weights=Weights(gap=2.0, deviation=1.0, drift=0.5)), SheetSettings(), ShopSettings()),
    ],
)
def test_the_options_of_a_delivery_make_its_settings_again(asked: Settings) -> None:
    line = fits.quoted(fits.options_of(told(*asked)))
    again = told(*read_again(shlex.split(line)))
    wanted = told(*asked)
    # What was left to itself is told as what became of it, which asks for the same.
    gaps = ("gap_tolerance", "joint_tolerance", "step", "shift")
    for record in (again["settings"], wanted["settings"]):
        for name in gaps:
            del record[name]
    assert again == wanted


def test_what_the_options_of_cutting_say_is_told_as_they_want_it() -> None:
    report = told(FitSettings(), SheetSettings(), ShopSettings())
    report["reference"]["reading"] = {
        "grid": [4, 6],
        "faces": "2-3,layer=Skin",
        "junctions": True,
        "seam_tolerance": 2.0,
    }
    words = fits.options_of(report)
    assert words[words.index("--grid") + 1] == "4x6"
    assert words[words.index("--faces") + 1] == "2-3,layer=Skin"
    assert "--junctions" in words
    assert words[words.index("--seam-tolerance") + 1] == "2.0"
    assert words.count("--seam-tolerance") == 1


def test_a_feature_that_a_program_made_is_refused() -> None:
    report = told(FitSettings(), SheetSettings(), ShopSettings())
    report["settings"]["composition"] = ["Plane()"]
    with pytest.raises(DeliveryMissing, match="made by a program"):
        fits.options_of(report)


def a_panel(name: str, feature: str, wanted: str) -> SimpleNamespace:
    """As the add-on sees it in FreeCAD."""
    return SimpleNamespace(PanelName=name, Feature=feature, WantedFeature=wanted, PropertiesList=["WantedFeature"])


def test_rules_are_those_of_the_delivery_and_of_the_panels_that_were_changed_since(tmp_path: Path) -> None:
    folds, cone = "plane-cone-plane", "cone"
    panels = [
        a_panel('N "1"', folds, cone),  # changed
        a_panel("Süd-02", cone, cone),  # by a rule
        a_panel("Süd-03", cone, folds),  # by a rule, and changed back
        a_panel("N-4", folds, folds),
    ]
    lock: dict[str, Any] = {"panels": ["N-4"], "corners": [0, 1], "within": 1e-05}
    given: dict[str, Any] = {"feature": [{"panels": ["Süd-*"], "feature": cone}], "lock": [lock]}
    report = {"settings": {"feature": folds, "rules": given}}
    rules = fits.rules_of(SimpleNamespace(Objects=panels), report)
    fits.write_rules(str(tmp_path / "rules.toml"), rules)
    told = tomllib.loads((tmp_path / "rules.toml").read_text(encoding="utf-8"))
    assert told["lock"] == [lock]
    assert {table["panels"][0]: table["feature"] for table in told["feature"]} == {'N "1"': cone, "Süd-02": cone}
    assert given["feature"][0]["panels"] == ["Süd-*"]
    untouched = SimpleNamespace(Objects=panels[3:])
    assert fits.rules_of(untouched, {"settings": {"feature": folds}}) == {}


def test_a_fit_is_asked_for_as_on_the_command_line() -> None:
    words = fits.arguments_of("a b.step", "out", "--divide 3", "rules.toml")
    assert words == ["fit", "a b.step", "--out", "out", "--tell-steps", "--divide", "3", "--rules", "rules.toml"]


def test_the_reference_is_looked_for_above_the_delivery(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b" / "c" / "delivery"
    folder.mkdir(parents=True)
    assert fits.reference_near(str(folder), "lip.step") is None
    (tmp_path / "a" / "lip.step").touch()
    assert fits.reference_near(str(folder), "lip.step") == str((tmp_path / "a" / "lip.step").resolve())


def test_a_folder_that_is_no_delivery_is_told(tmp_path: Path) -> None:
    with pytest.raises(DeliveryMissing, match="cannot be read"):
        report_of(str(tmp_path))
    (tmp_path / "report.json").write_text('{"schema": "other"}', encoding="utf-8")
    with pytest.raises(DeliveryMissing, match="is not a report of cadpanel"):
        report_of(str(tmp_path))


def test_a_program_that_refuses_is_heard(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(runs, "interpreter", lambda: sys.executable)
    run = runs.Run(fits.arguments_of(str(tmp_path / "none.step"), str(tmp_path / "out"), ""))
    began = time.monotonic()
    while (code := run.look()) is None:
        assert time.monotonic() - began < 60.0
        time.sleep(0.05)
    assert code == 2
    assert "none.step" in run.sentence
    assert run.step["step"] == "Read reference"
    assert run.share is None
    run.cancel()  # nothing is left to be ended


def test_a_python_that_nobody_told_or_that_is_gone_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(runs, "__file__", str(tmp_path / "runs.py"))
    with pytest.raises(runs.CadpanelMissing, match="run 'cadpanel freecad install'"):
        runs.interpreter()
    (tmp_path / runs.INTERPRETER).write_text(json.dumps({"python": str(tmp_path / "gone")}), encoding="utf-8")
    with pytest.raises(runs.CadpanelMissing, match="is gone: run 'cadpanel freecad install' again"):
        runs.interpreter()
    (tmp_path / runs.INTERPRETER).write_text(json.dumps({"python": sys.executable}), encoding="utf-8")
    assert runs.interpreter() == sys.executable


def test_steps_are_told_as_lines_for_programs(capsys: pytest.CaptureFixture[str]) -> None:
    with steps(quiet=True, told=True) as shown:
        shown.begin("Read reference", "a.step")
        shown.solving("Fit all at once", 4, 1.25, 5.5)
        shown.count("build", 3, 8)
    lines = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
    assert lines[0] == {"step": "Read reference", "done": 0, "of": 1, "detail": "a.step"}
    assert lines[2]["step"] == "Fit all at once"
    assert lines[2]["detail"].startswith("step 4: worst gap or drift at 1.25 x its limit")
    assert lines[-1] == {"step": "Build solids", "done": 3, "of": 8, "detail": ""}
