"""Meshes to look at: on the exact surface, as large as it, right side out, whatever the kind of panel."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.features.catalogue import feature
from cadpanel.fitting.measures.deviation import deviations
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.polyline import distances_to_polylines
from cadpanel.geometry.self_crossing import end_polyline
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.skin_mesh import skin_mesh
from tests.instances import NAMES, random_polygon, random_shapes
from tests.joined import leaning
from tests.shapes import folded_panel
from tests.trays import tray


def area_and_normal(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, corner]] for corner in range(3))
    doubled = np.cross(b - a, c - a)
    return 0.5 * np.linalg.norm(doubled, axis=1).sum(), doubled


def shapes():
    return [*(random_shapes(feature(name), 4, 1)[0] for name in NAMES), random_polygon(3, 6)]


@pytest.mark.parametrize("shape", shapes(), ids=lambda shape: shape.feature)
def test_vertices_lie_on_the_skin_and_the_mesh_is_as_large_as_it(shape):
    mesh = skin_mesh(shape)
    area, doubled = area_and_normal(mesh)
    assert np.abs(deviations([shape], mesh.points[None])).max() < 1e-8
    assert np.linalg.norm(shape.corners().reshape(-1, 1, 3) - mesh.points, axis=-1).min(axis=1).max() < 1e-9
    assert len(mesh.patches) == len(mesh.triangles)
    for number, patch in enumerate(shape.patches):
        if not isinstance(patch, ConePatch):
            turned = np.cross(doubled[mesh.patches == number], shape.rulings()[2][number])
            assert np.abs(turned).max() < 1e-9 * np.linalg.norm(doubled, axis=1).max()
            assert len(turned) == 2 * 8 * 4 or len(shape.patches) == 1
    assert area == pytest.approx(shape.area(), rel=5e-3)
    away = skin_mesh(shape.offset(1.0))
    assert np.array_equal(away.triangles, mesh.triangles)
    outward = (away.points - mesh.points)[mesh.triangles].mean(axis=1)
    assert (np.einsum("fx,fx->f", doubled, outward) > 0.0).all()
    assert np.linalg.norm(mesh.ways, axis=-1) == pytest.approx(1.0)


def notched(tip):
    """A square of 4 mm whose upper edge goes down to a tip."""
    outline = np.array([(0, 0), (4, 0), (4, 4), tip, (0, 4)], dtype=np.float64)
    return PolygonShape(
        name="notch",
        feature="polygon",
        outline=np.column_stack([outline, np.zeros(5)]),
        normal=np.array([0.0, 0.0, 1.0]),
    )


@pytest.mark.parametrize("tip", [(2, 1), (2, 2)], ids=["off every diagonal", "on a diagonal"])
def test_a_polygon_with_a_notch_is_filled_up_to_its_outline_and_no_farther(tip):
    shape = notched(tip)
    area, doubled = area_and_normal(skin_mesh(shape))
    assert area == pytest.approx(shape.area())
    assert (doubled[:, 2] > 0.0).all()


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_how_a_polygon_is_filled_does_not_hang_on_its_size(scale):
    shape = notched((2, 1))
    large = replace(shape, outline=scale * shape.outline)
    assert np.array_equal(skin_mesh(large).triangles, skin_mesh(shape).triangles)
    assert skin_mesh(large).points == pytest.approx(scale * skin_mesh(shape).points, rel=1e-9)


@pytest.mark.parametrize("side", [0, 1])
def test_columns_of_a_cone_turn_with_a_side_that_stands_in_a_plane_and_others_stay_rulings(side):
    shape = folded_panel(
        chain="cpc",
        half_angle=0.15,
        radius=900.0,
        sweep=1.4,
        cut_normals=((1.0, 0.0, 0.0), (1.0, 0.1, -0.1)),
    )
    plane = replace(leaning(shape, f"side {side}", 10.0, 0.2, 0.0), jointed=True)
    cut = shape.cut_back({f"side {side}": plane}, 3.0)
    assert cut.side_planes[side] is not None
    mesh = skin_mesh(cut)
    rows = mesh.points.reshape(9, -1, 3)
    off = (rows[:, -side] - plane.point) @ plane.normal
    assert np.abs(off).max() < 1e-9
    for end, row in ((0, 0), (1, -1)):
        assert np.abs((rows[row] - cut.cut_points[end]) @ cut.cut_normals[end]).max() < 1e-9
    between = rows[:, (-2, 1)[side]]  # a column of the other cone is a ruling
    assert np.abs(np.cross(between - between[0], between[-1] - between[0])).max() < 1e-6
    assert np.abs(deviations([cut], mesh.points[None])).max() < 1e-8


@pytest.mark.parametrize("degrees", [5.0, 95.0, 200.0])
def test_facets_of_a_bend_turn_by_ten_degrees_at_most_and_by_no_less_than_looks_ask_for(degrees):
    shape = folded_panel(radius=300.0, sweep=np.radians(degrees), widths=(50.0, 50.0))
    _, doubled = area_and_normal(skin_mesh(shape))
    turns = np.unique(np.round(np.degrees(np.arctan2(doubled[:, 1], doubled[:, 2])), 6) % 360.0)
    facets = len(turns) - 2  # those of both flanges, along which the bend begins and ends
    assert facets == max(4, math.ceil(round(degrees / 10.0, 9)))


@pytest.mark.parametrize("name", ["plane-cone-plane", "cone", "plane-cylinder-plane"])
def test_the_mesh_of_a_square_sheets_other_face_ends_where_that_face_ends(name):
    other = replace(random_shapes(feature(name), 4, 1)[0], square=True).offset(-12.0)
    points = skin_mesh(other).points
    for end in (0, 1):
        ends = end_polyline(other, end, arc_points=400)
        corners = other.corners()[end]
        away = np.linalg.norm(points[:, None] - corners, axis=-1).min(axis=0)
        assert away.max() < 1e-9
        rim = points.reshape(9, -1, 3)[-end]
        assert distances_to_polylines(rim[None], ends[None]).max() < 0.01


FIVE_EDGES = tray((0.1, 0.0, -0.1, 0.05, 0.0), edges=("edge 0", "edge 1"))
FOLDED = [tray(), tray(skin_side="inner"), FIVE_EDGES.offset(-3.0)]


def steps_along_triangles(mesh, triangles):
    """Of each side of some triangles: the way in space, the way on the chart, and the chart's axes where it begins."""
    sides = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    begin, end = sides.T
    return mesh.points[end] - mesh.points[begin], mesh.chart[end] - mesh.chart[begin], mesh.ways[begin]


