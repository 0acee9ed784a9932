"""Faults that the kernel notes and would pass over: of syntax, and of what shapes are made of; never of names."""

import pytest
from OCP.IFSelect import IFSelect_RetDone
from OCP.STEPControl import STEPControl_Reader

from cadpanel.brep.files.step_damage import damage
from cadpanel.brep.kernel.messages import silence_kernel
from tests.model_files import strip_faces
from tests.reference_shapes import write_products


@pytest.fixture(scope="module")
def text(tmp_path_factory):
    path = write_products(tmp_path_factory.mktemp("damage") / "strip.step", [("strip", strip_faces(poles=6)[0])])
    return path.read_text()


def found(path, text):
    silence_kernel()
    path.write_text(text)
    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_RetDone
    return damage(reader.StepModel())


def test_a_sound_file_has_none(tmp_path, text):
    assert found(tmp_path / "sound.step", text) is None


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("CARTESIAN_POINT('',(", "CARTESIAN_POINT('',$,("),
        ("VERTEX_POINT('',", "VERTEX_POINT('',$,"),
        ("B_SPLINE_SURFACE_WITH_KNOTS('',", "B_SPLINE_SURFACE_WITH_KNOTS('',.T.,"),
    ],
)
def test_geometry_with_a_parameter_that_is_none_is_told_with_its_instance(tmp_path, text, old, new):
    assert old in text
    said = found(tmp_path / "damaged.step", text.replace(old, new, 1))
    assert said is not None
    assert said.startswith("instance ")


def test_a_name_that_is_no_text_is_let_through(tmp_path, text):
    changed = text.replace("VERTEX_POINT('',", "VERTEX_POINT(7,", 1)
    assert changed != text
    assert found(tmp_path / "name.step", changed) is None
