"""Bounds that keep panels makeable, and the lengths that the shop's limits hold."""

import numpy as np
import pytest

from cadpanel.features.catalogue import feature
from cadpanel.features.feature import Feature
from cadpanel.features.layout import Group, Layout
from cadpanel.features.patches import Cone, Plane
from cadpanel.fitting.bounds import LEAST_SHARE, STEEPEST, natural_bounds
from cadpanel.terms.limits.flange_width import FlangeWidth, WidthTerm
from cadpanel.terms.limits.min_radius import RadiusTerm
from cadpanel.terms.state import State
from tests.chains import FEATURES, random_unknowns

LENGTH = 2000.0
STEP = 1e-6
DIFFERENCES = 1e-6

chains = pytest.mark.parametrize(
    "name", sorted(name for name, of in FEATURES.items() if isinstance(of, Feature) and any(of.curved))
)


def bounds_of(of, unknowns):
    layout = Layout.of([of] * len(unknowns), LENGTH)
    return natural_bounds(layout, [unknowns], LENGTH)


@chains
def test_the_start_is_within_the_bounds_and_keeps_its_signs(name):
    of = FEATURES[name].in_units(LENGTH)
    unknowns = random_unknowns(of, 4)
    lower, upper = bounds_of(FEATURES[name], unknowns)
    names = [of.numbers[i].name.rpartition(" ")[2] for i in of.free]
    for column, what in enumerate(names):
        if what in ("radius", "sweep"):
            assert np.all(np.sign(lower[:, column]) == np.sign(unknowns[:, column]))
            assert np.all(np.sign(upper[:, column]) == np.sign(unknowns[:, column]))
    bounded = [i for i, what in enumerate(names) if what in ("radius", "sweep", "width")]
    assert np.all(lower[:, bounded] <= unknowns[:, bounded])
    assert np.all(unknowns[:, bounded] <= upper[:, bounded])


def test_concave_patches_stay_concave():
    of = feature("cylinder")
    unknowns = random_unknowns(of, 2)
    at = [i for i, index in enumerate(of.free) if of.numbers[index].name.endswith(("radius", "sweep"))]
    unknowns[:, at] *= -1.0
    lower, upper = bounds_of(of, unknowns)
    assert np.all(upper[:, at] == -LEAST_SHARE * np.abs(unknowns[:, at]))
    assert np.all(lower[:, at] < unknowns[:, at])


def test_what_the_author_bounds_stays_as_the_author_has_it():
    of = Feature(Plane(width=(300.0, None)), Cone(radius=(200.0, 900.0), half_angle=(-1.2, 1.2)), Plane())
    unknowns = random_unknowns(feature("plane-cone-plane"), 3)
    lower, upper = bounds_of(of, unknowns)
    where = {of.numbers[index].name: column for column, index in enumerate(of.free)}
    assert np.all(lower[:, where["patch 0: width"]] == 300.0 / LENGTH)
    assert np.all(lower[:, where["patch 2: width"]] == FlangeWidth.default / LENGTH)
    assert np.all(lower[:, where["patch 1: radius"]] == 200.0 / LENGTH)
    assert np.all(upper[:, where["patch 1: radius"]] == 900.0 / LENGTH)
    assert np.all(upper[:, where["patch 1: half_angle"]] == 1.2)
    free = feature("plane-cone-plane")
    assert bounds_of(free, unknowns)[1][0, where["patch 1: half_angle"]] == STEEPEST


def limits_of(of, panels, least):
    group = Group(of, np.arange(panels))
    limits = [RadiusTerm(group, 0, panels, least)]
    return limits if all(of.curved) else [*limits, WidthTerm(group, 0, panels, least)]


@chains
def test_the_limits_jacobians_agree_with_finite_differences(name):
    of = FEATURES[name].in_units(LENGTH)
    unknowns = random_unknowns(of, 5)
    layout = Layout.of([of] * len(unknowns))
    for limit in limits_of(of, len(unknowns), 5.0):

        def row(at, limit=limit):
            (rows,) = limit.rows(State(layout, layout.walk(at, derivatives=True)))
            return rows

        exact = row(unknowns).jacobians[0]
        steps = STEP * np.eye(unknowns.shape[1])
        numeric = np.stack(
            [(row(unknowns + s).residual - row(unknowns - s).residual) / (2.0 * STEP) for s in steps], axis=-1
        )
        assert np.abs(exact - numeric).max() <= DIFFERENCES * max(1.0, np.abs(exact).max())


