import re

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.Geom2d import Geom2d_Ellipse
from OCP.gp import gp_Ax2d, gp_Dir2d, gp_Pnt, gp_Pnt2d
from OCP.ShapeFix import ShapeFix_Face
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.faces.pcurve_repair import sharpen_trims
from cadpanel.brep.files import opennurbs
from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.brep.survey import survey
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.rhino_files import bent_surface, file_in, off_border, rhino, written

EXACT = 1e-9
TRIMMED = 1e-6  # part of the area of a face whose border is projected to 1e-4 mm


def assert_same_surface(face, source, factor=1.0):
    patch = patch_of(face)
    for part_u in (0.0, 0.13, 0.5, 0.77, 1.0):
        for part_v in (0.0, 0.31, 1.0):
            u, v = (d.T0 + p * (d.T1 - d.T0) for d, p in ((source.Domain(0), part_u), (source.Domain(1), part_v)))
            point = source.PointAt(u, v)
            wanted = factor * np.array([point.X, point.Y, point.Z])
            np.testing.assert_allclose(patch.points(np.array([u, v])), wanted, atol=EXACT * max(1.0, factor))


@pytest.mark.parametrize("rational", [False, True])
def test_nurbs_surface_is_the_same_in_every_point(tmp_path, rational):
    file, surface = file_in(), bent_surface(rational=rational)
    file.Objects.AddSurface(surface)
    (face,) = load_model(written(tmp_path / "surface.3dm", file)).faces()
    assert_same_surface(face.face, surface)


@pytest.mark.parametrize(
    ("unit", "word", "factor"),
    [
        ("Millimeters", "millimetre", 1.0),
        ("Meters", "metre", 1000.0),
        ("Inches", "inch", 25.4),
        ("Feet", "foot", 304.8),
    ],
)
def test_model_units_become_millimetres(tmp_path, unit, word, factor):
    file, surface = file_in(unit), bent_surface(length=9.0)
    file.Objects.AddSurface(surface)
    path = written(tmp_path / "units.3dm", file)
    model = load_model(path)
    assert model.unit == word
    assert_same_surface(model.faces()[0].face, surface, factor)
    with pytest.raises(ReferenceFileError, match=rf"says itself that its unit is the {word}:"):
        load_model(path, 10.0)


def test_model_without_a_unit_needs_one(tmp_path):
    file = file_in("None")
    file.Objects.AddSurface(bent_surface())
    path = written(tmp_path / "none.3dm", file)
    with pytest.raises(ReferenceFileError, match="has no unit that can be converted"):
        load_model(path)
    assert load_model(path, 1000.0).unit == "none, read as 1000 mm"


def test_solid_of_rhino_is_trimmed_and_closed(tmp_path):
    file = file_in()
    cylinder = rhino.Cylinder(rhino.Circle(rhino.Point3d(0.0, 0.0, 0.0), 500.0), 2000.0)
    file.Objects.AddBrep(rhino.Brep.CreateFromCylinder(cylinder, True, True))
    file.Objects.AddBrep(rhino.Brep.CreateFromSphere(rhino.Sphere(rhino.Point3d(5000.0, 0.0, 0.0), 300.0)))
    model = load_model(written(tmp_path / "solids.3dm", file))
    assert all(BRepCheck_Analyzer(part.shape).IsValid() for part in model.parts)
    areas = sorted(area_of(face) for face in shapes_of(model.parts[0].shape, TopAbs_FACE))
    assert areas == pytest.approx([np.pi * 500.0**2] * 2 + [2.0 * np.pi * 500.0 * 2000.0], rel=TRIMMED)
    assert area_of(model.parts[1].shape) == pytest.approx(4.0 * np.pi * 300.0**2, rel=TRIMMED)


@pytest.mark.parametrize(("unit", "factor"), [("Millimeters", 1.0), ("Meters", 1000.0), ("Inches", 25.4)])
def test_borders_run_along_their_edges_whatever_the_unit(tmp_path, unit, factor):
    file, size = file_in(unit), 1.0 / factor
    circle = rhino.Circle(rhino.Point3d(0.0, 0.0, 0.0), 500.0 * size)
    file.Objects.AddBrep(rhino.Brep.CreateFromCylinder(rhino.Cylinder(circle, 2000.0 * size), True, True))
    corners = ((0.0, 0.0), (900.0, 0.0), (1300.0, 700.0), (200.0, 900.0), (-300.0, 400.0), (0.0, 0.0))
    drop = rhino.Curve.CreateControlPointCurve([rhino.Point3d(x * size, y * size, 0.0) for x, y in corners], 3)
    file.Objects.AddExtrusion(rhino.Extrusion.Create(drop, 600.0 * size, True))
    border = circle.ToNurbsCurve()
    border.Scale(1.4)
    file.Objects.AddBrep(rhino.Brep.CreateTrimmedPlane(rhino.Plane.WorldXY(), border))
    model = load_model(written(tmp_path / "trimmed.3dm", file))
    assert all(BRepCheck_Analyzer(part.shape).IsValid() for part in model.parts)
    assert max(off_border(face.face) for face in model.faces()) <= 1e-4


