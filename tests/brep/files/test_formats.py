import re
import sys
from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.gp import gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.cutting.raw_panels import raw_panels
from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files import rhino
from cadpanel.brep.files.catalogue import FORMATS, format_of
from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.kernel.shapes import compound_of, packed, shapes_of, unpacked
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import strip_faces, write_labelled, write_shape

SAME = 1e-6  # mm
FLANGE = Label(name="lower flange", layer="Skin", color="#c04020")
BLEND = Label(name="blend", layer="Skin", color="#20c040")


@pytest.fixture(scope="module")
def faces():
    return strip_faces()


@pytest.fixture(scope="module")
def parts(faces):
    wire = BRepBuilderAPI_MakeEdge(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(9000.0, 0.0, 0.0)).Edge()
    return [(FLANGE, faces[0], []), (BLEND, faces[1], []), (Label(name="axis", layer="Lines"), wire, [])]


def boxes(model_faces):
    return [np.array([face.points.min(axis=0), face.points.max(axis=0)]) for face in model_faces]


def scaled(shape, factor):
    scaling = gp_Trsf()
    scaling.SetScale(gp_Pnt(0.0, 0.0, 0.0), factor)
    return BRepBuilderAPI_Transform(shape, scaling, True).Shape()


@pytest.mark.parametrize("ending", [".step", ".iges"])
def test_names_layers_colors_and_curves_survive(tmp_path, parts, ending):
    model = load_model(write_labelled(tmp_path / f"model{ending}", parts))
    assert [face.number for face in model.faces()] == [1, 2]
    layers = ("Skin", "Lines") if ending == ".step" else ("1", "2")  # IGES has level numbers only
    assert [face.label for face in model.faces()] == [replace(said, layer=layers[0]) for said in (FLANGE, BLEND)]
    assert [curve.label.layer for curve in model.curves()] == [layers[1]]
    assert model.notes == ()


def test_faces_of_a_solid_keep_labels_of_their_own(tmp_path):
    box = BRepPrimAPI_MakeBox(100.0, 200.0, 300.0).Shape()
    sides = shapes_of(box, TopAbs_FACE)
    path = write_labelled(
        tmp_path / "box.step",
        [(Label(name="box", color="#101010"), box, [(Label(name="top", color="#ff0000"), sides[2])])],
    )
    model = load_model(path)
    labels = [face.label for face in model.faces()]
    assert [label.name for label in labels] == ["box", "box", "top", "box", "box", "box"]
    assert [label.color for label in labels] == ["#101010", "#101010", "#ff0000", "#101010", "#101010", "#101010"]
    assert all(face.of_solid for face in model.faces())
    assert [face.number for face in select_faces(model, ("name=top",))] == [3]
    assert [face.number for face in select_faces(model, ("color=#FF0000", "5-6"))] == [3, 5, 6]
    with pytest.raises(ReferenceFileError, match="holds a solid, of which face 1 is one: say which"):
        select_faces(model, None)
    with pytest.raises(ReferenceFileError, match=r"has no face 'bottom': it has faces 1 to 6; names box, top"):
        select_faces(model, ("bottom",))


def named_faces(*names):
    """A model of faces with these names."""
    parts = tuple(
        Part(label=Label(name=name), shape=face, face_labels=(Label(),))
        for name, face in zip(names, strip_faces() * 2, strict=False)
    )
    return Model(source="skin.step", format="STEP", unit="millimetre", parts=parts)


@pytest.mark.parametrize(
    ("word", "numbers"),
    [
        ("Skin [1]", [1]),
        ("Skin 1", [2]),
        ("name=Skin [*]", [1, 5]),
        ("Skin*1*", [1, 2]),
        ("*", [1, 2, 3, 4, 5]),
        ("a*", [3]),
        ("A*", [4]),
        ("A**", [4]),
        ("2-3", [2, 3]),
        ("002 - 03", [2, 3]),
        ("1-5", [1, 2, 3, 4, 5]),
    ],
)
def test_a_word_chooses_the_faces_that_are_called_so(word, numbers):
    model = named_faces("Skin [1]", "Skin 1", "a*", "A**", "Skin [x]", "")
    assert [face.number for face in select_faces(model, (word,))] == numbers


