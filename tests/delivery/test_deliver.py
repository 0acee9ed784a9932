"""From a fit to a folder: what is built, what the report says of it, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cadpanel.arrays import Array
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.from_fit import panel_records
from cadpanel.delivery.records.from_shape import patch_models
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel, PlanePatchModel
from cadpanel.delivery.records.to_shape import recorded_shapes
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import DeliveryError, PanelError, SettingsError
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.run import fit
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape
from fixtures.arrays import reference
from tests.delivered import STRAIGHT, fitted, fitted_alone, strip
from tests.known_panels import moved
from tests.shapes import random_panel


# ------------------------------------------------------------------------------------------------------------- patches
def distances(model: PlanePatchModel | ConePatchModel | CylinderPatchModel, points: Array) -> Array:
    """Written out from the definitions, apart from the package's own code."""
    if isinstance(model, PlanePatchModel):
        return np.asarray((points - np.array(model.point)) @ np.array(model.normal))
    axis = np.array(model.axis)
    start = np.array(model.apex if isinstance(model, ConePatchModel) else model.axis_point)
    height = (points - start) @ axis
    radius = np.linalg.norm(points - start - np.outer(height, axis), axis=1)
    if isinstance(model, CylinderPatchModel):
        return np.asarray(radius - model.radius_min)
    assert (height > 0.0).all(), "the axis points from the apex towards the patch"
    return np.asarray(radius - height * math.tan(math.radians(model.half_angle)))


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("chain", ["plane-cone-plane", "plane-cone-cone-plane", "cone-plane-cone"])
@pytest.mark.parametrize("concave", [False, True])
def test_the_reported_surfaces_pass_through_the_corners(seed: int, chain: str, concave: bool) -> None:
    shape = random_panel(seed, chain=chain, concave=concave)
    corners = shape.corners()
    for index, model in enumerate(patch_models(shape)):
        points = corners[:, index : index + 2].reshape(-1, 3)
        assert np.abs(distances(model, points)).max() < 1e-6


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("half_angle", [-0.02, 0.0, 0.02])
def test_the_sweep_turns_one_ruling_into_the_next_about_the_reported_axis(seed: int, half_angle: float) -> None:
    shape = random_panel(seed, half_angle=half_angle)
    model = patch_models(shape)[1]
    assert not isinstance(model, PlanePatchModel)
    assert model.kind == ("cylinder" if half_angle == 0.0 else "cone")
    axis, angle = np.array(model.axis), math.radians(model.sweep)
    before, after = shape.normals[1], shape.normals[2]
    turned = (
        math.cos(angle) * before
        + math.sin(angle) * np.cross(axis, before)
        + (1.0 - math.cos(angle)) * (axis @ before) * axis
    )
    assert turned == pytest.approx(after, abs=1e-12)


def test_radii_bound_those_of_the_corners() -> None:
    shape = random_panel(3, half_angle=0.03)
    model = patch_models(shape)[1]
    assert isinstance(model, ConePatchModel)
    points = shape.corners()[:, 1:3].reshape(-1, 3) - np.array(model.apex)
    radii = np.linalg.norm(points - np.outer(points @ np.array(model.axis), np.array(model.axis)), axis=1)
    assert model.radius_min <= radii.min() + 1e-6
    assert model.radius_max >= radii.max() - 1e-6


# -------------------------------------------------------------------------------------------------------------- build
def slender(shape: PanelShape) -> PanelShape:
    return random_panel(1, half_angle=1e-6, name=shape.name)


def test_a_slender_cone_is_built_and_reported_as_a_cylinder_with_a_note() -> None:
    (built,) = build_panels([random_panel(1, half_angle=1e-6)], SheetSettings()).panels
    assert [model.kind for model in patch_models(built.shape)] == ["plane", "cylinder", "plane"]
    assert 0.0 < built.moved < 0.02
    assert "built as a cylinder" in built.notes[0]


def test_a_delivery_with_slender_cones_holds_its_proof(tmp_path: Path) -> None:
    result = fitted()
    curved = [patch for patch in result.shapes[1].patches if isinstance(patch, ConePatch)]
    assert curved
    lone = replace(result.reference, panels=result.reference.panels[:1], seams=())
    chain = result.shapes[0]
    assert isinstance(chain, PanelShape)
    shapes = (slender(chain),)
    one = replace(result, reference=lone, shapes=shapes, measures=measure(shapes, lone))
    report = deliver(one, tmp_path / "out")
    assert report.certificate.face_kinds["cylinder"] == 2
    assert report.panels[0].notes
    assert verify(tmp_path / "out").holds


def test_one_panel_that_cannot_be_built_stops_everything_by_name(tmp_path: Path) -> None:
    result = fitted()
    with pytest.raises(PanelError, match="Panel 'N "):
        deliver(result, tmp_path / "out", SheetSettings(thickness=2000.0))
    assert list(tmp_path.iterdir()) == []


