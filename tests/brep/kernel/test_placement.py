"""A skin is cut and sampled alike wherever its file puts it, and however the file says so."""

from typing import Any

import numpy as np
import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_Sewing, BRepBuilderAPI_Transform
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.gp import gp_Pln, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_VERTEX
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face

from cadpanel.brep.building.sheet import volume_of
from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.loading import load_model, load_reference
from cadpanel.brep.files.model import Products
from cadpanel.brep.files.step import read_products
from cadpanel.brep.kernel.placement import is_located, placed
from cadpanel.brep.kernel.shape_maps import ShapeSet
from cadpanel.brep.kernel.shapes import children, compound_of, packed, shapes_of
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.brep.read import read_raw_panels, read_reference
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.brep.survey import survey
from cadpanel.reference.settings import ReferenceSettings
from tests.placed_files import NOWHERE, PLACES, STRIP, curves, faces, write

pytestmark = pytest.mark.each_value_once

EXACT = 1e-9  # mm, and of normals
# What is searched for to within CLOSE comes out differently by less than that once the geometry itself is moved.
SEARCHED = 0.1 * CLOSE
WAYS: dict[str, dict[str, Any]] = {
    "ready-made": {},
    "chosen": {"faces": ("2-3",)},
    "divided": {"divide": 3},
    "lip": {"divide": 2, "lip": 700.0},
    "grid": {"grid": (2, 3)},
    "stations": {"stations": (1500.0, 4000.0)},
    "spine": {"stations": (1500.0, 4000.0), "spine": "line"},
    "network": {"network": "skin and curves"},
    "mesh": {"mesh": "mesh.obj"},
}
OF_BOTH = "network"
REACH = {"lip": SEARCHED, "network": SEARCHED, "mesh": SEARCHED}
# STEP puts products by AXIS2_PLACEMENT_3D, which is right-handed (ISO 10303-42): it cannot mirror one.
FORMATS = {
    suffix: [name for name, place in PLACES.items() if suffix != ".step" or not place.mirrors]
    for suffix in (".brep", ".step", ".igs", ".3dm")
}
EVERYWHERE = [(suffix, name) for suffix, names in FORMATS.items() for name in names]
# Every way is tried in some places from one format, and in one place, the hardest that it has, from the others.
TRIED = [(".brep", name) for name in ("idle", "mirrored in an assembly")]
TRIED += [(".step", "nested"), (".igs", "mirrored in an assembly"), (".3dm", "mirrored in an assembly")]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The strip and what cuts it in each format and place: written once, read often."""
    folder = tmp_path_factory.mktemp("placed")
    made = {}

    def given(suffix, name):
        if (suffix, name) not in made:
            place = PLACES.get(name)
            here = folder / f"{suffix[1:]} {name}"
            here.mkdir()
            shapes = {"skin": faces(), "line": curves()[1:], "skin and curves": (*faces(), *curves())}
            made[suffix, name] = {what: write(here / f"{what}{suffix}", own, place) for what, own in shapes.items()}
            made[suffix, name]["mesh.obj"] = mesh(here / "mesh.obj", place)
        return made[suffix, name]

    return given


@pytest.fixture(scope="module")
def plain(files):
    """The panels of the strip in no place, by format and way."""
    known = {}

    def given(suffix, way):
        if (suffix, way) not in known:
            known[suffix, way] = panels(files(suffix, "nowhere"), suffix, way)
        return known[suffix, way]

    return given


def mesh(path, place):
    """Four quads over the strip, 2 by 2."""
    u, v = np.meshgrid([0.0, 1.5, 3.0], [0.0, 0.5, 1.0], indexing="ij")
    corners = STRIP(u, v).reshape(-1, 3)
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in (corners if place is None else place.points(corners)).tolist()]
    rows += [f"f {k} {k + 1} {k + 4} {k + 3}" for k in (1, 2, 4, 5)]
    path.write_text("\n".join(rows))
    return path


def panels(own, suffix, way):
    return read_raw_panels(own["skin and curves" if way == OF_BOTH else "skin"], settings(own, suffix, way)).panels


def settings(own, suffix, way, **more):
    how = {key: own.get(value, value) if isinstance(value, str) else value for key, value in WAYS[way].items()}
    return ReferenceSettings(unit="mm" if suffix == ".brep" or way == "mesh" else None, **how, **more)


def assert_same(found, wanted, place, reach=EXACT, side=1.0):
    """The same panels in a place, their normals turned over where `side` is -1."""
    assert [panel.name for panel in found] == [panel.name for panel in wanted]
    for one, other in zip(wanted, found, strict=True):
        for own, there in zip(one.faces, other.faces, strict=True):
            np.testing.assert_allclose(there.points, place.points(own.points), atol=reach, rtol=0.0)
            np.testing.assert_allclose(there.normals, side * place.ways(own.normals), atol=reach, rtol=0.0)
            np.testing.assert_allclose(there.weights, own.weights, rtol=reach)
            for edge, edge_there in zip(own.edges, there.edges, strict=True):
                np.testing.assert_allclose(edge_there, place.points(edge), atol=reach, rtol=0.0)


def side_of(suffix, name):
    """A surface of IGES has no other side than that of its parameters, which a mirror turns over."""
    return float(np.sign(np.linalg.det(PLACES[name].whole))) if suffix == ".igs" else 1.0


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("suffix", "name"), TRIED)
def test_panels_are_the_same_wherever_the_skin_is_put(files, plain, suffix, name, way):
    found, wanted = panels(files(suffix, name), suffix, way), plain(suffix, way)
    assert_same(found, wanted, PLACES[name], REACH.get(way, EXACT), side_of(suffix, name))


@pytest.mark.parametrize("way", REACH)
def test_cuts_that_are_searched_for_are_those_of_geometry_that_stands_there_itself(files, way, tmp_path):
    place = PLACES["mirrored"]
    (location,) = place.locations()

    def there(shapes):
        whole = compound_of(shapes)
        return children(BRepBuilderAPI_Transform(whole, location.Transformation(), True).Shape())

    own = {
        "skin": write(tmp_path / "skin.brep", list(there(faces())), None),
        "mesh.obj": mesh(tmp_path / "m.obj", place),
    }
    own["skin and curves"] = write(tmp_path / "both.brep", list(there((*faces(), *curves()))), None)
    found = panels(files(".brep", "mirrored"), ".brep", way)
    assert_same(found, panels(own, ".brep", way), NOWHERE)


@pytest.mark.parametrize(("suffix", "name"), EVERYWHERE)
def test_no_shape_that_is_read_carries_a_location(files, plain, suffix, name):
    own = files(suffix, name)
    model = load_model(own["skin and curves"], settings(own, suffix, "ready-made").millimetres)
    assert not is_located(compound_of(part.shape for part in model.parts))
    assert (len(model.faces()), len(model.curves())) == (3, 2)
    found, wanted = panels(own, suffix, "ready-made"), plain(suffix, "ready-made")
    assert_same(found, wanted, PLACES[name], side=side_of(suffix, name))
    if suffix == ".step":
        products = load_reference(own["skin"], ReferenceSettings())
        assert isinstance(products, Products)
        assert not is_located(compound_of(product.shape for product in products.shapes))
        assert is_located(compound_of(product.shape for product in read_products(own["skin"], None).shapes))


@pytest.mark.parametrize(("suffix", "name"), [TRIED[1], TRIED[2]])
def test_skin_is_inspected_and_its_seams_are_parted_alike_wherever_it_is_put(files, suffix, name):
    here, there = (survey(files(suffix, where)["skin"]) for where in ("nowhere", name))
    said = [[(face.number, face.panel, face.kind, face.poles) for face in seen.faces] for seen in (here, there)]
    assert said[0] == said[1]
    for one, other in zip(here.faces, there.faces, strict=True):
        assert (one.area, *one.size) == pytest.approx((other.area, *other.size), rel=EXACT)
    seams = []
    for where in ("nowhere", name):
        own = files(suffix, where)
        reference = read_reference(own["skin"], settings(own, suffix, "mesh", junctions=True))
        seams.append({frozenset(seam.panels) for seam in reference.seams})
    assert seams[0] == seams[1]
    assert len(seams[0]) == 4


def test_file_that_is_read_twice_gives_the_same_bytes(files):
    path = files(".brep", "mirrored in an assembly")["skin and curves"]
    once, again = (packed(compound_of(part.shape for part in load_model(path, 1.0).parts)) for _ in range(2))
    assert once == again


def sewn():
    sewing = BRepBuilderAPI_Sewing(1e-3)
    for face in faces():
        sewing.Add(face)
    sewing.Perform()
    return sewing.SewedShape()


def prism():
    """The kernel gives its far side by locations: edges that are the near side's, moved."""
    return BRepPrimAPI_MakePrism(
        BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 10.0, 0.0, 20.0).Face(), gp_Vec(1, 2, 30)
    ).Shape()