@pytest.mark.parametrize("word", ["skin 1", "Skin ?", "Skin [0-9]", "1-3", "0-1", "0", "3", "2-1", "name=", "9" * 5000])
def test_a_word_that_fits_no_face_or_only_some_is_refused(word):
    with pytest.raises(ReferenceFileError, match=rf"has no face '{re.escape(word)}': it has faces 1 to 2; names Skin"):
        select_faces(named_faces("Skin 1", ""), (word,))


@pytest.mark.parametrize(
    ("name", "unit", "word", "factor"),
    [
        ("inch.step", "INCH", "inch", 1.0),
        ("metre.step", "M", "metre", 1.0),
        ("inch.iges", "INCH", "inch", 1.0),
        ("metre.iges", "M", "metre", 1.0),
        ("plain.iges", "MM", "millimetre", 1.0),
    ],
)
def test_units_of_a_file_become_millimetres_and_are_told(tmp_path, parts, name, unit, word, factor):
    model = load_model(write_labelled(tmp_path / name, parts, unit))
    assert model.unit == word
    for face, (_, shape, _) in zip(model.faces(), parts, strict=False):
        (there,), (here,) = sample_faces(face.face), sample_faces(shape)
        np.testing.assert_allclose(there.points, factor * here.points, atol=1e-4)


@pytest.mark.parametrize("name", ["model.brep", "model.bin.brep"])
def test_brep_without_a_unit_is_read_as_millimetres_with_a_note_or_in_the_unit_given(tmp_path, faces, name):
    path = write_shape(tmp_path / name, scaled(compound_of(faces), 1e-3))
    noted, in_metres = load_model(path), load_model(path, 1000.0)
    assert "read as millimetres" in noted.notes[0]
    assert in_metres.notes == ()
    for face, small, shape in zip(in_metres.faces(), noted.faces(), faces, strict=True):
        (there,), (tiny,), (here,) = (sample_faces(of) for of in (face.face, small.face, shape))
        np.testing.assert_allclose(there.points, here.points, atol=SAME)
        np.testing.assert_allclose(tiny.points, 1e-3 * here.points, atol=SAME)


@pytest.mark.parametrize("name", ["model.step", "model.iges"])
def test_unit_for_a_file_that_has_its_own_is_refused(tmp_path, parts, name):
    path = write_labelled(tmp_path / name, parts, "M")
    with pytest.raises(ReferenceFileError, match="says itself that its unit is the metre: leave the unit out"):
        load_model(path, 25.4)


@pytest.mark.parametrize("name", ["model.step", "model.iges", "model.brep", "model.bin.brep"])
def test_content_counts_and_not_the_extension(tmp_path, parts, name):
    written = (
        write_shape(tmp_path / name, parts[0][1]) if name.endswith("brep") else write_labelled(tmp_path / name, parts)
    )
    renamed = tmp_path / "model.txt"
    renamed.write_bytes(written.read_bytes())
    assert format_of(renamed).suffixes[0] == written.suffix
    assert load_model(renamed).faces()


@pytest.mark.parametrize("ending", ["\n0\n", "\n0\n\n", "\r\n0\r\n"])
def test_brep_as_the_kernels_console_saves_it_is_read(tmp_path, faces, ending):
    plain = write_shape(tmp_path / "plain.brep", compound_of(faces))
    saved = tmp_path / "saved.brep"
    saved.write_bytes(b"DBRep_DrawableShape\n" + plain.read_bytes() + ending.encode())
    areas = [[sample_faces(face.face)[0].weights.sum() for face in load_model(file).faces()] for file in (plain, saved)]
    assert len(areas[0]) == len(faces)
    assert areas[0] == areas[1]
    broken = tmp_path / "broken.brep"
    broken.write_bytes(saved.read_bytes()[:-200] + ending.encode())
    with pytest.raises(ReferenceFileError, match=r"'broken.brep' breaks off before its end"):
        load_model(broken)


def test_every_format_has_its_own_name_and_endings():
    assert len({form.name for form in FORMATS}) == len(FORMATS)
    endings = [ending for form in FORMATS for ending in form.suffixes]
    assert len(set(endings)) == len(endings)


