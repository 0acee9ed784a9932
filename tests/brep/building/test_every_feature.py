"""Every feature that has a name, and polygons, as exact solids and skins, in the kernel and read back from STEP."""

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from cadpanel.brep.building.sheet import build_panel, build_skin, volume_of
from cadpanel.brep.proof.shape_facts import inspect
from cadpanel.brep.step.file import read_step_shapes, write_step
from cadpanel.features.catalogue import feature
from cadpanel.geometry.kink import edge_angles, surface_normals
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.volume import sheet_volume
from tests.instances import NAMES, TAPERED, random_polygon, random_shapes

RELATIVE = 1e-12
# Straightening six cones one after the other adds up its rounding; of the thinnest sheet the coordinates' digits tell
# the volume no better.
STRAIGHTENED, THIN = 5e-12, 1e-9
TANGENCY = 1e-11  # rad
# Vertices keep their digits in the file, mm.
WRITTEN = 1e-11
POLYGONS = [3, 5, 6]
# Of the cones as they are built: smaller ones become cylinders.
HALF_ANGLES = [0.0, 1e-9, -6e-6, 1e-4, -1e-2, 0.1]

every_feature = pytest.mark.parametrize("name", NAMES)
every_polygon = pytest.mark.parametrize("corners", POLYGONS)
both_sides = pytest.mark.parametrize("skin_side", ["outer", "inner"])


def exactly_valid(shape):
    return BRepCheck_Analyzer(shape, True, False, True).IsValid()


def area_of(shape):
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties)
    return properties.Mass()


def kinds(shape):
    """How many faces of each kind the skin has, as it is built."""
    cones = [patch for patch in shape.patches if isinstance(patch, ConePatch)]
    tapered = sum(patch.half_angle != 0.0 for patch in cones)
    return {
        "plane": len(shape.patches) - len(cones),
        "cone": tapered,
        "cylinder": len(cones) - tapered,
        "other": 0,
    }


def check_exact(shape, thickness, skin_side, relative=RELATIVE):
    """Build a panel and hold it against its formulas; returns what was built."""
    built = build_panel(shape, thickness, skin_side)
    own = built.straightened.shape
    assert exactly_valid(built.solid)
    assert exactly_valid(built.skin)
    assert BRep_Tool.IsClosed_s(TopoDS.Shell_s(TopExp_Explorer(built.solid, TopAbs_SHELL).Current()))
    assert volume_of(built.solid) == pytest.approx(sheet_volume(own, thickness, skin_side), rel=relative)
    assert area_of(built.skin) == pytest.approx(own.area(), rel=RELATIVE)
    solid, skin = inspect("solid", built.solid), inspect("skin", built.skin)
    walls = len(own.outline) if isinstance(own, PolygonShape) else 4
    expected = kinds(own)
    assert skin.face_kinds == expected
    assert solid.face_kinds == {kind: 2 * count + walls * (kind == "plane") for kind, count in expected.items()}
    smooth = len(own.patches) - 1
    for facts, ways in ((solid, 2), (skin, 1)):
        angles = edge_angles(facts.straight_edges, facts.edge_surfaces)
        assert np.sum(angles < TANGENCY) == ways * smooth
        assert np.sum(angles < 0.1) == ways * smooth
    assert len(skin.straight_edges) == smooth
    corners = own.corners().reshape(-1, 3)
    assert len(solid.vertices) == 2 * len(skin.vertices) == 2 * len(corners)
    assert np.linalg.norm(skin.vertices[:, None] - corners, axis=-1).min(axis=0).max() < 1e-9
    return built


@every_feature
@both_sides
def test_a_feature_becomes_an_exact_skin_and_sheet(name, skin_side):
    for shape in random_shapes(feature(name), 21, 5):
        check_exact(shape, 3.0, skin_side)