SHAPES = {
    "cylinder": lambda: BRepPrimAPI_MakeCylinder(10.0, 20.0).Shape(),
    "cone": lambda: BRepPrimAPI_MakeCone(10.0, 0.0, 20.0).Shape(),
    "sphere": lambda: BRepPrimAPI_MakeSphere(10.0).Shape(),
    "torus": lambda: BRepPrimAPI_MakeTorus(20.0, 5.0).Shape(),
    "prism": prism,
    "strip": sewn,
}


def scaling():
    found = gp_Trsf()
    found.SetScale(gp_Pnt(1.0, 2.0, 3.0), -2.5)
    return found


MOVES = {
    "idle": gp_Trsf(),
    "turned": PLACES["turned"].locations()[0].Transformation(),
    "mirrored": PLACES["mirrored"].locations()[0].Transformation(),
    "larger and mirrored": scaling(),
}
STEP_ASIDE = PLACES["shifted"].locations()[0]


def numbers(shape):
    """How many faces, edges and vertices there are, what is shared counted once."""
    return [len(ShapeSet(shapes_of(shape, kind))) for kind in (TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX)]


def tolerances(shape):
    return [BRep_Tool.Tolerance_s(TopoDS.Edge_s(edge)) for edge in shapes_of(shape, TopAbs_EDGE)]


