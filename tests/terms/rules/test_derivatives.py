"""What rules hold: exact derivatives, and vectors that vanish where panels are alike, in place, or mirror images."""

import numpy as np
import pytest

from cadpanel.features.patches import DIMENSIONS
from cadpanel.fitting.rules.boundary import boundary_of, places_in
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.terms.limits.planes import PlaneTerm
from cadpanel.terms.rules.alike import HALF_ANGLE, RADIUS, AlikeTerm
from cadpanel.terms.rules.mirrored import Images, MirrorTerm
from cadpanel.terms.rules.near import NearTerm
from tests.terms.models import DIFFERENCES, Together, case_of, jacobian_fault, mixed_case

FOLD, ALL_ROUND = "plane-cone-plane", "own double fold"


def alike(problem, what):
    pairs = problem.pairs
    bends = sum(problem.layout.feature_of[0].curved)
    sides = np.array([1.0, -1.0, 1.0])
    return AlikeTerm(
        pairs[:, 0],
        pairs[:, 1],
        np.arange(len(pairs)),
        bends=bends,
        what=what,
        within=0.1,
        sides=sides,
    )


def mirrored(problem):
    places = places_in(problem.layout, 0)
    images = Images(
        first=problem.pairs[:1, 0],
        second=problem.pairs[:1, 1],
        pair=np.array([0]),
        places=np.stack([places[None], places[None, ::-1]]),
        points=np.array([[0.3, 0.1, -0.2]]),
        normals=np.array([[0.6, 0.0, 0.8]]),
    )
    return MirrorTerm(images, problem.place, 0.1, problem.panels)


def near(problem, panel=1):
    places = places_in(problem.layout, panel)
    count = len(places)
    return NearTerm(np.full(count, panel), places, np.ones((count, 3)), np.full(count, 0.1), problem.panels)


def level(problem):
    places = places_in(problem.layout, 1)
    count = len(places)
    normals = np.tile([0.6, 0.0, 0.8], (count, 1))
    return PlaneTerm(np.full(count, 1), places, normals, np.full(count, 0.3), np.full(count, 0.1), problem.panels)


def weighed(problem, term):
    """A held term as residuals."""
    term.hold.weight[:] = 1.0
    return Together(problem, [term])


@pytest.mark.parametrize("name", [FOLD, ALL_ROUND])
@pytest.mark.parametrize(
    "made",
    [lambda p: alike(p, RADIUS), lambda p: alike(p, HALF_ANGLE), mirrored, near, level],
    ids=["r", "a", "mirror", "near", "level"],
)
def test_derivatives_are_exact(name, made):
    case = case_of(name, 5, panels=3)
    assert jacobian_fault(weighed(case.problem, made(case.problem)), case) <= DIFFERENCES


def test_a_point_is_near_itself_among_panels_of_several_features():
    case = mixed_case(3)
    state = case.problem.state(case.unknowns)
    for panel in range(case.problem.panels):
        term = near(case.problem, panel)
        term._points = state.boundary.position[panel, places_in(case.problem.layout, panel)]
        assert np.abs(term.vectors(state)).max() == 0.0


def test_the_boundary_of_a_shape_is_that_of_its_walk():
    case = mixed_case(4)
    state, place = case.problem.state(case.unknowns), case.problem.place
    world = place.to_world(state.boundary.position) * place.length + place.centre
    for panel, shape in enumerate(panel_shapes(case.problem, case.unknowns)):
        own = world[panel, places_in(case.problem.layout, panel)]
        assert np.abs(boundary_of(shape) - own).max() <= 1e-9 * place.length


def test_a_radius_counts_by_its_ratio_and_whichever_way_it_bends():
    case = case_of("cylinder", 1, panels=2)
    column = 5 + DIMENSIONS["cylinder"].index("radius")
    sweep = column + 1
    case.unknowns[1] = case.unknowns[0]
    case.unknowns[1, [column, sweep]] *= -1.0
    term = alike(case.problem, RADIUS)
    assert np.abs(term.vectors(case.problem.state(case.unknowns))).max() == 0.0
    case.unknowns[1, column] *= 2.0
    assert term.vectors(case.problem.state(case.unknowns)).item() == pytest.approx(-0.1 * np.log(2.0))


def test_points_in_their_planes_are_off_them_by_nothing_and_others_by_their_height():
    case = case_of(FOLD, 3)
    term, state = level(case.problem), case.problem.state(case.unknowns)
    height = np.linspace(-0.1, 0.2, len(term._normals))
    points = state.boundary.position[1, places_in(case.problem.layout, 1)]
    term._offsets = points @ [0.6, 0.0, 0.8] - height
    assert term.vectors(state)[:, 0, 0] == pytest.approx(height, abs=1e-14)


def test_what_is_mirrored_is_how_far_points_are_from_the_images_of_the_others():
    """The image lies as far behind the plane, square to it."""
    case = case_of(FOLD, 6, panels=3)
    problem, state = case.problem, case.problem.state(case.unknowns)
    places, world = places_in(problem.layout, 0), problem.place.to_world(state.boundary.position)
    first, second = world[0, places], world[1, places[::-1]]
    point, normal = np.array([0.3, 0.1, -0.2]), np.array([0.6, 0.0, 0.8])
    image = second - 2.0 * ((second - point) @ normal)[:, None] * normal
    assert mirrored(problem).vectors(state)[0] == pytest.approx(first - image, abs=1e-13)


@pytest.mark.parametrize("what", [RADIUS, HALF_ANGLE])
def test_bends_a_tenth_apart_are_held_as_a_hundredth_of_the_length(what):
    term = alike(case_of(FOLD, 1).problem, what)
    assert term.hold.radius == pytest.approx(np.full(term.hold.radius.shape, 0.01), rel=1e-15)
