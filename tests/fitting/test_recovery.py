"""A panel that is fitted to its own samples comes back; so it does wherever it stands and however it is told of."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.errors import PanelError
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.patches import ConePatch
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import RawPanel
from tests.known_panels import alone, flipped, moved, posed, renumbered
from tests.reference_shapes import polygon_face, sheet_of
from tests.shapes import folded_panel, random_panel

# Millimetres on panels of 2 m.
RECOVERED = 1e-6
ZERO = 1e-8
UPRIGHT = 1.0

few = settings(max_examples=5)
HALF_ANGLES = [None, 0.0, 1e-9, -1e-9, 1e-7, 1e-5, 1e-4, -1e-3, 1e-2, -1e-2]
PANELS = 8


def local(reference, **how):
    """The locally fitted shapes, and their measures."""
    settings_ = FitSettings(method="local", **how)
    problem, starts = posed(reference, settings_)
    found = fit_local(problem, reference, starts)
    shapes = panel_shapes(problem, found.unknowns)
    return shapes, measure(shapes, reference)


def corners(shapes):
    return np.array([shape.corners() for shape in shapes])


def corner_error(shapes, known):
    return np.linalg.norm(corners(shapes) - corners(known), axis=-1).max()


def turn(seed):
    axes, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return axes * np.sign(np.linalg.det(axes))


@pytest.mark.parametrize("half_angle", HALF_ANGLES)
def test_a_known_panel_is_recovered_from_its_samples(half_angle):
    known = [random_panel(seed, half_angle=half_angle) for seed in range(PANELS)]
    found, measures = local(alone(*known))
    assert corner_error(found, known) <= RECOVERED
    assert measures.overall_rms <= ZERO
    assert measures.max_deviation.max() <= RECOVERED
    assert measures.hausdorff.max() <= 1.0  # Between the outline's points the arcs bulge beyond the polyline.
    assert measures.drift.max() <= RECOVERED
    for one, other in zip(found, known, strict=True):
        cone, expected = one.patches[1], other.patches[1]
        assert isinstance(cone, ConePatch)
        assert isinstance(expected, ConePatch)
        assert cone.half_angle == pytest.approx(expected.half_angle, abs=1e-9)
        assert cone.sweep == pytest.approx(expected.sweep, abs=1e-9)


def test_a_known_cylinder_is_recovered_as_a_cylinder():
    known = [random_panel(seed, half_angle=0.0) for seed in range(PANELS)]
    found, _ = local(alone(*known), feature="plane-cylinder-plane")
    assert corner_error(found, known) <= RECOVERED
    for one, other in zip(found, known, strict=True):
        cylinder, expected = one.patches[1], other.patches[1]
        assert isinstance(cylinder, ConePatch)
        assert isinstance(expected, ConePatch)
        assert (cylinder.kind, cylinder.half_angle) == ("cylinder", 0.0)
        assert cylinder.radius == pytest.approx(expected.radius, abs=RECOVERED)


def test_a_cylinder_is_not_made_of_a_cone():
    """The smallest case that fails: the same samples with a half angle that only the cone has."""
    known = [random_panel(seed, half_angle=1e-2) for seed in range(PANELS)]
    found, measures = local(alone(*known), feature="plane-cylinder-plane")
    assert corner_error(found, known) > RECOVERED
    assert measures.rms_deviation.min() > ZERO


def test_upright_panels_are_nearly_recovered_with_the_tilt_fixed():
    """What upright means is told by the start's frame, which knows the fold's direction only roughly."""
    square = [folded_panel(radius=150.0 + 20.0 * k, sweep=0.5 + 0.2 * k, length=2000.0) for k in range(4)]
    found, measures = local(alone(*square), tilt="fixed")
    assert corner_error(found, square) <= UPRIGHT
    assert measures.rms_deviation.max() <= 1e-3
    mitred = [random_panel(seed, mitre=0.3) for seed in range(4)]
    assert corner_error(local(alone(*mitred), tilt="fixed")[0], mitred) > UPRIGHT


@few
@given(seed=st.integers(0, 10_000), far=st.sampled_from([0.0, 1e3, 1e6]))
def test_moving_the_reference_moves_the_panels(seed, far):
    reference = alone(*(random_panel(seed + k) for k in range(3)))
    rotation, shift = turn(seed), far * np.array([1.0, -1.0, 0.5])
    before, after = (corners(local(one)[0]) for one in (reference, moved(reference, rotation, shift)))
    assert np.abs(after - (before @ rotation.T + shift)).max() <= RECOVERED


def test_map_grid_coordinates_cost_no_more_than_their_digits():
    """8e8 mm: a double keeps 1e-7 mm there, and the fit must not lose more."""
    known = [random_panel(seed) for seed in range(PANELS)]
    shift = np.array([8.2e8, 8.1e8, 5e3])
    found, _ = local(moved(alone(*known), np.eye(3), shift))
    assert np.abs(corners(found) - shift - corners(known)).max() <= 1e-5


@few
@given(seed=st.integers(0, 10_000), order=st.permutations(range(4)))
def test_renumbering_panels_changes_nothing(seed, order):
    reference = alone(*(random_panel(seed + k) for k in range(4)))
    before, after = (corners(local(one)[0]) for one in (reference, renumbered(reference, order)))
    assert np.abs(after - before[list(order)]).max() <= RECOVERED


@few
@given(seed=st.integers(0, 10_000))
def test_a_panel_walked_from_its_other_end_is_the_same_panel(seed):
    reference = alone(*(random_panel(seed + k) for k in range(2)))
    before, after = (corners(local(one)[0]) for one in (reference, flipped(reference, 0)))
    assert np.abs(after[0, ::-1, ::-1] - before[0]).max() <= RECOVERED
    assert np.abs(after[1] - before[1]).max() <= RECOVERED


def test_each_panel_is_fitted_as_if_it_were_alone():
    known = [random_panel(seed) for seed in range(4)]
    together = corners(local(alone(*known))[0])
    for i in (0, 3):
        assert np.abs(corners(local(alone(known[i]))[0])[0] - together[i]).max() <= RECOVERED


def test_a_panel_without_a_fold_is_refused_by_its_name():
    flat = folded_panel(sweep=np.radians(1.9))
    with pytest.raises(PanelError, match=r"panel 2.*1\.90 degrees"):
        local(alone(random_panel(1), flat))
    local(alone(random_panel(1), folded_panel(sweep=np.radians(2.1))))


@pytest.mark.parametrize("slant", [12.0, 22.0, 45.0])
def test_a_flat_panel_with_acute_corners_is_recovered(slant):
    """Its cuts lean far against the way along it, which no bound may forbid."""
    reach = 1.0 / np.tan(np.radians(slant))
    corners = np.array([(0.0, 0.0), (3.0, 0.0), (3.0 + reach, 1.0), (reach, 1.0)])
    flat = sheet_of(lambda x, y: 0.0 * (x + y), width=1000.0, length=1000.0)
    reference = assemble([RawPanel(name="slanted", faces=(polygon_face(flat, corners),))], "flat.step")
    _, measures = local(reference, feature="planar-quadrilateral")
    assert measures.drift.max() <= RECOVERED
    assert measures.hausdorff.max() <= RECOVERED