@chains
def test_limits_that_hold_cost_nothing_and_those_that_break_say_by_how_much(name):
    of = FEATURES[name]
    unknowns = random_unknowns(of, 6)
    layout = Layout.of([of] * len(unknowns))
    state = State(layout, layout.walk(unknowns, derivatives=False))
    for tiny, huge in zip(limits_of(of, len(unknowns), 1e-6), limits_of(of, len(unknowns), 5.0), strict=True):
        assert not tiny.cost(state).any()
        assert np.all(tiny.vectors(state) < 0.0)
        assert np.all(huge.vectors(state) > 0.0)
        assert np.all(huge.cost(state) > 0.0)


def test_the_radius_at_a_corner_is_the_distance_to_the_axis_over_the_cosine():
    of = feature("cone")
    unknowns = random_unknowns(of, 7)
    layout = Layout.of([of] * len(unknowns))
    state = State(layout, layout.walk(unknowns, derivatives=False))
    (walked,) = state.walks
    lengths, _ = RadiusTerm(layout.groups[0], 0, len(unknowns), 1.0).lengths(walked, state.corners, derivatives=False)
    at = of.patch_slice(0).start
    radius, angle = walked.values[:, at], walked.values[:, at + 1]
    t, n = walked.anchor.t[:, 0], walked.anchor.n[:, 0]
    axis = np.cos(angle)[:, None] * t - np.sin(angle)[:, None] * n
    off = state.corners.position - (walked.anchor.p - radius[:, None, None] * walked.anchor.n)
    off -= np.einsum("pcx,px->pc", off, axis)[..., None] * axis[:, None]
    assert np.linalg.norm(off, axis=-1) / np.cos(angle)[:, None] == pytest.approx(lengths, rel=1e-12)


@chains
@pytest.mark.parametrize("least", [0.05, 0.3, 2.0])
def test_a_limit_holds_exactly_from_its_least_length_on(name, least):
    """A tenth more is asked for, and a tenth is what the lack may be; what is longer lacks less than nothing."""
    of = FEATURES[name]
    unknowns = random_unknowns(of, 6)
    layout = Layout.of([of] * len(unknowns))
    state = State(layout, layout.walk(unknowns, derivatives=False))
    (walked,) = state.walks
    for limit in limits_of(of, len(unknowns), least):
        lengths, _ = limit.lengths(walked, state.corners, derivatives=False)
        lack = limit.vectors(state)[..., 0]
        np.testing.assert_allclose(lack, 1.1 * least - lengths, atol=1e-12)
        assert (limit.hold.excess(limit.vectors(state)) <= 1.0) == bool((lengths >= least).all())


@pytest.mark.parametrize("name", ["plane-cone-plane", "plane-cone", "planar-quadrilateral", "cone-plane-cone"])
def test_the_width_of_a_flange_is_how_far_its_rulings_are_apart_at_either_end(name):
    """Square to the ruling that it begins at, from there to the corner on the next one."""
    of = FEATURES[name]
    unknowns = random_unknowns(of, 8)
    layout = Layout.of([of] * len(unknowns))
    state = State(layout, layout.walk(unknowns, derivatives=False))
    (walked,) = state.walks
    found, _ = WidthTerm(layout.groups[0], 0, len(unknowns), 1.0).lengths(walked, state.corners, derivatives=False)
    rulings = len(of.patches) + 1
    corners = state.corners.position.reshape(len(unknowns), 2, rulings, 3)
    wanted = []
    for patch in (place for place, curved in enumerate(of.curved) if not curved):
        p, t = walked.edges.p[:, patch], walked.edges.t[:, patch]
        for end in (0, 1):
            off = corners[:, end, patch + 1] - p
            wanted.append(np.linalg.norm(off - np.sum(off * t, axis=1)[:, None] * t, axis=1))
    assert found == pytest.approx(np.stack(wanted, axis=1), rel=1e-9)