@pytest.mark.parametrize("factor", [1.0, 1e-3])
def test_border_on_a_curved_surface_runs_along_its_edge(factor):
    surface = opennurbs.surface(bent_surface())
    hole = Geom2d_Ellipse(gp_Ax2d(gp_Pnt2d(0.5, 0.5), gp_Dir2d(1.0, 0.4)), 0.35, 0.2)
    flat = BRepBuilderAPI_MakeEdge(hole, surface).Edge()
    BRepLib.BuildCurves3d_s(flat)
    # Read, an edge is known by its curve in space only.
    drawn = BRep_Tool.Curve_s(flat, 0.0, 1.0)
    for geometry in (surface, drawn):
        geometry.Scale(gp_Pnt(0.0, 0.0, 0.0), factor)
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(drawn).Edge()).Wire()
    fixing = ShapeFix_Face(BRepBuilderAPI_MakeFace(surface, wire, True).Face())
    fixing.Perform()
    fixing.FixOrientation()
    face = fixing.Face()
    BRepLib.SameParameter_s(face, 1e-7, True)
    (face,) = map(TopoDS.Face_s, shapes_of(scaled(face, 1.0 / factor), TopAbs_FACE))
    assert off_border(face) > 1e-3
    sharpen_trims(face)
    assert BRepCheck_Analyzer(face).IsValid()
    assert off_border(face) <= 1e-4


def test_trimmed_plane_keeps_its_outline(tmp_path):
    file = file_in()
    circle = rhino.Circle(rhino.Point3d(0.0, 0.0, 0.0), 700.0).ToNurbsCurve()
    file.Objects.AddBrep(rhino.Brep.CreateTrimmedPlane(rhino.Plane.WorldXY(), circle))
    (face,) = load_model(written(tmp_path / "disc.3dm", file)).faces()
    assert area_of(face.face) == pytest.approx(np.pi * 700.0**2, rel=TRIMMED)


@pytest.mark.parametrize(
    "far_corners",
    [
        ((500.0, 1000.0, 0.0), (3500.0, 1000.0, 0.0)),
        ((-2000.0, 1000.0, 0.0), (1000.0, 1000.0, 0.0)),
        ((-400.0, 1000.0, 0.0), (3400.0, 1000.0, 0.0)),
        ((-400.0, 1000.0, 300.0), (3400.0, 1000.0, -100.0)),
    ],
    ids=["parallelogram", "slender parallelogram", "trapezoid", "hypar"],
)
def test_polysurface_whose_face_is_no_rectangle_is_the_same_in_every_point(tmp_path, far_corners):
    surface = rhino.NurbsSurface.Create(3, False, 2, 2, 2, 2)
    for knots in (surface.KnotsU, surface.KnotsV):
        knots[0], knots[1] = 0.0, 1.0
    for j, row in enumerate((((0.0, 0.0, 0.0), (3000.0, 0.0, 0.0)), far_corners)):
        for i, point in enumerate(row):
            surface.Points[i, j] = rhino.Point4d(*point, 1.0)
    file = file_in()
    file.Objects.AddBrep(rhino.Brep.CreateFromSurface(surface))
    (face,) = load_model(written(tmp_path / "quad.3dm", file)).faces()
    assert patch_of(face.face).whole
    assert_same_surface(face.face, surface)


def placed_once(geometry, transform):
    """A file with a block of one object, placed once."""
    file = file_in()
    file.InstanceDefinitions.Add(
        "panel", "", "", "", rhino.Point3d(0.0, 0.0, 0.0), (geometry,), (rhino.ObjectAttributes(),)
    )
    file.Objects.AddInstanceObject(rhino.InstanceReference(file.InstanceDefinitions[0].Id, transform))
    return file


def test_sheared_block_of_a_polysurface_is_sheared(tmp_path):
    surface, shear = bent_surface(), rhino.Transform(1.0)
    shear.M02 = 1.0
    file = placed_once(rhino.Brep.CreateFromSurface(surface), shear)
    (face,) = load_model(written(tmp_path / "sheared.3dm", file)).faces()
    assert surface.Transform(shear)
    assert_same_surface(face.face, surface)


@pytest.mark.parametrize(("entry", "value"), [("M22", 0.0), ("M33", 0.0), ("M03", float("nan"))])
def test_faces_of_a_block_that_rhino_cannot_place_are_left_out(tmp_path, entry, value):
    arc = rhino.Arc(rhino.Circle(rhino.Point3d(0.0, 0.0, 0.0), 500.0), 1.5)
    extrusion = rhino.Extrusion.Create(rhino.NurbsCurve.CreateFromArc(arc), 3000.0, False)
    transform = rhino.Transform(1.0)
    setattr(transform, entry, value)
    path = written(tmp_path / "flattened.3dm", placed_once(extrusion, transform))
    (note,) = survey(path).notes
    assert re.fullmatch(r"Face 1 of 'flattened.3dm' cannot be read and is left out: it cannot be placed as .*", note)
    with pytest.raises(ReferenceFileError, match=r"'flattened.3dm' holds no face .* placed as its block says"):
        read_raw_panels(path)


