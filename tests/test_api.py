"""The names that a Python program uses, from `import cadpanel as cp`."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import build123d as bd
import cadquery as cq
import pytest

import cadpanel as cp
from cadpanel.api_sheets import shapes_of
from cadpanel.brep.building.mass_properties import volume_and_centroid
from cadpanel.brep.step.file import read_step_shapes
from tests.delivered import fitted, strip
from tests.instances import random_polygon
from tests.thorough import thorough


def test_keywords_change_the_settings_that_are_given() -> None:
    result = cp.fit(strip(), cp.FitSettings(gap_tolerance=2.0, seed=3), method="local")
    assert (result.settings.gap_tolerance, result.settings.seed, result.settings.method) == (2.0, 3, "local")


def test_a_setting_that_is_none_is_a_settings_error() -> None:
    with pytest.raises(cp.SettingsError, match="gap tolerance"):
        cp.fit(strip(), gap_tolerance=float("nan"))


def test_solids_are_the_kernels_own() -> None:
    shape = fitted().shape("N 2")
    assert type(cp.build_solid(shape, 3.0)).__name__ == "TopoDS_Solid"
    assert type(cp.build_skin(shape)).__name__ == "TopoDS_Shell"


def test_cadquery_gets_one_solid_a_panel() -> None:
    panels = cp.to_cadquery(fitted(), thickness=4.0)
    assert isinstance(panels, cq.Workplane)
    assert [type(solid) for solid in panels.vals()] == [cq.Solid] * 3
    one = cp.to_cadquery(fitted().shapes[1], thickness=4.0)
    # Alone it has no neighbours to be cut back from.
    assert one.val().Volume() == pytest.approx(panels.vals()[1].Volume(), rel=1e-4)
    narrow = cp.to_cadquery(fitted(), thickness=4.0, joint=200.0)
    assert narrow.vals()[1].Volume() == pytest.approx(0.9 * one.val().Volume(), rel=0.02)


def test_several_shapes_are_built_like_one_and_none_is_refused(tmp_path: Path) -> None:
    first, second, _ = fitted().shapes
    assert [*shapes_of(first)] == [*shapes_of([first])] == [first]
    assert len(cp.to_cadquery([first, second]).vals()) == 2
    assert [child.label for child in cp.to_build123d((first, second)).children] == [first.name, second.name]
    cp.write_step([second, first], tmp_path / "two.step", panels=[first.name])
    assert [name for name, _ in read_step_shapes(tmp_path / "two.step")] == [first.name]
    with pytest.raises(cp.SettingsError, match="no panel in the list"):
        cp.to_cadquery([])


@thorough
def test_solids_are_made_as_a_delivery_makes_them(tmp_path: Path) -> None:
    made: dict[str, Any] = {"ends": "square", "fixings": (6.5, 450.0, 40.0), "returns": (30.0, 3.0)}
    report = cp.deliver(fitted(), tmp_path / "out", joint=10.0, outputs="step", **made)
    volumes = [panel.volume for panel in report.panels]
    solids = cp.to_cadquery(fitted(), joint=10.0, **made).vals()
    assert [solid.Volume() for solid in solids] == pytest.approx(volumes, rel=1e-9)
    children = cp.to_build123d(fitted(), joint=10.0, **made).children
    assert [child.volume for child in children] == pytest.approx(volumes, rel=1e-9)
    cp.write_step(fitted(), tmp_path / "solids.step", joint=10.0, **made)
    written = [volume_and_centroid(shape)[0] for _, shape in read_step_shapes(tmp_path / "solids.step")]
    assert written == pytest.approx(volumes, rel=1e-9)
    with pytest.raises(cp.SettingsError, match="no setting 'thicknes'; perhaps 'thickness' is meant"):
        cp.to_cadquery(fitted(), thicknes=4.0)  # type: ignore[call-arg]


def test_build123d_gets_named_children_and_a_part() -> None:
    facade = cp.to_build123d(fitted())
    assert isinstance(facade, bd.Compound)
    assert [child.label for child in facade.children] == ["N 1", "N 2", "N 3"]
    part = cp.to_build123d(fitted().shapes[0])
    assert isinstance(part, bd.Part)
    assert part.label == "N 1"
    assert part.volume == pytest.approx(facade.children[0].volume, rel=1e-4)
    assert cp.to_build123d(fitted(), joint=20.0).volume < facade.volume


def test_solids_and_skins_are_written_with_their_names(tmp_path: Path) -> None:
    cp.write_step(fitted(), tmp_path / "solids.step", thickness=3.0)
    cp.write_step(fitted(), tmp_path / "skins.step", skins=True)
    cp.write_step(fitted().shapes[1], tmp_path / "one.step")
    for name, expected in (("solids", ["N 1", "N 2", "N 3"]), ("skins", ["N 1", "N 2", "N 3"]), ("one", ["N 2"])):
        assert [product for product, _ in read_step_shapes(tmp_path / f"{name}.step")] == expected


def test_a_delivery_is_written_and_verified(tmp_path: Path) -> None:
    report = cp.deliver(fitted(), tmp_path / "out", thickness=2.0, skin_side="inner", schema="AP214")
    assert (report.settings.thickness, report.settings.skin_side) == (2.0, "inner")
    verification = cp.verify(tmp_path / "out")
    assert isinstance(verification, cp.Verification)
    assert verification.holds


def test_a_comparison_is_written_where_asked_and_only_there(tmp_path: Path) -> None:
    comparison = cp.compare(strip(), gap_tolerance=20.0, out=tmp_path / "out")
    assert len(comparison.columns) == 4
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["compare.json", "manifest.json", "out"]


def test_every_error_is_a_cadpanel_error() -> None:
    errors = (cp.ReferenceFileError, cp.PanelError, cp.SettingsError, cp.DeliveryError, cp.ProofError)
    assert all(issubclass(error, cp.CadpanelError) for error in errors)


def test_a_polygon_is_built_written_and_handed_over_like_any_other_panel(tmp_path: Path) -> None:
    shape = random_polygon(3, 6)
    assert type(cp.build_solid(shape, 3.0)).__name__ == "TopoDS_Solid"
    assert type(cp.build_skin(shape)).__name__ == "TopoDS_Shell"
    volume = cp.to_cadquery(shape, thickness=2.0).val().Volume()
    part = cp.to_build123d(shape, thickness=2.0)
    assert part.label == shape.name
    assert part.volume == pytest.approx(volume, rel=1e-12)
    cp.write_step(shape, tmp_path / "one.step", skins=True)
    assert [product for product, _ in read_step_shapes(tmp_path / "one.step")] == [shape.name]


def test_a_file_that_is_not_there_cannot_be_fitted() -> None:
    with pytest.raises(cp.ReferenceFileError, match=r"'file\.step' does not exist"):
        cp.fit("file.step")


@pytest.mark.parametrize("thickness", ["3", None, True])
def test_a_thickness_that_is_no_number_is_refused(thickness: object) -> None:
    with pytest.raises(cp.SettingsError, match=r"'thickness' of build_solid\(\) must be a number, not"):
        cp.build_solid(fitted().shape("N 2"), cast("float", thickness))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda of: cp.fit(of, cast(Any, cp.ReferenceSettings())),
            r"'settings' of fit\(\) must be FitSettings or None, not ReferenceSettings",
        ),
        (
            lambda of: cp.fit(of, cast(Any, {"seed": 1})),
            "must be FitSettings or None, not {'seed': 1}",
        ),
        (lambda _: cp.fit(cast(Any, None)), "must be Reference or a path, not None"),
        (lambda _: cp.compare(cast(Any, None)), r"of compare\(\) must be Reference or a path, not None"),
        (
            lambda _: cp.read("a.step", cast(Any, cp.FitSettings())),
            "must be ReferenceSettings or None, not FitSettings",
        ),
    ],
)
def test_what_is_of_another_kind_is_a_settings_error(call: Any, words: str) -> None:
    with pytest.raises(cp.SettingsError, match=words):
        call(strip())


def test_a_comparison_refuses_its_folder_before_it_fits(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine", encoding="utf-8")
    told: list[object] = []
    with pytest.raises(cp.DeliveryError, match="exists already"):
        cp.compare(strip(), out=tmp_path, progress=lambda *step: told.append(step))
    assert told == []