@pytest.mark.parametrize("shape", FOLDED, ids=["outer", "inner", "five edges, other face"])
def test_a_folded_panels_mesh_lies_on_each_of_its_faces_and_reaches_all_their_corners(shape):
    mesh = skin_mesh(shape)
    points, ways = shape.surfaces()
    for number, (patch, point, way) in enumerate(zip(shape.patches, points, ways, strict=True)):
        triangles = mesh.triangles[mesh.patches == number]
        off = mesh.points[np.unique(triangles)] - point
        if isinstance(patch, ConePatch):
            assert np.linalg.norm(np.cross(off, way), axis=1) == pytest.approx(patch.radius, abs=1e-9)
        else:
            assert off @ way == pytest.approx(0.0, abs=1e-9)
            space, chart, axes = steps_along_triangles(mesh, triangles)
            first, second = space.reshape(-1, 3, 3)[:, :2].swapaxes(0, 1)
            assert (np.cross(first, second) @ way).min() > 0.0
            assert np.abs(space - np.einsum("sa,sax->sx", chart, axes)).max() < 1e-9
    assert np.linalg.norm(np.cross(*np.diff(mesh.points[mesh.triangles], axis=1).swapaxes(0, 1)), axis=1).min() > 1.0
    apart = np.linalg.norm(shape.vertices()[:, None] - mesh.points, axis=-1).min(axis=1)
    assert apart.max() < 1e-9
    # A fold of four facets is as large as the chords of its arc, and each relief lacks what its own chords cut off.
    plan = shape.plan
    chords = shape.radius * 8.0 * np.sin(plan.angles / 8.0)
    strips = plan.lengths * (chords + plan.legs)
    relieved = 0.5 * (plan.reliefs**2 * 4.0 * np.sin(plan.openings / 4.0)).sum()
    whole = shape.area() + 0.5 * (plan.reliefs**2 * plan.openings).sum()
    whole -= (plan.lengths * (shape.radius * plan.angles + plan.legs))[plan.folded].sum()
    area, _ = area_and_normal(mesh)
    assert area == pytest.approx(whole - relieved + strips[plan.folded].sum(), rel=1e-12)


@pytest.mark.parametrize("shape", FOLDED, ids=["outer", "inner", "five edges, other face"])
def test_a_folded_panels_chart_is_unrolled_without_stretching(shape):
    mesh = skin_mesh(shape)
    for number, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            space, chart, axes = steps_along_triangles(mesh, mesh.triangles[mesh.patches == number])
            facet = patch.sweep / 4.0
            stretch = np.linalg.norm(chart, axis=1) / np.linalg.norm(space, axis=1)
            assert stretch.min() == pytest.approx(1.0, abs=1e-12)
            assert stretch.max() == pytest.approx(0.5 * facet / np.sin(0.5 * facet), abs=1e-9)
            turned = np.einsum("sx,sax->sa", space, axes)
            assert (np.abs(turned - chart) <= np.sin(facet) * np.abs(chart).max(axis=1, keepdims=True) + 1e-9).all()
    first, second = (mesh.chart[mesh.triangles[:, other]] - mesh.chart[mesh.triangles[:, 0]] for other in (1, 2))
    assert (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).min() > 0.0
    # Where two faces meet they have one place on the chart.
    same = np.linalg.norm(mesh.points[:, None] - mesh.points, axis=-1) < 1e-9
    assert np.abs(mesh.chart[:, None] - mesh.chart)[same].max() < 1e-9
    assert same.sum() > len(mesh.points)


@pytest.mark.parametrize("shape", shapes(), ids=lambda shape: shape.feature)
def test_a_chart_goes_the_ways_that_it_names_and_keeps_its_right_side_up(shape):
    mesh = skin_mesh(shape)
    first, second = (mesh.chart[mesh.triangles[:, other]] - mesh.chart[mesh.triangles[:, 0]] for other in (1, 2))
    assert (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).min() > 0.0
    space, chart, axes = steps_along_triangles(mesh, mesh.triangles)
    for axis in (0, 1):
        straight = np.abs(chart[:, 1 - axis]) < 1e-9 * np.abs(chart[:, axis])
        along = np.einsum("sx,sx->s", space, axes[:, axis]) * np.sign(chart[:, axis])
        assert (along > 0.9 * np.linalg.norm(space, axis=1))[straight].all()
    assert set(np.unique(mesh.patches)) == set(range(len(shape.patches)))