def sampled(shape):
    return [sample_faces(face) for face in shapes_of(shape, TopAbs_FACE)]


@pytest.mark.parametrize("move", MOVES)
@pytest.mark.parametrize("made", SHAPES)
def test_placed_shape_is_the_moved_one_and_shares_what_was_shared(made, move):
    shape, trsf = SHAPES[made](), MOVES[move]
    location, unlocated = TopLoc_Location(trsf), placed(shape)
    nested = compound_of([shape.Moved(STEP_ASIDE), shape.Moved(location), shape.Moved(STEP_ASIDE)]).Moved(location)
    found = placed(nested)
    assert not is_located(found)
    assert BRepCheck_Analyzer(found, True, False, True).IsValid()
    assert numbers(found) == numbers(nested)
    first, second, third = children(found)
    assert first.IsSame(third)
    assert not first.IsSame(second)
    moved = [
        BRepBuilderAPI_Transform(compound_of([unlocated]), by, True).Shape()
        for by in (trsf.Multiplied(STEP_ASIDE.Transformation()), trsf.Multiplied(trsf))
    ]
    for one, other in zip((first, second), moved, strict=True):
        assert area_of(one) == pytest.approx(area_of(other), rel=EXACT)
        if made != "strip":
            assert volume_of(one) == pytest.approx(volume_of(other), rel=EXACT)
        for (own,), (there,) in zip(sampled(one), sampled(other), strict=True):
            np.testing.assert_allclose(own.points, there.points, atol=EXACT * 10.0, rtol=0.0)
            np.testing.assert_allclose(own.normals, there.normals, atol=EXACT, rtol=0.0)
        np.testing.assert_allclose(tolerances(one), tolerances(other))


@pytest.mark.parametrize("move", MOVES)
def test_faces_that_are_moved_one_by_one_go_on_sharing_their_edges(move):
    location, whole = TopLoc_Location(MOVES[move]), sewn()
    apart = compound_of(face.Moved(location) for face in shapes_of(whole, TopAbs_FACE))
    assert numbers(placed(apart)) == numbers(whole)


def test_marks_of_faces_and_edges_are_kept():
    face = TopoDS.Face_s(faces()[0])
    copy = BRepBuilderAPI_Transform(compound_of([face]), gp_Trsf(), True).Shape()
    for marked in (True, False):
        own = TopoDS.Face_s(shapes_of(copy, TopAbs_FACE)[0])
        edge = TopoDS.Edge_s(shapes_of(copy, TopAbs_EDGE)[0])
        BRep_Builder().NaturalRestriction(own, marked)
        BRep_Builder().SameParameter(edge, marked)
        BRep_Builder().SameRange(edge, marked)
        found = placed(copy.Moved(STEP_ASIDE))
        there = TopoDS.Edge_s(shapes_of(found, TopAbs_EDGE)[0])
        assert BRep_Tool.NaturalRestriction_s(TopoDS.Face_s(shapes_of(found, TopAbs_FACE)[0])) is marked
        assert (BRep_Tool.SameParameter_s(there), BRep_Tool.SameRange_s(there)) == (marked, marked)


@pytest.mark.parametrize("made", [made for made in SHAPES if made != "prism"])
def test_shape_without_a_location_is_left_as_it_is(made):
    shape = SHAPES[made]()
    assert not is_located(shape)
    assert placed(shape).IsEqual(shape)


def test_location_is_found_wherever_it_stands():
    idle, surface = TopLoc_Location(gp_Trsf()), BRep_Tool.Surface_s(TopoDS.Face_s(faces()[0]))
    beneath = TopoDS_Face()
    BRep_Builder().MakeFace(beneath, surface, STEP_ASIDE, 1e-7)
    for shape in (faces()[0].Moved(idle), curves()[0].Moved(STEP_ASIDE), compound_of([prism()]), beneath):
        assert is_located(shape)
        assert not is_located(placed(shape))