def test_model_far_away_is_moved_near_the_origin_by_whole_metres_and_says_so(tmp_path, faces):
    shift = gp_Trsf()
    shift.SetTranslation(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(8.3e8, -2.1e8, 0.0))
    path = write_shape(tmp_path / "map.brep", BRepBuilderAPI_Transform(compound_of(faces), shift, True).Shape())
    model = load_model(path, 1.0)
    assert any("km from its origin" in note and "-0)" not in note for note in model.notes)
    assert all(value % 1000.0 == 0.0 for value in model.origin)
    (moved,), (here,) = sample_faces(model.faces()[1].face), sample_faces(faces[1])
    np.testing.assert_allclose(moved.points + np.array(model.origin) - [8.3e8, -2.1e8, 0.0], here.points, atol=1e-4)
    near = load_model(write_shape(tmp_path / "near.brep", compound_of(faces)), 1.0)
    assert near.origin == (0.0, 0.0, 0.0)
    assert near.notes == ()


def test_model_at_hand_that_reaches_too_far_is_moved_until_it_does_not(tmp_path, faces):
    shift = gp_Trsf()
    shift.SetTranslation(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(9.995e6, 0.0, 0.0))
    path = write_shape(tmp_path / "edge.brep", BRepBuilderAPI_Transform(compound_of(faces), shift, True).Shape())
    assert load_model(path, 1.0).origin != (0.0, 0.0, 0.0)


@pytest.mark.parametrize("how", [{}, {"divide": 4}, {"faces": ("1-3",)}], ids=["whole", "cut", "chosen"])
def test_skin_too_large_for_panels_is_refused_when_it_is_read(tmp_path, faces, how):
    path = write_shape(tmp_path / "large.brep", compound_of(faces))
    with pytest.raises(
        ReferenceFileError, match=r"The skin in 'large.brep' reaches .* within 1e\+07 mm: look for a wr"
    ):
        raw_panels(load_model(path, 1e4), ReferenceSettings(**how))


def test_model_beyond_all_measure_is_refused(tmp_path, faces):
    path = write_shape(tmp_path / "stray.brep", compound_of(faces))
    with pytest.raises(ReferenceFileError, match="from the origin, farther than millimetres can be told apart"):
        load_model(path, 1e10)


def test_file_without_shapes_and_format_without_a_reader_are_refused(tmp_path):
    (tmp_path / "drawing.dxf").write_text("0\nSECTION\n")
    with pytest.raises(ReferenceFileError, match=r"is a DXF drawing: cadpanel reads STEP files .*IGES"):
        load_model(tmp_path / "drawing.dxf")


@pytest.mark.parametrize("name", ["model.iges", "model.brep"])
def test_file_that_breaks_off_is_refused(tmp_path, parts, name):
    path = tmp_path / name
    written = write_shape(path, parts[0][1]) if name.endswith("brep") else write_labelled(path, parts)
    text = written.read_bytes()
    path.write_bytes(text[: len(text) * 2 // 3])
    with pytest.raises(ReferenceFileError, match="breaks off before its end"):
        load_model(path)


def test_number_that_is_none_is_refused_with_its_line(tmp_path, faces):
    path = write_shape(tmp_path / "nan.brep", faces[0])
    lines = path.read_text().split("\n")
    place = next(index for index, line in enumerate(lines) if line.startswith("9 ") or re.match(r"9 1 ", line))
    lines[place] = re.sub(r"(\s)[-\d.e]+(\s)", r"\1nan\2", lines[place] + " ", count=1)
    path.write_text("\n".join(lines))
    with pytest.raises(ReferenceFileError, match=rf"not a number \(nan in line {place + 1}\)"):
        load_model(path)


def test_shapes_come_back_from_the_other_interpreter_to_the_last_digit(faces):
    for face, back in zip(faces, shapes_of(unpacked(packed(compound_of(faces))), TopAbs_FACE), strict=True):
        (there,), (here,) = sample_faces(back), sample_faces(face)
        np.testing.assert_array_equal(there.points, here.points)


def test_rhino_file_without_rhino3dm_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    with pytest.raises(ReferenceFileError, match=r"needs rhino3dm: install it with 'pip install cadpanel\[rhino\]'"):
        rhino.load_rhino3dm("roof.3dm")
