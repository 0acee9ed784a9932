"""Panels in millimetres, as the solids take them, against the walk that they come from."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.catalogue import feature
from cadpanel.features.polygon import Polygon
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape, edge_corners
from tests.chains import CHAINS, FEATURES, POLYGONS, made_problem, mixed_unknowns, problem_of, random_unknowns

pytestmark = pytest.mark.each_value_once

ROUNDING = 1e-12
# Millimetres, at coordinates of some metres.
SAME_POINT = 1e-9

few = settings(max_examples=5)
seeds = st.integers(0, 10_000)
every_feature = pytest.mark.parametrize("name", sorted(FEATURES))
every_chain = pytest.mark.parametrize("name", sorted(CHAINS))


@every_feature
@few
@given(seed=seeds)
def test_panel_shapes_have_the_corners_of_the_walk(name, seed):
    of = FEATURES[name]
    problem = made_problem(of, seed)
    unknowns = random_unknowns(of, seed, problem.panels)
    place, state = problem.place, problem.state(unknowns)
    world = place.to_world(state.corners.position) * place.length + place.centre
    for i, shape in enumerate(panel_shapes(problem, unknowns)):
        assert shape.name == f"panel {i}"
        assert shape.feature == of.name
        assert shape.corners().reshape(-1, 3) == pytest.approx(world[i], abs=SAME_POINT)


@every_feature
@few
@given(seed=seeds)
def test_edges_of_shapes_are_those_of_the_measures(name, seed):
    of = FEATURES[name]
    problem = made_problem(of, seed)
    unknowns = random_unknowns(of, seed, problem.panels)
    shapes = panel_shapes(problem, unknowns)
    edges = PanelEdges.of(shapes)
    for index, edge in enumerate(of.edges):
        curves = edges.curves[edges.batch[0, index]].take(edges.row[:, index])
        for i, shape in enumerate(shapes):
            corners = edge_corners(shape.corners(), edge.name)
            assert curves.corners[i] + edges.centre == pytest.approx(corners, abs=SAME_POINT)


@every_chain
@few
@given(seed=seeds)
def test_cut_planes_of_shapes_have_unit_normals_along_the_strip(name, seed):
    problem = made_problem(CHAINS[name], seed)
    for shape in panel_shapes(problem, random_unknowns(CHAINS[name], seed, problem.panels)):
        assert isinstance(shape, PanelShape)
        for end in (0, 1):
            assert shape.cut_normals[end] @ shape.directions[0] > 0.0
            assert np.linalg.norm(shape.cut_normals[end]) == pytest.approx(1.0, abs=ROUNDING)


@every_chain
@few
@given(seed=seeds)
def test_panel_shapes_carry_each_ruling_to_the_next(name, seed):
    """Turning a ruling about the axis that its patch tells of gives the next ruling, as the solids assume."""
    problem = made_problem(CHAINS[name], seed)
    for shape in panel_shapes(problem, random_unknowns(CHAINS[name], seed, problem.panels)):
        assert isinstance(shape, PanelShape)
        for i, (patch, spec) in enumerate(zip(shape.patches, CHAINS[name].patches, strict=True)):
            assert patch.kind == spec.kind
            if not isinstance(patch, ConePatch):
                assert shape.normals[i] == pytest.approx(shape.normals[i + 1], abs=ROUNDING)
                continue
            p, t, n = shape.points[i], shape.directions[i], shape.normals[i]
            axis = np.cos(patch.half_angle) * t - np.sin(patch.half_angle) * n
            centre = p - patch.radius * n
            to_next = shape.points[i + 1] - centre

            def turned(v, axis=axis, sweep=patch.sweep):
                return v * np.cos(sweep) + np.cross(axis, v) * np.sin(sweep) + axis * (axis @ v) * (1 - np.cos(sweep))

            assert turned(p - centre) == pytest.approx(to_next, abs=SAME_POINT)
            assert turned(t) == pytest.approx(shape.directions[i + 1], abs=ROUNDING)
            assert turned(n) == pytest.approx(shape.normals[i + 1], abs=ROUNDING)


@pytest.mark.parametrize("name", sorted(POLYGONS))
@few
@given(seed=seeds)
def test_polygons_lie_in_one_plane_and_run_counterclockwise_about_its_normal(name, seed):
    problem = made_problem(POLYGONS[name], seed)
    for shape in panel_shapes(problem, random_unknowns(POLYGONS[name], seed, problem.panels)):
        assert isinstance(shape, PolygonShape)
        around = shape.outline - shape.outline.mean(axis=0)
        assert np.linalg.norm(shape.normal) == pytest.approx(1.0, abs=ROUNDING)
        assert around @ shape.normal == pytest.approx(0.0, abs=SAME_POINT)
        assert np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0) @ shape.normal > 0.0


def test_shapes_of_several_features_come_in_the_order_of_the_panels():
    features: list[PanelFeature] = [
        Polygon(6),
        feature("plane-cone-plane"),
        Polygon(6),
        feature("cone"),
        feature("plane-cone-plane"),
    ]
    problem = problem_of(features, 3, np.empty((0, 2)), np.empty((0, 2)))
    unknowns = mixed_unknowns(problem.layout, 3)
    shapes = panel_shapes(problem, unknowns)
    assert [shape.name for shape in shapes] == [f"panel {i}" for i in range(5)]
    assert [shape.feature for shape in shapes] == [one.name for one in features]
    for i, shape in enumerate(shapes):
        (alone,) = panel_shapes(problem.take(np.array([i])), unknowns[i : i + 1])
        assert shape.corners() == pytest.approx(alone.corners(), abs=SAME_POINT)
