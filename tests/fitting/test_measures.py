"""What the measures say of panels that were shifted, opened or bent by a known amount."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.features.catalogue import CATALOGUE, feature, polygon
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.shape import PolygonShape
from cadpanel.reference.model import Seam
from tests.instances import random_polygon, random_shapes
from tests.known_panels import alone, posed
from tests.shapes import folded_panel, moved

# Millimetres.
EXACT = 1e-6


def measured(reference, features):
    """The measures of the exact local fit."""
    problem, starts = pose(reference, features)
    return measure(problem, reference, fit_local(problem, reference, starts).unknowns)


@pytest.mark.parametrize("name", CATALOGUE)
def test_an_exact_fit_has_no_deviation_and_no_drift(name):
    found = measured(alone(*random_shapes(feature(name), 3, 2)), 2 * [feature(name)])
    for value in (found.rms_deviation, found.max_deviation, found.drift, found.drift_along, found.drift_across):
        assert value.shape == (2,)
        assert value.max() <= EXACT
    assert found.overall_rms <= EXACT
    # Between the points of the outline its polyline is a chord of the arc.
    assert found.hausdorff.max() <= 1.0


@pytest.mark.parametrize("by", [0.5, 20.0])
def test_a_corner_that_moves_along_a_strip_drifts_along_it_and_not_across(by):
    fold = folded_panel()
    problem, starts = posed(alone(fold), FitSettings())
    found = fit_local(problem, alone(fold), starts)
    for vector, along, across in (((by, 0.0, 0.0), by, 0.0), ((0.0, by, 0.0), 0.0, by), ((0.0, 0.0, by), 0.0, by)):
        shift = np.array(vector) @ problem.place.axes[0] / problem.place.length
        away = replace(problem, outline=replace(problem.outline, corners=problem.outline.corners + shift))
        seen = measure(away, alone(fold), found.unknowns)
        assert seen.drift == pytest.approx([by], abs=1e-4)
        assert seen.drift_along == pytest.approx([along], abs=1e-4)
        assert seen.drift_across == pytest.approx([across], abs=1e-4)


def test_a_polygon_drifts_whichever_way_its_corners_move():
    shape = random_polygon(4, 5)
    problem, starts = pose(alone(shape), [polygon(5)])
    found = fit_local(problem, alone(shape), starts)
    away = replace(problem, outline=replace(problem.outline, corners=problem.outline.corners + 0.01))
    seen = measure(away, alone(shape), found.unknowns)
    by = 0.01 * np.sqrt(3.0) * problem.place.length
    assert seen.drift == pytest.approx([by], abs=EXACT)
    assert seen.drift_along == pytest.approx([by], abs=EXACT)
    assert seen.drift_across == pytest.approx([0.0], abs=EXACT)


@pytest.mark.parametrize("corners", [3, 5, 6])
def test_a_polygon_that_reaches_beyond_its_reference_is_as_far_from_it_as_its_corner(corners):
    shape = random_polygon(2, corners)
    whole = alone(shape)
    problem, starts = pose(whole, [polygon(corners)])
    found = fit_local(problem, whole, starts)
    middle = shape.outline.mean(axis=0)
    less = replace(shape, outline=middle + 0.9 * (shape.outline - middle))
    (panel,) = alone(less).panels
    seen = measure(problem, replace(whole, panels=(replace(panel, name="panel 1"),)), found.unknowns)
    reach = 0.1 * np.linalg.norm(shape.outline - middle, axis=-1).max()
    assert seen.hausdorff == pytest.approx([reach], rel=0.05)
    assert seen.max_deviation.max() <= EXACT


@pytest.mark.parametrize("gap", [0.0, 0.25, 7.0])
@pytest.mark.parametrize("feature_", ["plane-cone-plane", "planar-quadrilateral"])
def test_panels_apart_by_a_known_gap_have_that_gap_at_all_corners_and_along_the_seam(gap, feature_):
    fold = folded_panel() if feature_ == "plane-cone-plane" else folded_panel(chain="p", widths=(500.0,), turns=(0.0,))
    pair = alone(fold, moved(fold, (1000.0 + gap, 0.0, 0.0)))
    pair = replace(pair, seams=(Seam(panels=(0, 1), edges=(1, 0), reversed=False),))
    found = measured(pair, 2 * [feature(feature_)])
    (gaps,) = found.corner_gaps
    assert gaps == pytest.approx(np.full(len(fold.points), gap), abs=EXACT)
    assert found.seam_gap == pytest.approx([gap], abs=EXACT)
    assert (found.max_corner_gap, found.max_seam_gap) == (gaps.max(), found.seam_gap.max())
    assert found.kink == pytest.approx([0.0], abs=1e-6)


def test_a_seam_told_from_the_other_panel_has_the_same_gaps_in_the_order_of_the_first():
    fold = folded_panel()
    pair = alone(fold, moved(fold, (1003.0, 2.0, 0.0)))
    told = [Seam(panels=(0, 1), edges=(1, 0), reversed=False), Seam(panels=(1, 0), edges=(0, 1), reversed=False)]
    one, other = (measured(replace(pair, seams=(seam,)), 2 * [feature("plane-cone-plane")]) for seam in told)
    assert one.corner_gaps[0] == pytest.approx(other.corner_gaps[0], abs=EXACT)
    assert one.seam_gap == pytest.approx(other.seam_gap, abs=EXACT)


def test_panels_that_meet_at_an_angle_have_that_kink():
    up, lean = np.array([0.0, 0.0, 1.0]), np.array([np.sin(0.1), 0.0, np.cos(0.1)])
    down = np.array([np.cos(0.1), 0.0, -np.sin(0.1)])
    base = np.array([[0.0, 0.0, 0.0], [800.0, 0.0, 0.0], [800.0, 600.0, 0.0], [400.0, 900.0, 0.0], [0.0, 600.0, 0.0]])
    roof = PolygonShape(name="a", feature="planar-polygon", outline=base, normal=up)
    edge = base[[1, 2]]
    low = edge + 700.0 * down
    beyond = np.stack([edge[0], low[0], low.mean(axis=0) + 200.0 * down, low[1], edge[1]])
    wall = PolygonShape(name="b", feature="planar-polygon", outline=beyond, normal=lean)
    pair = replace(alone(roof, wall), seams=(Seam(panels=(0, 1), edges=(1, 4), reversed=True),))
    found = measured(pair, 2 * [polygon(5)])
    assert found.kink == pytest.approx([0.1], abs=1e-9)
    assert found.seam_gap == pytest.approx([0.0], abs=EXACT)


def test_without_seams_there_is_no_gap():
    found = measured(alone(folded_panel()), [feature("plane-cone-plane")])
    assert found.corner_gaps == ()
    assert found.seam_gap.shape == found.kink.shape == found.widest_corners.shape == (0,)
    assert found.max_corner_gap == found.max_seam_gap == 0.0