# ------------------------------------------------------------------------------------------------------------ settings
@pytest.mark.parametrize("thickness", [math.nan, math.inf, 0.0, -3.0])
def test_a_thickness_that_is_none_is_refused(thickness: float) -> None:
    with pytest.raises(SettingsError, match="sheet thickness"):
        SheetSettings(thickness=thickness)


# ------------------------------------------------------------------------------------------------------------ delivery
def test_the_same_fit_gives_the_same_bytes_at_the_same_date(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    for name in ("one", "two"):
        deliver(fitted(), tmp_path / name)
    for file in (PANELS, SKINS):
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "two" / file).read_bytes()


def test_the_steps_are_told_in_their_order(tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    deliver(fitted(), tmp_path / "out", progress=lambda *step: told.append(step))
    assert [step for step, done, _ in told if done == 0] == ["compare", "build", "write", "verify"]
    assert all(done <= of for _, done, of in told)


def test_proving_tells_how_many_solids_skins_sheets_and_outputs_are_looked_at(tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    deliver(fitted(), tmp_path / "out", shop=ShopSettings(outputs=("step", "flats")))
    verify(tmp_path / "out", progress=lambda *step: told.append(step))
    assert {step for step, _, _ in told} == {"verify"}
    counts = [done for _, done, _ in told]
    assert counts == sorted(counts)
    parts = len(fitted().shapes) * (1 + 1 + 1 + 1)  # a flat pattern, a solid, a skin, a sheet that is built anew
    assert told[-1] == ("verify", parts, parts)
    assert len(told) > 2


def test_an_existing_folder_is_refused_unless_it_may_be_replaced(tmp_path: Path) -> None:
    deliver(fitted(), tmp_path / "out")
    with pytest.raises(DeliveryError, match="exists already"):
        deliver(fitted(), tmp_path / "out")
    report = deliver(fitted_alone(), tmp_path / "out", overwrite=True)
    assert not report.summary.tolerance_met
    assert report.settings.method == "local"


def test_the_report_agrees_with_itself_and_with_the_fit(tmp_path: Path) -> None:
    report = deliver(fitted(), tmp_path / "out")
    assert check_report(report, recorded_shapes(report), report.certificate) == ()
    measures = fitted().measures
    assert report.summary.rms_deviation == measures.overall_rms
    assert report.summary.max_corner_drift == measures.drift.max()
    assert report.summary.max_kink == pytest.approx(math.degrees(measures.kink.max()))
    assert report.baselines.local.local_rms_multiple == 1.0
    assert report.certificate.max_seam_gap == pytest.approx(measures.max_seam_gap, abs=1e-5)
    assert (tmp_path / "out" / REPORT).is_file()


def test_a_strip_of_all_but_cylinders_holds_its_proof(tmp_path: Path) -> None:
    """Apexes lie kilometres away there; their numbers must still say where the panel is."""
    result = fit(reference(STRAIGHT))
    report = deliver(result, tmp_path / "out")
    assert report.summary.max_seam_gap < 0.05
    assert verify(tmp_path / "out").holds


def test_an_outline_that_leaves_the_drawings_between_its_corners_is_noted() -> None:
    result = fitted()
    quiet = panel_records(result, build_panels(result.shapes, SheetSettings()))
    assert not any("Between its corners" in note for panel in quiet for note in panel.notes)
    far = replace(result.measures, hausdorff=result.measures.hausdorff + np.array([0.0, 500.0, 0.0]))
    noted = panel_records(replace(result, measures=far), build_panels(result.shapes, SheetSettings()))
    assert [any("Between its corners" in note for note in panel.notes) for panel in noted] == [False, True, False]


def test_a_run_that_misses_gaps_and_drifts_names_both() -> None:
    result = fitted()
    gaping = replace(result.measures, seam_step=result.measures.seam_step + 7.0)
    both = replace(gaping, drift_across=result.measures.drift_across + 300.0)
    sentences = [replace(result, measures=m, tolerance_met=False).shortfall() or "" for m in (gaping, both)]
    assert ["the drift limits are not met" in sentence for sentence in sentences] == [False, True]
    assert all("the step of 3 mm is not met" in sentence for sentence in sentences)
    assert "choose another feature" in sentences[1]


def test_a_delivery_hundreds_of_metres_from_the_origin_holds_its_proof(tmp_path: Path) -> None:
    """What is written down of it loses its last digit, and can be built anew all the same."""
    away = moved(strip(), np.eye(3), np.array([600_000.0, -80_000.0, 9000.0]))
    deliver(fit(away), tmp_path / "out", shop=ShopSettings(outputs=("step",)))
    assert verify(tmp_path / "out").holds
