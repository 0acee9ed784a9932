"""Deliveries of regions hang in one assembly, each where it lies in the model; what cannot hang there is refused."""

import re
import shutil

import pytest

from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery.assemble import assemble, assemble_told
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.hung import Hung
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import OriginModel, read_report, write_report
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError
from tests.delivered import fitted_alone

FAR = (8.3e8, -2.1e8, 0.0)


@pytest.fixture(scope="module")
def regions(tmp_path_factory):
    """The same delivery as three regions: the second one far away, the third with coordinates of the model."""
    place = tmp_path_factory.mktemp("building")
    deliver(fitted_alone(), place / "one", shop=ShopSettings(outputs="step"))
    report = read_report(place / "one" / REPORT)
    for name, kept in (("two", False), ("three", True)):
        shutil.copytree(place / "one", place / name)
        far = report.model_copy(update={"origin": OriginModel(kept=kept, offset=FAR)})
        write_report(far, place / name / REPORT)
    return place


def test_regions_hang_where_they_lie_in_the_model(regions):
    assemble([regions / name for name in ("one", "two", "three")], regions / "building.step")
    found = read_step_shapes(regions / "building.step")
    alone = [name for name, _ in read_step_shapes(regions / "one" / PANELS)]
    assert [name for name, _ in found] == 3 * alone
    places = [shape.Location().Transformation().TranslationPart().Coord() for _, shape in found]
    assert places == [(0.0, 0.0, 0.0)] * 3 + [FAR] * 3 + [(0.0, 0.0, 0.0)] * 3


def test_what_cannot_hang_there_is_refused(regions, tmp_path):
    shutil.copytree(regions / "one", tmp_path / "one")
    with pytest.raises(DeliveryError, match=r"2 deliveries are called 'one', which 'b\.step' cannot tell apart"):
        assemble([regions / "one", tmp_path / "one"], tmp_path / "b.step")
    (tmp_path / "one" / PANELS).unlink()
    with pytest.raises(DeliveryError, match=r"holds no panels\.step to hang in 'b\.step'"):
        assemble([tmp_path / "one"], tmp_path / "b.step")
    report = read_report(regions / "two" / REPORT)
    other = report.model_copy(update={"settings": report.settings.model_copy(update={"step_schema": "AP214"})})
    shutil.copytree(regions / "two", tmp_path / "two")
    write_report(other, tmp_path / "two" / REPORT)
    with pytest.raises(DeliveryError, match=r"'b\.step' cannot hold AP214, AP242: choose one"):
        assemble([regions / "one", tmp_path / "two"], tmp_path / "b.step")
    with pytest.raises(DeliveryError, match="cannot hold no delivery"):
        assemble([], tmp_path / "b.step")
    assert not (tmp_path / "b.step").exists()


def hung(place, *names):
    """Deliveries of which the assembly asks no more than where their panels are, with their folders made."""
    told = {}
    for name in names:
        folder = place / name
        folder.mkdir(parents=True)
        (folder / PANELS).write_text("panels")
        told[folder] = Hung("AP242", (0.0, 0.0, 0.0))
    return told


def files_named_in(assembly):
    return re.findall(r"=DOCUMENT_FILE\('([^']*)'", assembly.read_text())


@pytest.mark.parametrize("name", ["panels.step", "SKINS.step", "report.json"])
@pytest.mark.parametrize("linked", [False, True])
def test_no_file_of_a_delivery_is_replaced(tmp_path, name, linked):
    told, there = hung(tmp_path, "a", "b"), tmp_path / "a"
    if linked:
        there = tmp_path / "link"
        there.symlink_to(tmp_path / "a")
    with pytest.raises(DeliveryError, match="would take the place of a file of that delivery: name another file"):
        assemble_told(told, there / name)
    assert (tmp_path / "a" / PANELS).read_text() == "panels"


@pytest.mark.parametrize("target", ["all.step", "deep/all.step", "link/all.step", "link/under/all.step"])
@pytest.mark.parametrize("through_a_link", [False, True])
def test_the_files_that_an_assembly_names_are_those_of_its_deliveries(tmp_path, target, through_a_link):
    told = hung(tmp_path, "a", "deep/b", "far/away/c")
    (tmp_path / "far" / "away" / "under").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "far" / "away")
    if through_a_link:
        told = {tmp_path / "link" / ".." / ".." / folder.relative_to(tmp_path): one for folder, one in told.items()}
    assembly = tmp_path / target
    assemble_told(told, assembly)
    for folder, name in zip(told, files_named_in(assembly), strict=True):
        assert (assembly.parent / name).samefile(folder / PANELS)


def test_below_the_assembly_a_link_is_named_as_it_is_called(tmp_path):
    hung(tmp_path, "store/north")
    (tmp_path / "building").mkdir()
    (tmp_path / "building" / "north").symlink_to(tmp_path / "store" / "north")
    there = {tmp_path / "building" / "north": Hung("AP242", (0.0, 0.0, 0.0))}
    assemble_told(there, tmp_path / "building" / "all.step")
    assert files_named_in(tmp_path / "building" / "all.step") == ["north/panels.step"]


def test_a_delivery_on_another_drive_is_refused(tmp_path, monkeypatch):
    told = hung(tmp_path, "a", "b")
    (tmp_path / "elsewhere").mkdir()

    def on_windows(path, start):
        raise ValueError(f"path is on mount 'D:', start on mount 'C:': {path}, {start}")

    monkeypatch.setattr("cadpanel.delivery.assemble.os.path.relpath", on_windows)
    with pytest.raises(
        DeliveryError, match=r"a' stands on another drive than '.*all\.step', and no path .* leads there"
    ):
        assemble_told(told, tmp_path / "elsewhere" / "all.step")
