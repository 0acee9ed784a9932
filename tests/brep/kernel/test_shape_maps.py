"""Shapes are told apart by themselves: two of them may share a hash, and here all of them do."""

import ast
from pathlib import Path

import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.gp import gp_Trsf, gp_Vec
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

import cadpanel.brep
from cadpanel.brep.cutting.raw_panels import raw_panels
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.files.step import STEP
from cadpanel.brep.kernel.shape_maps import ShapeMap, ShapeSet
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import write_labelled, write_shape
from tests.placed_files import curves, faces


@pytest.fixture
def one_hash(monkeypatch):
    """Every shape has the same hash, as far as Python is told."""
    monkeypatch.setattr(TopoDS_Shape, "__hash__", lambda _shape: 7)
    first, second = shapes_of(box(), TopAbs_FACE)[:2]
    assert hash(first) == hash(second)


def box(size=1.0):
    return BRepPrimAPI_MakeBox(size, size, size).Shape()


@pytest.mark.usefixtures("one_hash")
def test_set_holds_each_shape_once_in_its_order_whichever_way_it_is_turned():
    edges = shapes_of(box(), TopAbs_EDGE)
    found = ShapeSet(edges)
    assert (len(edges), len(found)) == (24, 12)
    assert all(edge.Reversed() in found for edge in edges)
    assert all(edge not in found for edge in shapes_of(box(), TopAbs_EDGE))
    alone = ShapeSet()
    assert edges[0] not in alone
    for edge in (edges[5], edges[0], edges[5].Reversed()):
        alone.add(edge)
    assert [edge.IsEqual(wanted) for edge, wanted in zip(alone, (edges[5], edges[0]), strict=True)] == [True, True]


def test_set_tells_a_shape_in_another_place_apart():
    moving = gp_Trsf()
    moving.SetTranslation(gp_Vec(1.0, 0.0, 0.0))
    shape, place = box(), TopLoc_Location(moving)
    found = ShapeSet([shape])
    assert shape.Moved(place) not in found
    found.add(shape.Moved(place))
    assert shape.Moved(place).Reversed() in found
    assert len(found) == 2


@pytest.mark.usefixtures("one_hash")
def test_map_is_a_dictionary_of_shapes():
    first, second, third = shapes_of(box(), TopAbs_FACE)[:3]
    found: ShapeMap[str] = ShapeMap()
    found[first], found[second] = "one", "two"
    found[first.Reversed()] = "one again"
    assert found.setdefault(second, "three") == "two"
    assert found.get(third, "none") == "none"
    assert third not in found
    assert found.setdefault(third, "three") == "three"
    assert [value for _, value in found.items()] == list(found.values()) == ["one again", "two", "three"]
    assert [key.IsEqual(face) for key, face in zip(found, (first, second, third), strict=True)] == [True] * 3
    assert (len(found), found[first]) == (3, "one again")
    with pytest.raises(KeyError):
        found[box()]


def test_strip_is_cut_alike_when_its_edges_share_a_hash(tmp_path, request):
    path = write_shape(tmp_path / "both.brep", compound_of([*faces(), *curves()]))
    how = ReferenceSettings(unit="mm", network=path)
    wanted = raw_panels(path, how).panels
    request.getfixturevalue("one_hash")
    found = raw_panels(path, how).panels
    assert [panel.name for panel in found] == [panel.name for panel in wanted]
    assert [len(panel.faces) for panel in found] == [len(panel.faces) for panel in wanted]
    assert len(found) == 4


@pytest.mark.usefixtures("one_hash")
def test_labels_stay_with_their_faces_when_these_share_a_hash(tmp_path):
    said = [Label(name=f"bend {place}", color=f"#0000{place}0") for place in range(3)]
    inner = list(zip(said, faces(), strict=True))
    path = write_labelled(tmp_path / "labels.step", [(Label(name="skin"), compound_of(faces()), inner)])
    (part,) = STEP.read(path, None).parts
    assert part.face_labels == tuple(said)


@pytest.mark.usefixtures("one_hash")
def test_face_beside_a_solid_is_not_of_it_though_they_share_a_hash():
    parts = compound_of([box(), faces()[0]])
    part = Part(label=Label(), shape=parts, face_labels=(Label(),) * 7)
    model = Model(source="box", format="none", unit="mm", parts=(part,))
    assert [face.of_solid for face in model.faces()] == [True] * 6 + [False]


def test_no_module_takes_a_hash_for_a_shape():
    """Nobody in the CAD side asks for a hash at all; `ShapeMap` and `ShapeSet` are there for it."""
    modules = sorted(Path(cadpanel.brep.__file__).parent.rglob("*.py"))
    calls = [
        f"{module.name}:{node.lineno}"
        for module in modules
        for node in ast.walk(ast.parse(module.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "hash"
    ]
    assert len(modules) > 50
    assert calls == []
