"""A delivery holds what the catalogue of outputs says, and a new output is written and demanded like the old ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery import deliver as delivering
from cadpanel.delivery import verify as verifying
from cadpanel.delivery.manifest import MANIFEST
from cadpanel.delivery.outputs.catalogue import OUTPUTS, chosen_outputs
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.delivery.own_files import (
    COMPARISON,
    JOB,
    LOFT_FILES,
    OWN_FILES,
    OWN_FOLDERS,
    REPORT,
    STUDY,
    STUDY_PLOTS,
    STUDY_TABLE,
)
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError, SettingsError
from tests.delivered import fitted


class NameList(Output):
    """The panels' names, one a line."""

    name = "names"
    files = ("names.txt",)
    always = True

    def write(self, folder: Path, delivery: Delivery) -> None:
        lines = [f"{delivery.title} {delivery.sheet.thickness:g}", *(panel.shape.name for panel in delivery.panels)]
        (folder / "names.txt").write_text("\n".join(lines), encoding="utf-8")


def test_outputs_have_names_and_files_of_their_own() -> None:
    files = [file for output in OUTPUTS for file in (*output.files, *output.folders)]
    assert len({output.name for output in OUTPUTS}) == len(OUTPUTS)
    assert len(set(files)) == len(files)
    others = {REPORT, COMPARISON, MANIFEST, STUDY, STUDY_TABLE, JOB, *STUDY_PLOTS, *LOFT_FILES}
    assert not others & set(files)
    assert others | set(files) == OWN_FILES | OWN_FOLDERS.keys()


@pytest.mark.parametrize("asked", [None, ("step",), ("flats",), ("xlsx", "schedule")])
def test_a_delivery_holds_the_report_what_is_always_there_and_what_was_asked_for(
    tmp_path: Path, asked: tuple[str, ...] | None
) -> None:
    delivering.deliver(fitted(), tmp_path / "out", shop=ShopSettings(outputs=asked))
    wanted = [
        file
        for output in OUTPUTS
        if output.always or (output.unasked if asked is None else output.name in asked)
        for file in (*output.files, *output.folders)
    ]
    assert {path.name for path in (tmp_path / "out").iterdir()} == {REPORT, MANIFEST, *wanted}
    assert verifying.verify(tmp_path / "out").holds


def test_an_output_that_there_is_not_is_refused_with_those_that_there_are(tmp_path: Path) -> None:
    with pytest.raises(
        SettingsError, match=r"there is no output 'flat'; choose from step, flats, schedule, setting-out"
    ):
        delivering.deliver(fitted(), tmp_path / "out", shop=ShopSettings(outputs="flat,step"))
    assert list(tmp_path.iterdir()) == []


def test_a_model_on_a_map_is_set_out_on_the_map(tmp_path: Path) -> None:
    result, far = fitted(), (8.0e8, -2.0e8, 1000.0)
    report = delivering.deliver(replace(result, reference=replace(result.reference, origin=far)), tmp_path / "far")
    assert (report.origin.kept, report.origin.offset) == (False, far)
    said = "local origin at 800000000, -200000000, 1000 mm of the model"
    assert said in (tmp_path / "far" / "panels.step").read_text("ascii")[:300]
    assert verifying.verify(tmp_path / "far").holds
    assert delivering.deliver(result, tmp_path / "near").origin.kept
    there, here = (
        np.loadtxt(tmp_path / name / "setting_out.csv", delimiter=",", skiprows=1, usecols=(-3, -2, -1), quotechar='"')
        for name in ("far", "near")
    )
    assert there - here == pytest.approx(np.broadcast_to(far, here.shape), abs=1e-6)


