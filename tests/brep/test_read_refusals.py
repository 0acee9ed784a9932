"""Files that are refused when they are read, and panels that are refused where a feature is asked for: by name."""

import os
import re

import numpy as np
import pytest
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Ax2, gp_Circ, gp_Pln, gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer

from cadpanel.brep.read import read_reference
from cadpanel.brep.survey import survey
from cadpanel.errors import PanelError, ReferenceFileError, SettingsError
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.settings import ReferenceSettings
from tests.reference_shapes import Lip, kernel_face, kernel_lip, write_products


def test_same_geometry_twice_is_refused(folder, lips):
    copy = BRepBuilderAPI_Transform(lips[0][1], gp_Trsf(), True).Shape()
    path = write_products(folder / "double.step", [*lips, ("copy", copy)])
    with pytest.raises(PanelError, match=r"Panel 'copy': in 'double.step', it lies on panel 'lip 0' to within 1 mm"):
        read_reference(path)


def refusal(path):
    with pytest.raises(ReferenceFileError) as caught:
        read_reference(path)
    message = str(caught.value)
    assert path.name in message
    assert "\n" not in message
    return message


def test_missing_file_folder_and_empty_file_are_refused(tmp_path):
    assert "does not exist" in refusal(tmp_path / "nothing.step")
    assert "is a folder" in refusal(tmp_path)
    (tmp_path / "empty.step").write_bytes(b" \n")
    assert "is empty" in refusal(tmp_path / "empty.step")


@pytest.mark.parametrize("way", ["reference", "network", "spine", "mesh"])
def test_name_that_is_too_long_and_pipe_are_refused(tmp_path, strip_file, way):
    os.mkfifo(tmp_path / "pipe")
    for path, sentence in (
        (tmp_path / f"{300 * 'a'}.step", r"cannot be read \(File name too long\): check its name"),
        (tmp_path / "pipe", r"pipe' is a pipe or a device: save what comes out of it to a file"),
    ):
        stations = {"stations": (1000.0,)} if way == "spine" else {}
        how = {} if way == "reference" else {way: path, **stations}
        with pytest.raises(ReferenceFileError, match=sentence):
            read_reference(path if way == "reference" else strip_file, ReferenceSettings(**how))


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        (None, "the reference must be the name of a file, not None"),
        (3, "the reference must be the name of a file, not 3"),
        (b"x.step", "the reference must be the name of a file, not b'x.step'"),
        ("", "the reference must be the name of a file, not ''"),
        ("a\0b", r"the reference must be the name of a file, not 'a\\x00b'"),
        ("D\udce4cher.step", r"the name of the reference, 'D\\udce4cher.step', is not UTF-8: rename the file"),
    ],
)
def test_what_is_no_name_of_a_file_is_refused(path, sentence):
    for read in (read_reference, survey):
        with pytest.raises(SettingsError, match=sentence):
            read(path)
    if path is not None:
        with pytest.raises(SettingsError, match=sentence.replace("reference", "network")):
            ReferenceSettings(network=path)


@pytest.mark.parametrize(
    ("content", "name"),
    [
        ("solid part\nfacet normal", "an STL file"),
        ("PK\x03\x04....", "a ZIP archive"),
        ("panels: 3\n", "of no format that it knows"),
    ],
)
def test_other_formats_are_refused_and_the_readable_ones_named(tmp_path, content, name):
    path = tmp_path / "reference.step"
    path.write_text(content)
    message = refusal(path)
    assert name in message
    assert "STEP files (AP203, AP214 or AP242" in message


def test_content_counts_and_not_the_extension(tmp_path, strip_file):
    path = tmp_path / "strip.txt"
    path.write_bytes(strip_file.read_bytes())
    assert len(read_reference(path).panels) == 4


def test_path_beyond_ascii_is_read(tmp_path, strip_file):
    path = tmp_path / "Dächer 北" / "Süd 1.step"
    path.parent.mkdir()
    path.write_bytes(strip_file.read_bytes())
    assert read_reference(path).source == "Süd 1.step"