@pytest.mark.parametrize("name", TAPERED)
@pytest.mark.parametrize("half_angle", HALF_ANGLES)
def test_cones_are_built_exactly_through_the_cylinder(name, half_angle):
    (shape,) = random_shapes(feature(name), 4, 1, half_angle=half_angle, length=1000.0 if half_angle == 0.1 else 2000.0)
    tiny = half_angle == 1e-9
    built = check_exact(shape, 3.0, "outer", STRAIGHTENED if tiny else RELATIVE)
    straight = [i for i, patch in enumerate(shape.patches) if isinstance(patch, ConePatch)] if tiny else []
    assert list(built.straightened.patches) == straight


@every_polygon
@both_sides
@pytest.mark.parametrize(("thickness", "relative"), [(0.01, THIN), (3.0, RELATIVE), (200.0, RELATIVE)])
def test_a_polygon_becomes_an_exact_skin_and_sheet(corners, skin_side, thickness, relative):
    for seed in range(5):
        check_exact(random_polygon(seed, corners), thickness, skin_side, relative)


def test_a_polygon_with_a_corner_that_points_inwards_is_exact():
    outline = np.array(
        [[0.0, 0.0, 0.0], [900.0, 0.0, 0.0], [900.0, 700.0, 0.0], [450.0, 200.0, 0.0], [0.0, 700.0, 0.0]]
    )
    shape = PolygonShape(name="arrow", feature="planar-polygon", outline=outline, normal=np.array([0.0, 0.0, 1.0]))
    built = check_exact(shape, 3.0, "outer")
    assert volume_of(built.solid) == pytest.approx(3.0 * (900.0 * 700.0 - 0.5 * 900.0 * 500.0), rel=RELATIVE)


@every_polygon
@both_sides
def test_the_sheet_of_a_polygon_lies_on_the_side_that_the_skin_leaves_free(corners, skin_side):
    shape = random_polygon(7, corners)
    built = build_panel(shape, 3.0, skin_side)
    height = (inspect("solid", built.solid).vertices - shape.outline[0]) @ shape.normal
    away = -3.0 if skin_side == "outer" else 3.0
    assert np.sort(height) == pytest.approx(np.sort([0.0] * corners + [away] * corners), abs=1e-9)


@every_feature
def test_faces_of_a_skin_look_outwards(name):
    for shape in random_shapes(feature(name), 8, 3):
        facts = inspect("skin", build_skin(shape))
        corners = shape.corners()
        for edge, surfaces in zip(facts.straight_edges, facts.edge_surfaces, strict=True):
            ruling = np.linalg.norm(corners[0] - edge[0], axis=1).argmin()
            normals = surface_normals(edge[:1], surfaces)
            assert normals @ shape.normals[ruling] == pytest.approx([1.0, 1.0], abs=1e-9)


def assert_written_as_it_is(path, shape):
    """Write a panel's skin and sheet, read them back, and find the same."""
    built = build_panel(shape, 3.0)
    for kind, before in ((TopAbs_SOLID, built.solid), (TopAbs_SHELL, built.skin)):
        write_step(path, [(shape.name, before, None)], title="t")
        [(name, after)] = read_step_shapes(path)
        assert name == shape.name
        assert after.ShapeType() == kind
        assert exactly_valid(after)
        one, other = inspect("p", before), inspect("p", after)
        assert other.face_kinds == one.face_kinds
        assert np.linalg.norm(other.vertices[:, None] - one.vertices, axis=-1).min(axis=0).max() < WRITTEN
        if kind == TopAbs_SOLID:
            assert volume_of(after) == pytest.approx(volume_of(before), rel=RELATIVE)


@every_feature
def test_a_feature_is_read_back_from_step_without_losing_a_digit(tmp_path, name):
    for shape in random_shapes(feature(name), 31, 3):
        assert_written_as_it_is(tmp_path / "a.step", shape)


@every_polygon
def test_a_polygon_is_read_back_from_step_without_losing_a_digit(tmp_path, corners):
    for seed in range(3):
        assert_written_as_it_is(tmp_path / "a.step", random_polygon(seed, corners))
