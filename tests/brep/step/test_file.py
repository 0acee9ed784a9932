"""STEP files keep every name, colour and digit, repeat byte for byte, and are written whole or not at all."""

import errno
import os
import time
from pathlib import Path

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.IFSelect import IFSelect_RetDone
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cadpanel.brep.building.sheet import build_panel, build_skin, build_solid, volume_of
from cadpanel.brep.files.step_reader import read_document
from cadpanel.brep.proof import boundary
from cadpanel.brep.proof.inspection import boundary_of, inspect
from cadpanel.brep.step.file import read_step_shapes, write_assembly, write_step
from cadpanel.brep.step.part_files import PartFile
from cadpanel.brep.step.text import real, string
from cadpanel.delivery.settings import SheetSettings
from cadpanel.errors import DeliveryError, PanelError
from cadpanel.geometry.volume import sheet_volume
from tests.built import area_of
from tests.drilled import fixed
from tests.flat_panels import panels as panels_of
from tests.kernel_step import write_by_kernel
from tests.shapes import CHAINS, random_panel

pytestmark = pytest.mark.each_value_once

NAMES = ["A-01", "panel with spaces", "Süd, Ost", 'it\'s \\ "quoted"', "面板 7", "🏗 crane", "A/B;C*", "#12=X()"]
BLUE = (0.25, 0.5, 0.75)


@pytest.fixture
def panels():
    return [random_panel(seed, name=name) for seed, name in enumerate(NAMES)]


def test_names_survive_in_their_order(tmp_path, panels):
    write_step(tmp_path / "a.step", [(p.name, build_solid(p, 3.0), None) for p in panels], title="Lip 'ä'")
    assert [name for name, _ in read_step_shapes(tmp_path / "a.step")] == NAMES


def test_one_panel_alone_keeps_its_name(tmp_path):
    write_step(tmp_path / "a.step", [("only", build_solid(random_panel(1), 3.0), None)], title="t")
    [(name, shape)] = read_step_shapes(tmp_path / "a.step")
    assert name == "only"
    assert shape.ShapeType() == TopAbs_SOLID


@pytest.mark.parametrize("half_angle", [0.0, 6e-6, 1e-4, 0.02, -0.02, 0.1])
@pytest.mark.parametrize("concave", [False, True])
@pytest.mark.parametrize("heal", [False, True])
def test_solids_and_skins_read_back_are_exactly_valid_and_lose_no_digit(tmp_path, half_angle, concave, heal):
    for chain in sorted(CHAINS):
        panel = random_panel(11, chain=chain, half_angle=half_angle, concave=concave, mitre=0.5)
        for kind, built in ((TopAbs_SOLID, build_solid(panel, 3.0)), (TopAbs_SHELL, build_skin(panel))):
            write_step(tmp_path / "a.step", [("p", built, None)], title="t")
            [(_, again)] = read_step_shapes(tmp_path / "a.step", heal=heal)
            assert again.ShapeType() == kind
            assert BRepCheck_Analyzer(again, True, False, True).IsValid()
            before, after = inspect("p", built), inspect("p", again)
            assert after.face_kinds == before.face_kinds
            apart = np.linalg.norm(after.vertices[:, None] - before.vertices[None], axis=-1)
            assert apart.min(axis=0).max() < 1e-11
            if kind == TopAbs_SOLID:
                assert volume_of(again) == pytest.approx(volume_of(built), rel=1e-12)


