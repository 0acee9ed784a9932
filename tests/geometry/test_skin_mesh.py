"""Meshes to look at: on the exact surface, as large as it, right side out, whatever the kind of panel."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.features.catalogue import feature
from cadpanel.fitting.measures.deviation import deviations
from cadpanel.geometry.polyline import distances_to_polylines
from cadpanel.geometry.self_crossing import end_polyline
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.skin_mesh import skin_mesh
from tests.instances import NAMES, random_polygon, random_shapes
from tests.shapes import folded_panel


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
    assert area == pytest.approx(shape.area(), rel=5e-3)
    away = skin_mesh(shape.offset(1.0))
    assert np.array_equal(away.triangles, mesh.triangles)
    outward = (away.points - mesh.points)[mesh.triangles].mean(axis=1)
    assert (np.einsum("fx,fx->f", doubled, outward) > 0.0).all()
    assert np.linalg.norm(mesh.ways, axis=-1) == pytest.approx(1.0)


@pytest.mark.parametrize("tip", [(2, 1), (2, 2)], ids=["off every diagonal", "on a diagonal"])
def test_a_polygon_with_a_notch_is_filled_up_to_its_outline_and_no_farther(tip):
    outline = np.array([(0, 0), (4, 0), (4, 4), tip, (0, 4)], dtype=np.float64)
    shape = PolygonShape(
        name="notch",
        feature="polygon",
        outline=np.column_stack([outline, np.zeros(5)]),
        normal=np.array([0.0, 0.0, 1.0]),
    )
    area, doubled = area_and_normal(skin_mesh(shape))
    assert area == pytest.approx(shape.area())
    assert (doubled[:, 2] > 0.0).all()


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
