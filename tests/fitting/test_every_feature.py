"""Every feature that has a name comes back from its own samples, and so do polygons, whatever else is in the file."""

import numpy as np
import pytest

from cadpanel.features.catalogue import feature, polygon
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape
from tests.instances import NAMES, TAPERED, random_polygon, random_shapes
from tests.known_panels import alone

# Millimetres on panels of 2 m.
RECOVERED = 1e-6
ZERO = 1e-8
PANELS = 20
# Of splines and the like, which take their time.
FEWER = 8
HALF_ANGLES = [0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-7, -1e-5, 1e-4, -1e-3, 1e-2, -1e-2]


def local(known, features):
    """The shapes that the local fit finds in the samples of known ones, and their measures."""
    reference = alone(*known)
    problem, starts = pose(reference, features)
    found = fit_local(problem, reference, starts)
    shapes = panel_shapes(problem, found.unknowns)
    return shapes, measure(shapes, reference)


def corner_error(shapes, known):
    return max(
        np.linalg.norm(one.corners() - other.corners(), axis=-1).max() for one, other in zip(shapes, known, strict=True)
    )


@pytest.mark.parametrize("name", NAMES)
def test_a_feature_is_recovered_from_its_samples(name):
    of = feature(name)
    known = random_shapes(of, 11, PANELS if sum(of.curved) < 3 else FEWER)
    found, measures = local(known, len(known) * [of])
    assert corner_error(found, known) <= RECOVERED
    assert measures.rms_deviation.max() <= ZERO
    assert measures.max_deviation.max() <= RECOVERED
    assert measures.drift.max() <= RECOVERED
    for one, other in zip(found, known, strict=True):
        assert one.feature == name
        for patch, expected in zip(one.patches, other.patches, strict=True):
            assert patch.kind == expected.kind
            if isinstance(patch, ConePatch) and isinstance(expected, ConePatch):
                assert patch.sweep == pytest.approx(expected.sweep, abs=1e-7)
                assert patch.half_angle == pytest.approx(expected.half_angle, abs=1e-7)


@pytest.mark.parametrize("name", [name for name in TAPERED if name != "cone-spline-6"])
def test_cones_are_recovered_through_the_cylinder(name):
    of = feature(name)
    known = [shape for seed, g in enumerate(HALF_ANGLES) for shape in random_shapes(of, seed, 1, half_angle=g)]
    found, measures = local(known, len(known) * [of])
    assert corner_error(found, known) <= RECOVERED
    assert measures.rms_deviation.max() <= ZERO


@pytest.mark.parametrize("name", ["cylinder-parallel", "cylinder", "plane-cylinder-plane"])
def test_a_taper_is_not_recovered_by_cylinders(name):
    """The smallest case that fails: the chain of that feature with a half angle that it does not have."""
    of = feature(name)
    tapered = feature("plane-cone-plane" if name.startswith("plane") else "cone")
    known = random_shapes(tapered, 5, 4, half_angle=1e-2)
    found, measures = local(known, len(known) * [of])
    assert corner_error(found, known) > RECOVERED
    assert measures.rms_deviation.min() > ZERO


@pytest.mark.parametrize("corners", [3, 4, 5, 6, 9])
def test_a_polygon_is_recovered_from_its_samples(corners):
    known = [random_polygon(seed, corners) for seed in range(PANELS)]
    found, measures = local(known, PANELS * [polygon(corners)])
    assert measures.rms_deviation.max() <= ZERO
    assert measures.drift.max() <= RECOVERED
    for one, other in zip(found, known, strict=True):
        # With four corners it is a chain, whose corners are told along its ends.
        expected = other.outline[[[0, 1], [3, 2]]] if corners == 4 else other.corners()
        assert one.corners() == pytest.approx(expected, abs=RECOVERED)
        assert (one.normals[0] if isinstance(one, PanelShape) else one.normal) == pytest.approx(other.normal, abs=1e-9)


def all_features():
    """One panel of every feature but the longest, which takes its time, and two polygons."""
    names = [name for name in NAMES if name != "cone-spline-6"]
    known: list[Panel] = [random_shapes(feature(name), seed, 1)[0] for seed, name in enumerate(names)]
    known += [random_polygon(1, 5), random_polygon(2, 3)]
    return known, [*(feature(name) for name in names), polygon(5), polygon(3)]


def test_panels_of_all_features_in_one_file_are_recovered_as_if_each_were_alone():
    known, features = all_features()
    found, measures = local(known, features)
    assert corner_error(found, known) <= RECOVERED
    assert measures.overall_rms <= ZERO
    assert measures.drift_along[-2:] == pytest.approx(measures.drift[-2:])  # A polygon's drift has no direction.


def test_a_part_of_the_panels_has_the_cost_and_the_gradient_that_it_has_among_all():
    """Also where the panels that are left have fewer corners and numbers than the others."""
    known, features = all_features()
    problem, starts = pose(alone(*known), features)
    whole = Objective(problem, problem.free_terms(FitSettings()), coupled=False)
    cost, normal = whole.linearize(starts[0])
    for chosen in ([0], [2, 5], [len(known) - 2, 1], list(range(len(known)))):
        part = problem.take(np.array(chosen))
        size = part.layout.size
        own = Objective(part, part.free_terms(FitSettings()), coupled=False)
        part_cost, part_normal = own.linearize(starts[0][chosen, :size])
        assert part_cost == pytest.approx(cost[chosen], rel=1e-12)
        assert part_normal.gradient == pytest.approx(normal.gradient[chosen, :size], abs=1e-12)
        assert own.cost(starts[0][chosen, :size]) == pytest.approx(cost[chosen], rel=1e-12)