@pytest.mark.parametrize("feature", ["plane-cone-plane", "plane-cylinder-plane-cone-plane", "tri-cone", "polygon of 5"])
def test_a_file_holds_what_the_kernels_own_translator_makes_of_the_same_shapes(tmp_path, monkeypatch, feature):
    """Solids and skins: plain, with square ends, and with holes."""
    shape = panels_of(feature, 3)[0].straightened().shape
    square = shape.squared(-3.0).straightened().shape
    built = [build_panel(shape, 3.0), build_panel(square, 3.0), build_panel(shape, 3.0, "outer", drill(shape))]
    named = [(name, one) for made in built for name, one in (("solid", made.solid), ("skin", made.skin))]
    numbered = [(f"{name} {number}", one) for number, (name, one) in enumerate(named)]
    write_step(tmp_path / "ours.step", [(name, one, None) for name, one in numbered], title="t")
    write_by_kernel(tmp_path / "theirs.step", numbered)
    ours, theirs = (read_step_shapes(tmp_path / file) for file in ("ours.step", "theirs.step"))
    monkeypatch.setattr(boundary, "SAME_PLACE", 1e-8)  # theirs has twelve digits of metres
    monkeypatch.setattr(boundary, "SAME_WAY", 1e-9)
    for (name, own), (same, other) in zip(ours, theirs, strict=True):
        assert name == same
        assert own.ShapeType() == other.ShapeType()
        assert boundary.difference(boundary_of(own), boundary_of(other)) is None
        measure = volume_of if own.ShapeType() == TopAbs_SOLID else area_of
        assert measure(own) == pytest.approx(measure(other), rel=1e-9)
    assert volume_of(ours[0][1]) == pytest.approx(sheet_volume(shape, 3.0, "outer"), rel=1e-12)


def drill(shape):
    return fixed(shape, SheetSettings(thickness=3.0))[1]


def test_shapes_are_written_as_they_come_and_a_fault_on_the_way_leaves_nothing(tmp_path):
    sizes = []

    def solids():
        for number in range(4):
            yield str(number), build_skin(random_panel(number)), None
            sizes.append(sum(file.stat().st_size for file in tmp_path.iterdir()))
        raise PanelError("3", "there is none")

    with pytest.raises(PanelError, match="there is none"):
        write_step(tmp_path / "a.step", solids(), title="t")
    assert 0 < sizes[1] < sizes[2] < sizes[3]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("schema", ["AP242", "AP214"])
def test_the_header_says_who_wrote_it_in_which_schema(tmp_path, schema):
    write_step(tmp_path / "a.step", [("p", build_solid(random_panel(1), 3.0), BLUE)], title="Lip", schema=schema)
    head = (tmp_path / "a.step").read_text()[:600]
    assert "'cadpanel'" in head
    assert {"AP242": "AP242_MANAGED", "AP214": "AUTOMOTIVE_DESIGN"}[schema] in head
    assert len(read_step_shapes(tmp_path / "a.step")) == 1


def test_the_same_panels_give_the_same_bytes(tmp_path, panels):
    for file in ("a.step", "b.step"):
        write_step(tmp_path / file, [(p.name, build_solid(p, 3.0), BLUE) for p in panels], title="t")
    assert (tmp_path / "a.step").read_bytes() == (tmp_path / "b.step").read_bytes()


def test_colours_survive(tmp_path):
    write_step(tmp_path / "a.step", [("p", build_solid(random_panel(1), 3.0), BLUE)], title="t")
    reader = STEPCAFControl_Reader()
    reader.SetColorMode(True)
    assert reader.ReadFile(str(tmp_path / "a.step")) == IFSelect_RetDone
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    assert reader.Transfer(document)
    tool, labels = XCAFDoc_DocumentTool.ShapeTool_s(document.Main()), TDF_LabelSequence()
    tool.GetShapes(labels)
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    found = []
    for index in range(1, labels.Length() + 1):
        color = Quantity_Color()
        shape = XCAFDoc_ShapeTool.GetShape_s(labels.Value(index))
        if colors.GetColor(shape, XCAFDoc_ColorSurf, color):
            found.append(color.Values(Quantity_TOC_sRGB))
    assert found
    assert found[0] == pytest.approx(BLUE, abs=1e-6)