def test_step_files_lie_on_the_map_if_that_is_asked_for(tmp_path: Path) -> None:
    result, far = fitted(), (8.0e8, -2.0e8, 1000.0)
    on_the_map = replace(result, reference=replace(result.reference, origin=far))
    report = delivering.deliver(on_the_map, tmp_path / "out", shop=ShopSettings(outputs=("glb", "ifc"), origin="keep"))
    assert (report.origin.kept, report.origin.offset) == (True, far)
    assert report.certificate.volume_error < 1e-11
    assert verifying.verify(tmp_path / "out").holds
    for name, shape in read_step_shapes(tmp_path / "out" / "panels.step"):
        facts = inspect(name, shape)
        assert tuple(facts.placed) == far
        (panel,) = (panel for panel in report.panels if panel.name == name)
        corners = np.reshape(panel.corners, (-1, 3))
        assert np.linalg.norm(facts.vertices[:, None] - corners, axis=-1).min(axis=0).max() < 1e-9
    path = tmp_path / "out" / "report.json"
    path.write_text(path.read_text(encoding="utf-8").replace("800000000.0", "800000001.0"), encoding="utf-8")
    failures = verifying.verify(tmp_path / "out").failures
    assert "Panel 'N 1': its solid is placed 1 mm away from where it is expected." in failures


def test_only_the_panels_that_are_asked_for_are_delivered_and_all_are_reported(tmp_path: Path) -> None:
    report = delivering.deliver(fitted(), tmp_path / "out", shop=ShopSettings(only="*1,N 3"))
    assert (report.certificate.solids, report.certificate.skins, len(report.panels)) == (2, 2, 3)
    assert {path.name for path in (tmp_path / "out" / "flat").iterdir()} == {"N 1.dxf", "N 3.dxf", "all.dxf"}
    assert verifying.verify(tmp_path / "out").holds
    with pytest.raises(SettingsError, match="there is no panel 'N 4' to deliver"):
        delivering.deliver(fitted(), tmp_path / "none", shop=ShopSettings(only="N 4"))


def test_a_folder_of_drawings_is_replaced_unless_it_holds_what_is_not_ours(tmp_path: Path) -> None:
    out = tmp_path / "out"
    delivering.deliver(fitted(), out)
    delivering.deliver(fitted(), out, overwrite=True)
    (out / "flat" / "N 1.dxf").write_bytes(b"0\r\nSECTION\r\n")
    with pytest.raises(DeliveryError, match=r"also holds 'flat/N 1\.dxf', which cadpanel did not write"):
        delivering.deliver(fitted(), out, overwrite=True)
    (out / "flat" / "N 1.dxf").unlink()
    (out / "flat" / "nested").mkdir()
    with pytest.raises(DeliveryError, match="also holds 'flat/nested'"):
        delivering.deliver(fitted(), out, overwrite=True)


def test_a_new_output_is_written_told_of_and_demanded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    more = (*OUTPUTS, NameList())
    for module in (delivering, verifying):
        monkeypatch.setattr(module, "OUTPUTS", more)
    told: list[tuple[str, int, int]] = []
    delivering.deliver(
        fitted(), tmp_path / "out", SheetSettings(thickness=2.5), progress=lambda *step: told.append(step)
    )
    names = tmp_path / "out" / "names.txt"
    assert names.read_text(encoding="utf-8").splitlines() == ["arrays 2.5", "N 1", "N 2", "N 3"]
    written = sum(output.always or output.unasked for output in more)
    assert ("write", written, written) in told
    assert verifying.verify(tmp_path / "out").holds
    names.unlink()
    with pytest.raises(DeliveryError, match=r"holds no names\.txt"):
        verifying.verify(tmp_path / "out")


def test_an_output_that_is_not_always_there_is_neither_written_nor_demanded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = NameList()
    asked.always = asked.unasked = False
    for module in (delivering, verifying):
        monkeypatch.setattr(module, "OUTPUTS", (*OUTPUTS, asked))
    delivering.deliver(fitted(), tmp_path / "out")
    assert not (tmp_path / "out" / "names.txt").exists()
    assert verifying.verify(tmp_path / "out").holds


def test_an_output_whose_package_is_missing_is_refused_with_how_to_install_it() -> None:
    asked = NameList()
    asked.always, asked.needs = False, ("no_such_package",)
    with pytest.raises(
        SettingsError, match=r"'names' needs no_such_package: install it with pip install 'cadpanel\[nam"
    ):
        chosen_outputs(("names",), [asked])
    assert chosen_outputs(("step",), [asked]) == ()