def test_truncated_file_is_refused(tmp_path, strip_file):
    path = tmp_path / "cut.step"
    text = strip_file.read_bytes()
    path.write_bytes(text[: len(text) * 9 // 10])
    assert "breaks off before its end" in refusal(path)


@pytest.mark.parametrize("number", ["nan", "NaN", "-inf", "1.#QNAN", "1.E400"])
def test_coordinate_that_is_no_number_is_refused_with_its_place(tmp_path, strip_file, number):
    path = tmp_path / "nan.step"
    text, points = strip_file.read_text(), r"(#\d+) = CARTESIAN_POINT\('',\(([^,()]+),([^,()]+),"
    found = list(re.finditer(points, text))[40]
    path.write_text(text[: found.start(2)] + number + text[found.end(2) :])
    assert f"({number} at {found.group(1)})" in refusal(path)


def test_name_that_looks_like_no_number_is_only_a_name(folder, lips):
    path = write_products(folder / "name.step", [("panel (nan)", lips[0][1])])
    assert read_reference(path).panels[0].name == "panel (nan)"


def test_reference_to_a_missing_instance_is_refused(tmp_path, strip_file):
    path = tmp_path / "hole.step"
    path.write_text(re.sub(r"(ADVANCED_FACE\('',\(#\d+\),)#\d+", r"\1#999999", strip_file.read_text(), count=1))
    assert "is damaged" in refusal(path)


@pytest.mark.parametrize(
    ("whole", "damaged"),
    [
        (r"(LINE\('',#\d+),#\d+\)", r"\1,$)"),
        (r"(LINE\('',)#\d+,(#\d+)\)", r"\1\2,\2)"),
        (r"LINE\('',#\d+,", r"LINE('',"),
        (r"= LINE\(", r"= LANE("),
        (r"(CARTESIAN_POINT\('',\()[^,]*,", r"\1'a',"),
        (r"(ADVANCED_FACE\('',\(#\d+\),)#\d+", r"\1#1"),
        (r"(EDGE_LOOP\('',)\([^)]*\)", r"\1($)"),
        (r"(ORIENTED_EDGE\('',\*,\*,)#\d+", r"\1$"),
        (r"PCURVE\('',#\d+", r"PCURVE('',$"),
        (r"(DEFINITIONAL_REPRESENTATION\('',\()#\d+", r"\1#1"),
    ],
)
def test_geometry_with_a_parameter_of_a_wrong_kind_is_refused(tmp_path, strip_file, whole, damaged):
    """The kernel crashes over some of them, and makes up numbers for the others."""
    text, count = re.subn(whole, damaged, strip_file.read_text(), count=1)
    assert count == 1
    path = tmp_path / "bent.step"
    path.write_text(text)
    assert "'bent.step' is damaged" in refusal(path)


def test_missing_names_do_no_harm(tmp_path, strip_file):
    path = tmp_path / "nameless.step"
    path.write_text(
        strip_file.read_text().replace("LINE('',", "LINE($,").replace("ADVANCED_FACE('',", "ADVANCED_FACE($,")
    )
    assert len(read_reference(path).panels) == len(read_reference(strip_file).panels)


def test_file_of_curves_is_refused(folder):
    circle = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(), 100.0)).Edge()
    assert "holds no faces, only curves" in refusal(write_products(folder / "curves.step", [("circle", circle)]))


def test_product_without_faces_beside_panels_is_refused_by_name(folder, lips):
    circle = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(), 100.0)).Edge()
    path = write_products(folder / "beside.step", [*lips, ("axis", circle)])
    with pytest.raises(PanelError, match=r"Panel 'axis': in 'beside.step', it holds no face"):
        read_reference(path)


def test_solid_block_is_refused_by_name(folder):
    path = write_products(folder / "block.step", [("block", BRepPrimAPI_MakeBox(100.0, 200.0, 300.0).Shape())])
    with pytest.raises(PanelError, match=r"Panel 'block': in 'block.step', it is a solid: export only the faces"):
        read_reference(path)


def test_sphere_is_refused_as_closed(folder):
    explorer = TopExp_Explorer(BRepPrimAPI_MakeSphere(500.0).Shape(), TopAbs_FACE)
    path = write_products(folder / "sphere.step", [("ball", explorer.Current())])
    with pytest.raises(PanelError, match=r"Panel 'ball': in 'sphere.step', it is a closed surface without an outline"):
        read_reference(path)


# ------------------------------------------------------------------ read, and refused by the feature that is asked for
def fitted_with(path, feature):
    """The panels of a file, each fitted alone; reading it must go well."""
    reference = read_reference(path)
    return fit(reference, FitSettings(feature=feature, method="local"))


def saddle(u, v):
    x, y = u / 1.5 - 1.0, 2.0 * v - 1.0
    return 1000.0 * np.stack([x, y, 0.3 * (x**2 - y**2)], axis=-1)


def flat_sheet(corners):
    """A regular polygon with so many corners in the plane z = 0."""
    outline = BRepBuilderAPI_MakePolygon()
    for turn in 2.0 * np.pi * np.arange(corners) / corners:
        outline.Add(gp_Pnt(1000.0 * np.cos(turn), 1000.0 * np.sin(turn), 0.0))
    outline.Close()
    return BRepBuilderAPI_MakeFace(gp_Pln(), outline.Wire()).Face()


@pytest.mark.parametrize("feature", ["plane-cone-plane", "cone"])
def test_a_saddle_is_refused_and_a_lip_passes(folder, feature):
    path = write_products(folder / "saddle.step", [("saddle", kernel_face(saddle))])
    with pytest.raises(PanelError, match=r"Panel 'saddle': in '.*', it curves both ways like a sphere or a saddle"):
        fitted_with(path, feature)
    lip = write_products(folder / "lip.step", [("lip", kernel_lip(Lip()))])
    assert fitted_with(lip, feature).shapes[0].name == "lip"


@pytest.mark.parametrize("feature", ["plane-cone-plane", "cylinder"])
def test_a_flat_panel_is_refused_where_a_fold_is_asked_for(folder, feature):
    path = write_products(folder / "flat.step", [("pane", flat_sheet(4))])
    with pytest.raises(PanelError, match=r"Panel 'pane': in 'flat.step', it is flat .* give it a flat feature"):
        fitted_with(path, feature)
    assert fitted_with(path, "planar-quadrilateral").measures.overall_rms == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("corners", [3, 5, 6])
def test_a_panel_without_four_corners_is_refused_where_ends_are_asked_for(folder, corners):
    path = write_products(folder / f"{corners}.step", [("pane", flat_sheet(corners))])
    with pytest.raises(
        PanelError, match=rf"Panel 'pane': .* outline has {corners} corners .* make it a planar-polygon"
    ):
        fitted_with(path, "planar-quadrilateral")
    assert fitted_with(path, "planar-polygon").shapes[0].corners().shape == (1, corners, 3)