def test_the_kernel_keeps_quiet(tmp_path, capfd):
    write_step(tmp_path / "a.step", [("p", build_solid(random_panel(1), 3.0), None)], title="t")
    read_step_shapes(tmp_path / "a.step")
    output = capfd.readouterr()
    assert output.out == ""
    assert output.err == ""


def test_an_existing_file_is_replaced_and_nothing_else_is_left(tmp_path):
    (tmp_path / "a.step").write_text("old")
    write_step(tmp_path / "a.step", [("p", build_skin(random_panel(1)), None)], title="t")
    assert [file.name for file in tmp_path.iterdir()] == ["a.step"]
    assert (tmp_path / "a.step").read_text().startswith("ISO-10303-21;")


def test_what_a_killed_run_left_is_removed_by_the_next_one_and_nothing_else_is(tmp_path):
    long_ago = time.time() - 86_400.0
    for name, begun in (
        ("a.step.cadpanel-0123abcd", long_ago),  # killed
        ("a.step.cadpanel-89ef4567", time.time()),  # at work beside us
        ("b.step.cadpanel-0123abcd", long_ago),  # on its way to another file
        ("a.step.swp", long_ago),  # somebody's
    ):
        (tmp_path / f".{name}").write_text("half")
        os.utime(tmp_path / f".{name}", (begun, begun))
    write_step(tmp_path / "a.step", [("p", build_skin(random_panel(1)), None)], title="t")
    left = {file.name for file in tmp_path.iterdir()} - {"a.step"}
    assert left == {".a.step.cadpanel-89ef4567", ".b.step.cadpanel-0123abcd", ".a.step.swp"}


def test_a_file_on_its_way_has_a_name_by_which_the_next_run_knows_it(tmp_path, monkeypatch):
    def killed(_descriptor):
        [beside] = tmp_path.iterdir()
        os.utime(beside, (0.0, 0.0))
        beside.rename(tmp_path / f"{beside.name}0")  # what has another name is not removed on the way out
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", killed)
        with pytest.raises(KeyboardInterrupt):
            write_step(tmp_path / "a.step", [("p", build_skin(random_panel(1)), None)], title="t")
    assert len(list(tmp_path.iterdir())) == 1
    write_step(tmp_path / "a.step", [("p", build_skin(random_panel(1)), None)], title="t")
    assert [file.name for file in tmp_path.iterdir()] == ["a.step"]


def test_the_file_has_the_permissions_of_any_other_file_also_where_none_can_be_given(tmp_path, monkeypatch):
    def refused(*_args, **_kwargs):
        raise OSError(errno.EPERM, os.strerror(errno.EPERM))

    for module in (os, Path):
        monkeypatch.setattr(module, "chmod", refused)
    write_step(tmp_path / "a.step", [("p", build_skin(random_panel(1)), None)], title="t")
    (tmp_path / "plain").write_text("")
    assert (tmp_path / "a.step").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize("number", [np.inf, np.nan])
def test_a_number_that_is_not_finite_is_refused_by_the_files_name(tmp_path, number):
    shapes = [("p", build_skin(random_panel(1)), None)]
    with pytest.raises(DeliveryError, match=r"a\.step cannot be written: it would hold the number (inf|nan), and STEP"):
        write_step(tmp_path / "a.step", shapes, title="t", placed=(0.0, number, 0.0))
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_one_clear_sentence(tmp_path):
    with pytest.raises(DeliveryError, match=r"a\.step cannot be written: No such file or directory\."):
        write_step(tmp_path / "none" / "a.step", [("p", build_skin(random_panel(1)), None)], title="t")


def test_a_full_disk_leaves_nothing_behind(tmp_path, monkeypatch):
    def full(_descriptor):
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(DeliveryError, match="No space left on device"):
        write_step(tmp_path / "a.step", [("p", build_skin(random_panel(1)), None)], title="t")
    assert list(tmp_path.iterdir()) == []


