"""Faces that the kernel cannot make are left out with a note, unless they were chosen; nothing is lost in silence."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing

from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Label
from cadpanel.brep.files.step import read_products
from cadpanel.errors import ReferenceFileError
from tests.model_files import Labelled, strip_faces, write_labelled

# A degree that no surface of so few poles has; and knots that go up and down.
STEP_FAULT = (r"(B_SPLINE_SURFACE_WITH_KNOTS\('',)\d+", r"\g<1>300")
IGES_FAULT = (r"(128,3,3,3,3,0,0,1,0,0,)0\.,0\.,0\.,0\.,", r"\g<1>9.,0.,9.,0.,")


def damaged(path: Path, parts: Sequence[Labelled], fault: tuple[str, str]) -> Path:
    """A file whose first surface is damaged."""
    text, count = re.subn(*fault, write_labelled(path, parts).read_text(), count=1)
    assert count == 1
    path.write_text(text)
    return path


def products(name: str = "N") -> list[Labelled]:
    return [(Label(name=f"{name} {place}"), face, ()) for place, face in enumerate(strip_faces())]


def test_a_product_of_which_a_face_is_lost_is_left_out_of_panels_and_told(tmp_path: Path) -> None:
    path = damaged(tmp_path / "a.step", products("Süd"), STEP_FAULT)
    found = read_products(path)
    assert [one.name for one in found.shapes] == ["Süd 1", "Süd 2"]
    (note,) = found.notes
    assert note.startswith("Panel 'Süd 0' of 'a.step' is left out, as a face of it cannot be read")


def test_a_lost_face_of_a_shell_is_told_under_its_products_name_and_refused_where_it_is_chosen(tmp_path: Path) -> None:
    sewing = BRepBuilderAPI_Sewing(1e-3)
    for face in strip_faces():
        sewing.Add(face)
    sewing.Perform()
    shell = [(Label(name="lip"), sewing.SewedShape(), ()), (Label(name="other"), strip_faces()[0], ())]
    model = load_model(damaged(tmp_path / "a.step", shell, STEP_FAULT))
    assert len(model.faces()) == 3
    assert [(lost.number, lost.panel) for lost in model.unreadable()] == [(3, "lip")]
    assert any(note.startswith("Face 3 of 'a.step' cannot be read and is left out") for note in model.notes)
    assert len(select_faces(model, ("name=other",))) == 1
    with pytest.raises(ReferenceFileError, match="is chosen, and cannot be read"):
        select_faces(model, ("name=lip",))


def test_a_surface_of_an_iges_file_that_cannot_be_made_is_left_out_and_told(tmp_path: Path) -> None:
    model = load_model(damaged(tmp_path / "a.iges", products(), IGES_FAULT))
    assert len(model.faces()) == 2
    assert [lost.number for lost in model.unreadable()] == [3]


def test_where_a_curve_fails_a_face_might_be_cut_otherwise_and_the_file_is_refused(tmp_path: Path) -> None:
    path = write_labelled(tmp_path / "a.step", products())
    text, count = re.subn(r"(B_SPLINE_CURVE_WITH_KNOTS\('',)\d+", r"\g<1>300", path.read_text(), count=1)
    assert count == 1
    path.write_text(text)
    with pytest.raises(ReferenceFileError, match="a shape that the CAD kernel cannot read"):
        read_products(path)
