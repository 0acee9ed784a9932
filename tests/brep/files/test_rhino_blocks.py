"""What stands in a Rhino block is stretched, sheared and mirrored as the block is, whatever kind of object it is."""

import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.reference.settings import ReferenceSettings
from tests.rhino_files import bent_surface, file_in, off_border, written

pytestmark = pytest.mark.each_value_once

rhino = pytest.importorskip("rhino3dm")
TURN = 2.0 * np.pi
# How closely the kernel integrates over an ellipse, whatever it is asked; points are exact.
INTEGRATED = 3e-5
ORIGIN = rhino.Point3d(0.0, 0.0, 0.0)


def turned(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def sheared(row, column, by):
    matrix = np.eye(3)
    matrix[row, column] = by
    return matrix


PLACES = {
    "as it is": np.eye(3),
    "turned": turned(30.0),
    "mirrored": np.diag([-1.0, 1.0, 1.0]),
    "twice as large": np.diag([2.0, 2.0, 2.0]),
    "1:2:1": np.diag([1.0, 2.0, 1.0]),
    "1:1:3": np.diag([1.0, 1.0, 3.0]),
    "turned, then 1:2:1": np.diag([1.0, 2.0, 1.0]) @ turned(30.0),
    "mirrored and stretched": np.diag([-1.0, 2.0, 0.5]),
    "sheared in plan": sheared(0, 1, 0.5),
    "sheared upwards": sheared(0, 2, 0.5),
}


def cone_points(s, t):
    radius = 1000.0 + 500.0 * t
    return np.stack([radius * np.cos(TURN / 4.0 * s), radius * np.sin(TURN / 4.0 * s), 4000.0 * t])


# Each with its points by two parameters from 0 to 1, for the area that it ought to have.
def sphere():
    return (
        rhino.Sphere(ORIGIN, 1000.0).ToBrep(),
        lambda s, t: (
            1000.0
            * np.stack([np.sin(np.pi * t) * np.cos(TURN * s), np.sin(np.pi * t) * np.sin(TURN * s), np.cos(np.pi * t)])
        ),
    )


def pipe(s, t):
    return np.stack([500.0 * np.cos(TURN * s), 500.0 * np.sin(TURN * s), 2000.0 * t])


def cylinder():
    return rhino.Cylinder(rhino.Circle(ORIGIN, 500.0), 2000.0).ToBrep(False, False), pipe


def extrusion():
    return rhino.Extrusion.Create(rhino.Circle(ORIGIN, 500.0).ToNurbsCurve(), 2000.0, False), pipe


def cone():
    profile = rhino.LineCurve(rhino.Point3d(1000.0, 0.0, 0.0), rhino.Point3d(1500.0, 0.0, 4000.0))
    axis = rhino.Line(ORIGIN, rhino.Point3d(0.0, 0.0, 1.0))
    return rhino.RevSurface.Create(profile, axis, 0.0, TURN / 4.0), cone_points


def cone_as_polysurface():
    return rhino.Brep.CreateFromRevSurface(cone()[0], False, False), cone_points


def area_by_points(points, matrix):
    """The area of a surface given by its points, once they are mapped, mm^2."""
    nodes, weights = np.polynomial.legendre.leggauss(80)
    s, t = np.meshgrid(0.5 + 0.5 * nodes, 0.5 + 0.5 * nodes, indexing="ij")
    step = 1e-5
    along_s = np.tensordot(matrix, (points(s + step, t) - points(s - step, t)) / (2.0 * step), 1)
    along_t = np.tensordot(matrix, (points(s, t + step) - points(s, t - step)) / (2.0 * step), 1)
    size = np.linalg.norm(np.cross(along_s, along_t, axis=0), axis=0)
    return 0.25 * weights @ size @ weights


def transform_of(matrix):
    transform = rhino.Transform(1.0)
    for row in range(3):
        for column in range(3):
            setattr(transform, f"M{row}{column}", float(matrix[row, column]))
    return transform


def block_of(file, geometry, name):
    """Define a block of one object."""
    file.InstanceDefinitions.Add(name, "", "", "", ORIGIN, (geometry,), (rhino.ObjectAttributes(),))
    return next(definition.Id for definition in file.InstanceDefinitions if definition.Name == name)


def grid_on(face):
    """Points all over the surface of a face, (n, 3)."""
    u_0, u_1, v_0, v_1 = BRepTools.UVBounds_s(face)
    u, v = np.meshgrid(np.linspace(u_0, u_1, 21), np.linspace(v_0, v_1, 11))
    return patch_of(face).points(np.stack([u.ravel(), v.ravel()], axis=-1))


def only_shape(path):
    (part,) = load_model(path).parts
    return part.shape


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("made", [sphere, cylinder, extrusion, cone, cone_as_polysurface])
def test_object_in_a_block_has_the_area_that_the_block_gives_it(tmp_path, made, place):
    geometry, points = made()
    file = file_in()
    file.Objects.AddInstanceObject(rhino.InstanceReference(block_of(file, geometry, "b"), transform_of(PLACES[place])))
    shape = only_shape(written(tmp_path / "block.3dm", file))
    assert BRepCheck_Analyzer(shape).IsValid()
    assert area_of(shape) == pytest.approx(area_by_points(points, PLACES[place]), rel=INTEGRATED)
    (face,) = map(TopoDS.Face_s, shapes_of(shape, TopAbs_FACE))
    back = grid_on(face) @ np.linalg.inv(PLACES[place]).T
    radius, height = np.hypot(back[:, 0], back[:, 1]), back[:, 2]
    wanted = {
        sphere: np.sqrt(np.maximum(1000.0**2 - height**2, 0.0)),
        cylinder: 500.0,
        extrusion: 500.0,
        cone: 1000.0 + height / 8.0,
        cone_as_polysurface: 1000.0 + height / 8.0,
    }
    np.testing.assert_allclose(radius, wanted[made], atol=1e-3 if made is sphere else 1e-9)  # a root of nearly nothing


@pytest.mark.parametrize("made", [sphere, cylinder, cone])
def test_blocks_in_blocks_are_placed_one_after_the_other(tmp_path, made):
    inner, outer = sheared(0, 2, 0.5) @ turned(20.0), np.diag([-1.0, 2.0, 1.0])
    geometry, points = made()
    file = file_in()
    reference = rhino.InstanceReference(block_of(file, geometry, "inner"), transform_of(inner))
    file.Objects.AddInstanceObject(rhino.InstanceReference(block_of(file, reference, "outer"), transform_of(outer)))
    shape = only_shape(written(tmp_path / "nested.3dm", file))
    assert area_of(shape) == pytest.approx(area_by_points(points, outer @ inner), rel=INTEGRATED)


@pytest.mark.parametrize("place", PLACES)
def test_borders_run_along_their_edges_however_the_block_is_stretched(tmp_path, place):
    file, matrix = file_in("Meters"), PLACES[place]
    capped = rhino.Cylinder(rhino.Circle(ORIGIN, 0.5), 2.0).ToBrep(True, True)
    file.Objects.AddInstanceObject(rhino.InstanceReference(block_of(file, capped, "b"), transform_of(matrix)))
    shape = only_shape(written(tmp_path / "capped.3dm", file))
    assert BRepCheck_Analyzer(shape).IsValid()
    assert max(off_border(TopoDS.Face_s(face)) for face in shapes_of(shape, TopAbs_FACE)) <= 1e-4
    caps = 2.0 * np.pi * 500.0**2 * abs(np.linalg.norm(np.cross(matrix[:, 0], matrix[:, 1])))
    assert area_of(shape) == pytest.approx(area_by_points(pipe, matrix) + caps, rel=INTEGRATED)


def test_stretched_cone_is_cut_into_panels_of_its_whole_area(tmp_path):
    geometry, points = cone_as_polysurface()
    file, matrix = file_in(), PLACES["1:2:1"]
    file.Objects.AddInstanceObject(rhino.InstanceReference(block_of(file, geometry, "b"), transform_of(matrix)))
    panels = read_raw_panels(written(tmp_path / "cone.3dm", file), ReferenceSettings(divide=4)).panels
    area = sum(float(face.weights.sum()) for panel in panels for face in panel.faces)
    assert area == pytest.approx(area_by_points(points, matrix), rel=1e-3)


def test_curve_in_a_stretched_block_is_stretched(tmp_path):
    file = file_in()
    file.Objects.AddSurface(bent_surface())
    arc = rhino.NurbsCurve.CreateFromArc(rhino.Arc(rhino.Circle(ORIGIN, 500.0), TURN / 4.0))
    stretch = transform_of(PLACES["1:2:1"])
    file.Objects.AddInstanceObject(rhino.InstanceReference(block_of(file, arc, "b"), stretch))
    (curve,) = load_model(written(tmp_path / "arc.3dm", file)).curves()
    drawn = BRepAdaptor_Curve(curve.edge)
    end = drawn.Value(drawn.LastParameter())
    assert (end.X(), end.Y(), end.Z()) == pytest.approx((0.0, 1000.0, 0.0), abs=1e-9)