def test_a_shape_with_other_faces_is_refused(tmp_path):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

    spline = BRepBuilderAPI_NurbsConvert(build_solid(random_panel(1), 3.0)).Shape()
    with pytest.raises(DeliveryError, match="spline surface with weights, or that closes, not an exact panel"):
        write_step(tmp_path / "a.step", [("p", spline, None)], title="t")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("text", ["", "not STEP at all", "ISO-10303-21;\nHEADER;\n"])
def test_a_file_that_is_not_step_is_one_clear_sentence(tmp_path, text):
    (tmp_path / "a.step").write_text(text)
    with pytest.raises(DeliveryError, match="cannot be read"):
        read_step_shapes(tmp_path / "a.step")


def test_a_missing_file_is_one_clear_sentence(tmp_path):
    with pytest.raises(DeliveryError, match="no such file"):
        read_step_shapes(tmp_path / "a.step")


def test_a_file_cut_short_is_not_taken_for_a_whole_one(tmp_path, panels):
    write_step(tmp_path / "a.step", [(p.name, build_solid(p, 3.0), None) for p in panels], title="t")
    text = (tmp_path / "a.step").read_text()
    (tmp_path / "a.step").write_text(text[: len(text) // 2])
    with pytest.raises(DeliveryError, match="cannot be read"):
        read_step_shapes(tmp_path / "a.step")


@pytest.mark.parametrize(
    ("number", "text"),
    [(0.0, "0.0"), (-1.5, "-1.5"), (1e-7, "1.E-07"), (1.25e-30, "1.25E-30"), (1e22, "1.E+22"), (0.1, "0.1")],
)
def test_reals_have_a_point_and_all_digits(number, text):
    assert real(number) == text
    assert float(real(number)) == number


def test_strings_are_encoded_as_the_standard_says():
    assert string("it's") == "'it''s'"
    assert string("a\\b") == "'a\\\\b'"
    assert string("ä面🏗") == "'\\X2\\00E4\\X0\\\\X2\\9762\\X0\\\\X4\\0001F3D7\\X0\\'"


def test_shapes_are_placed_in_the_assembly_and_keep_their_own_numbers(tmp_path, panels):
    far = (8.3e8, -2.1e8, 1000.0)
    solids = [(panel.name, build_solid(panel, 3.0), BLUE) for panel in panels[:2]]
    write_step(tmp_path / "here.step", solids, title="t")
    write_step(tmp_path / "there.step", solids, title="t", placed=far)
    for (name, here), (same, there) in zip(
        *(read_step_shapes(tmp_path / file) for file in ("here.step", "there.step")), strict=True
    ):
        one, other = inspect(name, here), inspect(same, there)
        assert name == same
        assert tuple(one.placed) == (0.0, 0.0, 0.0)
        assert tuple(other.placed) == far
        assert other.valid
        assert np.array_equal(one.vertices, other.vertices)
        assert one.volume == other.volume


@pytest.mark.parametrize("placed", [(0.0, 0.0, 0.0), (8.3e8, -2.1e8, 1000.0)])
def test_the_kernels_reader_has_nothing_to_remark(tmp_path, panels, placed):
    shapes = [(panel.name, build_solid(panel, 3.0), BLUE) for panel in panels[:2]]
    write_step(tmp_path / "a.step", shapes, title="t", placed=placed)
    write_assembly(tmp_path / "b.step", [PartFile(name="a", path="a.step", placed=placed)], title="b")
    for file in ("a.step", "b.step"):
        assert remarks(tmp_path / file) == []


def remarks(path):
    """What the kernel's reader warns of, or fails at."""
    step, found = read_document(path, labels=True), []
    checks = step.reader.Reader().WS().TransferReader().LastCheckList()
    checks.Start()
    while checks.More():
        check = checks.Value()
        found += [check.CWarning(index) for index in range(1, check.NbWarnings() + 1)]
        found += [check.CFail(index) for index in range(1, check.NbFails() + 1)]
        checks.Next()
    return found
