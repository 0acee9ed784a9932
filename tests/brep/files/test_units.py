"""Which unit a STEP or IGES file is read in, and that the user's counts for every file without one."""

import re

import numpy as np
import pytest

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.iges import UNITS
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Label
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.survey import survey
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import strip_faces, write_labelled
from tests.reference_shapes import write_products

MILLIMETRES = {1: 25.4, 2: 1.0, 4: 304.8, 6: 1000.0, 7: 1e6, 8: 0.0254, 9: 1e-3, 10: 10.0}


@pytest.fixture(scope="module")
def faces():
    return strip_faces()


def without_unit(path):
    """Strike the units out of a STEP file."""
    text, count = re.subn(r"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\([^)]*\)\)", "", path.read_text())
    assert count
    path.write_text(text)
    return path


def step_without_unit(folder, faces):
    return without_unit(write_products(folder / "bare.step", [(f"P{k}", face) for k, face in enumerate(faces)]))


def iges(folder, faces, flag, name, unit="MM"):
    """An IGES file with a unit flag and a unit name of its own."""
    path = write_labelled(folder / "said.iges", [(Label(name="Skin"), face, []) for face in faces], unit)
    lines = path.read_text().splitlines()
    header = [line for line in lines if line[72:73] == "G"]
    text = "".join(line[:72] for line in header).replace(
        ",2,2HMM,", f",{flag},{f'{len(name)}H{name}' if name else ''},"
    )
    changed = [f"{text[at : at + 72]:72}G{at // 72 + 1:7d}" for at in range(0, len(text), 72)]
    start = lines.index(header[0])
    lines[start : start + len(header)] = changed
    lines[-1] = re.sub(r"G\s*\d+D", f"G{len(changed):7d}D", lines[-1])
    path.write_text("\n".join(lines) + "\n")
    return path


def size(shapes):
    points = np.concatenate([sample.points for shape in shapes for sample in sample_faces(shape)])
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def model_size(path, millimetres=None):
    return size([face.face for face in load_model(path, millimetres).faces()])


@pytest.mark.parametrize(("unit", "factor"), [(None, 1.0), ("mm", 1.0), ("m", 1000.0), ("in", 25.4)])
@pytest.mark.parametrize("settings", [{}, {"faces": "*"}, {"divide": 3}], ids=["products", "faces", "cut"])
def test_step_without_a_unit_is_in_that_which_is_given_else_millimetres_with_a_note(
    tmp_path, faces, settings, unit, factor
):
    path = step_without_unit(tmp_path, faces)
    found = read_raw_panels(path, ReferenceSettings(unit=unit, **settings))
    points = np.concatenate([face.points for panel in found.panels for face in panel.faces])
    assert np.ptp(points[:, 0]) == pytest.approx(factor * 9000.0, rel=0.03)
    assert [note for note in found.notes if "does not say its unit; it is read as millimetres" in note] == (
        []
        if unit
        else [f"'{path.name}' does not say its unit; it is read as millimetres: give the unit if that is wrong."]
    )


def test_step_without_a_unit_says_so_when_it_is_inspected(tmp_path, faces):
    path = step_without_unit(tmp_path, faces)
    found = survey(path)
    assert found.unit == "none, read as millimetres"
    assert "'bare.step' does not say its unit" in found.notes[0]
    assert survey(path, ReferenceSettings(unit="m")).unit == "none, read as 1000 mm"


def test_the_unit_of_panels_counts_though_no_face_is_chosen(tmp_path, faces):
    path = write_products(tmp_path / "own.step", [(f"P{k}", face) for k, face in enumerate(faces)], "M")
    with pytest.raises(ReferenceFileError, match=r"'own.step' says itself that its unit is the metre: leave the unit"):
        read_raw_panels(path, ReferenceSettings(unit="in"))


@pytest.mark.parametrize("flag", MILLIMETRES)
def test_iges_flag_counts_whatever_its_name_says_and_a_name_that_differs_is_noted(tmp_path, faces, flag):
    word, names = UNITS[flag]
    for name in (names[0], names[0].lower(), "M" if flag != 6 else "KM", "CUBIT"):
        path = iges(tmp_path, faces, flag, name)
        model = load_model(path)
        assert model.unit == word
        assert model.own_unit
        assert model_size(path) == pytest.approx(MILLIMETRES[flag] * size(faces), rel=1e-3)
        noted = f"is in the unit {word}, and by name '{name}'; the flag counts."
        assert any(noted in note for note in model.notes) is (name.upper() not in names)
        with pytest.raises(ReferenceFileError, match=f"says itself that its unit is the {word}:"):
            load_model(path, 10.0)


@pytest.mark.parametrize("flag", MILLIMETRES)
@pytest.mark.parametrize("said", [3, ""])
def test_iges_name_counts_where_the_flag_leaves_it_to_it(tmp_path, faces, flag, said):
    word, names = UNITS[flag]
    for name in (*names, names[-1].lower()) if said == 3 else names:
        path = iges(tmp_path, faces, said, name)
        model = load_model(path)
        assert model.unit == word
        assert not any("unit" in note for note in model.notes)
        assert model_size(path) == pytest.approx(MILLIMETRES[flag] * size(faces), rel=1e-3)


@pytest.mark.parametrize("flag", [3, 0, "", 1])
def test_iges_that_names_no_unit_is_in_inches_with_a_note_or_in_that_which_is_given(tmp_path, faces, flag):
    path = iges(tmp_path, faces, flag, "")
    model = load_model(path)
    assert model.unit == "inch"
    assert "does not name its unit, which in IGES stands for inches" in model.notes[0]
    assert model_size(path) == pytest.approx(25.4 * size(faces), rel=1e-3)
    given = load_model(path, 1000.0)
    assert (given.unit, given.notes) == ("none, read as 1000 mm", ())
    assert model_size(path, 1000.0) == pytest.approx(1000.0 * size(faces), rel=1e-6)


@pytest.mark.parametrize("flag", [2, 6])
def test_iges_flag_needs_no_name(tmp_path, faces, flag):
    model = load_model(iges(tmp_path, faces, flag, ""))
    assert (model.unit, model.notes, model.own_unit) == (UNITS[flag][0], (), True)


@pytest.mark.parametrize(
    ("flag", "name", "what"), [(3, "CUBIT", "that it calls 'CUBIT'"), (99, "MM", "with the flag 99")]
)
def test_iges_unit_that_there_is_not_needs_one(tmp_path, faces, flag, name, what):
    path = iges(tmp_path, faces, flag, name)
    with pytest.raises(ReferenceFileError, match=f"is in a unit {what}, which IGES does not have: give the unit"):
        load_model(path)
    assert model_size(path, 10.0) == pytest.approx(10.0 * size(faces), rel=1e-6)
