"""Ready-made panels are called alike wherever they are told of, and can be chosen by all that they are called."""

import numpy as np
import pytest

from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Label
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.survey import survey
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import strip_faces, write_labelled
from tests.named_products import nested
from tests.reference_shapes import compound, kernel_lip, strip, write_plain, write_products
from tests.thorough import cases


def sheets(path, name="Roof"):
    """One product that holds several panels."""
    return write_products(path, [(name, compound(kernel_lip(lip) for lip in strip(3)))])


def pieces(path):
    """An assembly of the nameless faces of each panel, as build123d writes a compound of faces."""
    import build123d as bd

    panels = [bd.Compound(kernel_lip(lip), label=f"lip {place}") for place, lip in enumerate(strip(2))]
    bd.export_step(bd.Compound(children=panels, label="roof"), path)
    return path


def faces_with_names(path):
    faces = strip_faces()
    inner = [(Label(name=f"bend {place}"), face) for place, face in enumerate(faces)]
    return write_labelled(path, [(Label(name="Skin"), compound(faces), inner)])


FILES = {
    "nested": nested,
    "nested, nameless": lambda path: nested(path, product="", instances=("inst0", "")),
    "sheets": sheets,
    "pieces": pieces,
    "faces with names": faces_with_names,
    "products": lambda path: write_products(path, [(f"P{k}", kernel_lip(lip)) for k, lip in enumerate(strip(3))]),
    "twins": lambda path: write_products(path, [("lip", kernel_lip(lip)) for lip in strip(3)]),
    "plain": lambda path: write_plain(path, *(kernel_lip(lip) for lip in strip(3))),
    "plain compound": lambda path: write_plain(path, compound(kernel_lip(lip) for lip in strip(3))),
}


def areas(found):
    return {panel.name: sum(float(face.weights.sum()) for face in panel.faces) for panel in found.panels}


@pytest.mark.parametrize("made", cases([*FILES][::3], [*FILES]))
def test_panels_are_called_alike_whichever_way_they_are_read_and_when_inspected(tmp_path, made):
    path = FILES[made](tmp_path / "file.step")
    ready, seen = read_raw_panels(path), survey(path)
    inspected = {name: sum(face.area for face in seen.faces if face.panel == name) for name in areas(ready)}
    assert {face.panel for face in seen.faces} == set(inspected)
    chosen = read_raw_panels(path, ReferenceSettings(faces=(f"1-{len(seen.faces)}",)))
    for other in (inspected, areas(chosen)):
        assert list(other) == list(areas(ready))
        np.testing.assert_allclose(list(other.values()), list(areas(ready).values()), rtol=1e-5)


@pytest.mark.parametrize("made", FILES)
def test_each_panel_is_chosen_by_what_it_is_called(tmp_path, made):
    path = FILES[made](tmp_path / "file.step")
    model = load_model(path)
    for name in areas(read_raw_panels(path)):
        numbers = {face.number for face in model.faces() if face.panel == name}
        found = {face.number for face in select_faces(model, (f"name={name}",))}
        assert numbers
        assert numbers <= found  # of several with one name in the file, all


def test_faces_are_chosen_by_product_instance_or_name_of_their_own(tmp_path):
    model = load_model(nested(tmp_path / "nested.step"))
    for word, count in (("Panel", 18), ("inst0", 9), ("inst1", 9), ("inst1 (2)", 3), ("inst*", 18)):
        assert len(select_faces(model, (word,))) == count
    model = load_model(faces_with_names(tmp_path / "names.step"))
    for word, numbers in (("Skin", [1, 2, 3]), ("bend 1", [2]), ("bend*", [1, 2, 3])):
        assert [face.number for face in select_faces(model, (word,))] == numbers
    with pytest.raises(ReferenceFileError, match="has no face 'roof': it has faces 1 to 3; names Skin, bend 0, bend 1"):
        select_faces(model, ("roof",))
