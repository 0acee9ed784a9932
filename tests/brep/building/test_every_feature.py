"""Every feature that has a name, and polygons, as exact solids and skins, in the kernel and read back from STEP."""

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_panel, build_skin, volume_of
from cadpanel.brep.proof.inspection import inspect
from cadpanel.features.catalogue import feature
from cadpanel.geometry.kink import surface_normals
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PolygonShape
from tests.built import RELATIVE, assert_written_as_it_is, check_exact
from tests.instances import NAMES, TAPERED, random_polygon, random_shapes

pytestmark = pytest.mark.each_value_once

# Straightening six cones one after the other adds up its rounding; of the thinnest sheet the coordinates' digits tell
# the volume no better.
STRAIGHTENED, THIN = 5e-12, 1e-9
POLYGONS = [3, 5, 6]
# Of the cones as they are built: smaller ones become cylinders.
HALF_ANGLES = [0.0, 1e-9, -6e-6, 1e-4, -1e-2, 0.1]

every_feature = pytest.mark.parametrize("name", NAMES)
every_polygon = pytest.mark.parametrize("corners", POLYGONS)
both_sides = pytest.mark.parametrize("skin_side", ["outer", "inner"])


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


@every_feature
def test_a_feature_is_read_back_from_step_without_losing_a_digit(tmp_path, name):
    for shape in random_shapes(feature(name), 31, 3):
        assert_written_as_it_is(tmp_path / "a.step", shape)


@every_polygon
def test_a_polygon_is_read_back_from_step_without_losing_a_digit(tmp_path, corners):
    for seed in range(3):
        assert_written_as_it_is(tmp_path / "a.step", random_polygon(seed, corners))