def test_names_layers_and_colors_choose_faces_and_hidden_things_stay_out(tmp_path):
    file = file_in()
    for name, color, visible in (("Skin", (10, 20, 30, 255), True), ("Off", (0, 0, 0, 255), False)):
        layer = rhino.Layer()
        layer.Name, layer.Color, layer.Visible = name, color, visible
        file.Layers.Add(layer)
    layers = {layer.Name: layer.Index for layer in file.Layers}
    for name, layer, x in (("roof", "Skin", 0.0), ("old roof", "Off", 0.0), ("wall", "Skin", 20_000.0)):
        attributes, surface = rhino.ObjectAttributes(), bent_surface()
        attributes.Name, attributes.LayerIndex = name, layers[layer]
        if name == "wall":
            attributes.ColorSource = rhino.ObjectColorSource.ColorFromObject
            attributes.ObjectColor = (255, 0, 0, 255)
        surface.Translate(rhino.Vector3d(x, 0.0, 0.0))
        file.Objects.AddSurface(surface, attributes)
    file.Objects.AddPoint(1.0, 2.0, 3.0)
    model = load_model(written(tmp_path / "layers.3dm", file))
    assert [(f.label.name, f.label.layer, f.label.color) for f in model.faces()] == [
        ("roof", "Skin", "#0a141e"),
        ("wall", "Skin", "#ff0000"),
    ]
    assert [face.number for face in select_faces(model, ("color=#ff0000",))] == [2]
    assert any("1 x hidden object left out" in note for note in model.notes)
    assert any("1 x Point" in note for note in model.notes)


@pytest.mark.parametrize("off", [(), ("A",), ("A::B",), ("C",), ("A::B::D",)])
def test_layer_is_hidden_where_one_that_it_lies_below_is(tmp_path, off):
    file, ids = file_in(), {"": None}
    for path in ("A", "A::B", "A::B::D", "C"):
        above, _, name = path.rpartition("::")
        layer = rhino.Layer()
        layer.Name, layer.Visible = name, path not in off
        if above:
            layer.ParentLayerId = ids[above]
        index = file.Layers.Add(layer)
        ids[path] = file.Layers.FindIndex(index).Id
        attributes = rhino.ObjectAttributes()
        attributes.Name, attributes.LayerIndex = path, index
        file.Objects.AddSurface(bent_surface(), attributes)
    model = load_model(written(tmp_path / "layers.3dm", file))
    shown = [path for path in ids if path and not any(f"{path}::".startswith(f"{hidden}::") for hidden in off)]
    assert [face.label.name for face in model.faces()] == shown


def test_file_of_meshes_only_is_refused_with_what_to_do_and_beside_surfaces_they_are_noted(tmp_path):
    mesh = rhino.Mesh()
    for corner in ((0.0, 0.0, 0.0), (1000.0, 0.0, 0.0), (0.0, 1000.0, 0.0)):
        mesh.Vertices.Add(*corner)
    mesh.Faces.AddFace(0, 1, 2)
    file = file_in()
    file.Objects.AddMesh(mesh)
    said = r"1 x Mesh \(meshes are not read: convert it to NURBS, or give it as OBJ with --mesh over a surface\)"
    with pytest.raises(ReferenceFileError, match=rf"'mesh.3dm' holds neither faces nor curves .* left out, {said}"):
        load_model(written(tmp_path / "mesh.3dm", file))
    file.Objects.AddSurface(bent_surface())
    (note,) = load_model(written(tmp_path / "both.3dm", file)).notes
    assert re.fullmatch(rf"'both.3dm': {said} left out\.", note)


def test_surface_and_curves_of_one_file_make_panels(tmp_path):
    file = file_in()
    surface = bent_surface()
    file.Objects.AddSurface(surface)
    for x in (0.25, 0.5, 0.75):
        file.Objects.AddCurve(surface.IsoCurve(0, x))
    path = written(tmp_path / "panels.3dm", file)
    assert len(read_raw_panels(path, ReferenceSettings(divide=6)).panels) == 6
    found = read_raw_panels(path, ReferenceSettings(network=path))
    assert len(found.panels) == 4


def test_file_that_is_cut_off_is_refused(tmp_path):
    file = file_in()
    file.Objects.AddSurface(bent_surface())
    path = written(tmp_path / "whole.3dm", file)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 3])
    with pytest.raises(ReferenceFileError, match=r"whole.3dm"):
        load_model(path)


def test_control_point_without_weight_and_knots_that_fall_are_refused():
    with pytest.raises(opennurbs.ConversionError, match="weight is not positive"):
        opennurbs._from_homogeneous(np.array([[1.0, 2.0, 3.0, 0.0]]))
    with pytest.raises(opennurbs.ConversionError, match="knots do not rise"):
        opennurbs._knots([0.0, 1.0, 0.5], 1)
