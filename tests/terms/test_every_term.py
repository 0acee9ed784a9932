"""The laws that every term of the objective obeys."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.walk import cut_planes
from cadpanel.fitting.problem import Objective, Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.solver.blocks import Normal
from cadpanel.terms.deviation import Deviation, assign, skin_normals
from cadpanel.terms.drift import Outline
from cadpanel.terms.gap import Placement, Seams
from cadpanel.terms.state import State
from tests.chains import FEATURES, SYMMETRIC, made_problem, random_unknowns

STEP = 1e-6
# Central differences with this step, relative to the largest derivative.
DIFFERENCES = 1e-6
# Sums of the same numbers in another order, relative to the largest.
ROUNDING = 1e-11

few = settings(max_examples=2)
seeds = st.integers(0, 10_000)

TERMS = {
    "deviation": lambda problem: problem.deviation,
    "corner gap": lambda problem: problem.corner_gap(1.0),
    "arc gap": lambda problem: problem.arc_gap(1.0),
    "drift along": lambda problem: problem.drift_limits(FitSettings(), 0.0)[0],
    "drift across": lambda problem: problem.drift_limits(FitSettings(), 0.0)[1],
}
PAIRED = ("corner gap", "arc gap")
HELD = tuple(name for name in TERMS if name != "deviation")

every_term = pytest.mark.parametrize("term", TERMS)
every_feature = pytest.mark.parametrize("name", sorted(FEATURES))
every_symmetric_feature = pytest.mark.parametrize("name", sorted(SYMMETRIC))


def made_term(term, problem, seed=None):
    """The term, its weights shaken where a seed is given, so that no two rows weigh the same."""
    made = TERMS[term](problem)
    if seed is not None and term in HELD:
        made.hold.weight = np.random.default_rng(seed).uniform(0.5, 2.0, made.hold.weight.shape)
    return made


def in_order(problem, name):
    """The same problem with all seams in one sense, for chains that are not the same from both sides."""
    if name in SYMMETRIC or FEATURES[name].patches == FEATURES[name].patches[::-1]:
        return problem
    return replace(problem, seams=replace(problem.seams, reversed=np.zeros(len(problem.seams.panels), dtype=bool)))


def dense(rows, problem):
    """Residuals (q,) and their Jacobian (q, panels x free) by all unknowns."""
    size = len(problem.feature.free)
    residuals, jacobians = [np.zeros(0)], [np.zeros((0, problem.panels * size))]
    for group in rows:
        count, q = group.residual.shape
        jacobian = np.zeros((count, q, problem.panels, size))
        for panels, part in zip(group.panels, group.jacobians, strict=True):
            for g in range(count):
                jacobian[g, :, panels[g]] += part[g]
        residuals.append(group.residual.reshape(-1))
        jacobians.append(jacobian.reshape(count * q, -1))
    return np.concatenate(residuals), np.concatenate(jacobians)


def setup(term, name, seed, **how):
    problem = in_order(made_problem(FEATURES[name], seed, **how), name)
    unknowns = random_unknowns(FEATURES[name], seed, problem.panels)
    return problem, unknowns, made_term(term, problem, seed)


def empty(problem):
    """A model of the problem to add to."""
    return Normal.zero(problem.panels, len(problem.feature.free), len(problem.pairs))


def largest(values):
    return max(1.0, float(np.abs(values).max(initial=0.0)))


def jacobian_fault(made, problem, unknowns):
    """How far the rows' Jacobian is from central differences, relative to its largest entry."""
    _, exact = dense(made.rows(problem.state(unknowns, derivatives=True)), problem)
    numeric = np.empty_like(exact)
    for j in range(exact.shape[1]):
        step = np.zeros(exact.shape[1])
        step[j] = STEP
        ahead, behind = (
            dense(made.rows(problem.state(unknowns + sign * step.reshape(unknowns.shape), derivatives=True)), problem)[
                0
            ]
            for sign in (1.0, -1.0)
        )
        numeric[:, j] = (ahead - behind) / (2.0 * STEP)
    return np.abs(exact - numeric).max() / largest(exact)


@every_term
@every_feature
def test_the_rows_jacobian_agrees_with_finite_differences(term, name):
    problem, unknowns, made = setup(term, name, 7, panels=3, ring=True)
    assert jacobian_fault(made, problem, unknowns) <= DIFFERENCES


@every_term
def test_a_jacobian_that_is_off_by_a_little_is_found(term):
    problem, unknowns, made = setup(term, "plane-cone-plane", 3)

    class Wrong:
        def rows(self, state):
            rows = made.rows(state)
            rows[0].jacobians[0][0, 0, 0] += 1e-4
            return rows

    assert jacobian_fault(Wrong(), problem, unknowns) > DIFFERENCES


@every_term
@every_feature
@few
@given(seed=seeds, ring=st.booleans())
def test_the_model_is_that_of_the_rows(term, name, seed, ring):
    problem, unknowns, made = setup(term, name, seed, ring=ring)
    state = problem.state(unknowns, derivatives=True)
    residual, jacobian = dense(made.rows(state), problem)
    panels, size = unknowns.shape
    normal = Normal.zero(panels, size, len(problem.pairs))
    made.add_to(normal, state)
    gradient = (jacobian.T @ residual).reshape(panels, size)
    square = (jacobian.T @ jacobian).reshape(panels, size, panels, size)
    assert np.abs(normal.gradient - gradient).max() <= ROUNDING * largest(gradient)
    for i in range(panels):
        assert np.abs(normal.diagonal[i] - square[i, :, i]).max() <= ROUNDING * largest(square)
    coupled = np.zeros_like(square)
    for (i, j), block in zip(problem.pairs, normal.coupling, strict=True):
        coupled[i, :, j], coupled[j, :, i] = block, block.T
    for i in range(panels):
        coupled[i, :, i] = square[i, :, i]
    assert np.abs(coupled - square).max() <= ROUNDING * largest(square)


@every_term
@every_feature
@few
@given(seed=seeds, ring=st.booleans())
def test_the_cost_is_half_the_squares_of_the_rows(term, name, seed, ring):
    problem, unknowns, made = setup(term, name, seed, ring=ring)
    state = problem.state(unknowns, derivatives=True)
    residual, _ = dense(made.rows(state), problem)
    cost = made.cost(problem.state(unknowns))
    assert cost.shape == (problem.panels,)
    assert cost.sum() == pytest.approx(0.5 * residual @ residual, rel=ROUNDING)
    added = made.add_to(empty(problem), state)
    assert added == pytest.approx(cost, rel=ROUNDING)


@every_term
@few
@given(seed=seeds)
def test_adding_twice_adds_twice(term, seed):
    problem, unknowns, made = setup(term, "plane-cone-plane", seed)
    state = problem.state(unknowns, derivatives=True)
    once, twice = (empty(problem) for _ in range(2))
    made.add_to(once, state)
    for _ in range(2):
        made.add_to(twice, state)
    for one, two in ((once.gradient, twice.gradient), (once.diagonal, twice.diagonal), (once.coupling, twice.coupling)):
        assert np.abs(2.0 * one - two).max() <= ROUNDING * largest(two)


@dataclass
class Case:
    """A problem at some unknowns, to be told in other words."""

    problem: Problem
    unknowns: np.ndarray


def renumbered(case, order):
    """The same panels in another order; seams have their lower panel first again."""
    p, where = case.problem, np.argsort(order)
    panels, ends = where[p.seams.panels], p.seams.ends.copy()
    swap = panels[:, 0] > panels[:, 1]
    panels[swap], ends[swap] = panels[swap, ::-1], ends[swap, ::-1]
    problem = replace(
        p,
        place=Placement(
            origins=p.place.origins[order], centre=p.place.centre, axes=p.place.axes[order], length=p.place.length
        ),
        deviation=Deviation(np.ascontiguousarray(p.deviation.samples[:, order]), p.deviation.roots[order]),
        outline=Outline(p.outline.corners[order], p.outline.along[order], p.outline.gauge[order, :, 1]),
        lengths=p.lengths[order],
        seams=Seams(panels=panels, ends=ends, reversed=p.seams.reversed, pair=p.seams.pair),
        pairs=panels,
    )
    return Case(problem, case.unknowns[order])


HALF_TURN = np.array([-1.0, -1.0, 1.0])


def flipped(case, panel):
    """The same panels, one of them walked from its other end: both its directions turn about, outwards stays."""
    p, of = case.problem, case.problem.feature
    axes, samples = p.place.axes.copy(), p.deviation.samples.copy()
    axes[panel] *= HALF_TURN
    samples[:, panel] *= HALF_TURN[:, None]
    corners, along, end_normals = p.outline.corners.copy(), p.outline.along.copy(), p.outline.gauge[:, :, 1].copy()
    corners[panel] = corners[panel, ::-1, ::-1] * HALF_TURN
    along[panel] = along[panel, ::-1, ::-1] * HALF_TURN
    end_normals[panel] = end_normals[panel, ::-1] * HALF_TURN
    here = p.seams.panels == panel
    problem = replace(
        p,
        place=Placement(origins=p.place.origins, centre=p.place.centre, axes=axes, length=p.place.length),
        deviation=Deviation(samples, p.deviation.roots),
        outline=Outline(corners, along, end_normals),
        seams=replace(
            p.seams, ends=np.where(here, 1 - p.seams.ends, p.seams.ends), reversed=p.seams.reversed ^ here.any(axis=1)
        ),
    )
    values = of.expand(case.unknowns)
    old = values[panel].copy()
    values[panel, :5] = old[:5] * [-1.0, 1.0, -1.0, -1.0, 1.0]
    last = len(of.patches) - 1
    for i, patch in enumerate(of.patches):
        turned = [1.0, -1.0] if patch.kind == "plane" else [1.0, -1.0, 1.0]
        values[panel, of.patch_slice(i)] = old[of.patch_slice(last - i)] * turned
    for end in (0, 1):
        values[panel, of.cut_slice(end)] = old[of.cut_slice(1 - end)] * [-1.0, 1.0, -1.0]
    return Case(problem, values[:, of.free])


def cost(term, case):
    made = TERMS[term](case.problem)
    return made.cost(case.problem.state(case.unknowns))


@every_term
@every_symmetric_feature
@few
@given(seed=seeds, ring=st.booleans(), order=st.permutations(range(4)))
def test_the_order_of_panels_does_not_matter(term, name, seed, ring, order):
    problem = made_problem(SYMMETRIC[name], seed, ring=ring)
    case = Case(problem, random_unknowns(SYMMETRIC[name], seed, problem.panels))
    there = cost(term, renumbered(case, np.array(order)))
    if term in PAIRED:
        # Which of its two panels a seam is booked on depends on the order.
        assert there.sum() == pytest.approx(cost(term, case).sum(), rel=ROUNDING)
    else:
        assert there == pytest.approx(cost(term, case)[order], rel=ROUNDING)


@every_term
@every_symmetric_feature
@few
@given(seed=seeds, ring=st.booleans(), panel=st.integers(0, 3))
def test_a_panel_walked_from_its_other_end_costs_the_same(term, name, seed, ring, panel):
    problem = made_problem(SYMMETRIC[name], seed, ring=ring)
    case = Case(problem, random_unknowns(SYMMETRIC[name], seed, problem.panels))
    assert cost(term, flipped(case, panel)) == pytest.approx(cost(term, case), rel=1e-9)


@every_term
@few
@given(seed=seeds)
def test_turning_and_shifting_everything_does_not_matter(term, seed):
    problem, unknowns, _ = setup(term, "plane-cone-plane", seed)
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    place = replace(problem.place, origins=problem.place.origins @ turn.T + 500.0, axes=turn @ problem.place.axes)
    moved = replace(problem, place=place)
    assert cost(term, Case(moved, unknowns)) == pytest.approx(cost(term, Case(problem, unknowns)), rel=1e-9)


@pytest.mark.parametrize("term", PAIRED)
@every_symmetric_feature
def test_a_panel_that_continues_its_neighbour_has_no_gap(term, name):
    """One panel twice in the same place, and a seam between the same end of both."""
    of = SYMMETRIC[name]
    problem = made_problem(of, 5, panels=2)
    unknowns = np.repeat(random_unknowns(of, 5, 1), 2, axis=0)
    same = replace(
        problem,
        place=replace(
            problem.place,
            origins=np.repeat(problem.place.origins[:1], 2, axis=0),
            axes=np.repeat(problem.place.axes[:1], 2, axis=0),
        ),
        seams=replace(problem.seams, ends=np.array([[1, 1]]), reversed=np.array([False])),
    )
    assert cost(term, Case(same, unknowns)).sum() <= 1e-24
    unknowns[1, list(of.free).index(of.cut_slice(1).start)] += 1e-6
    assert cost(term, Case(same, unknowns)).sum() > 1e-24


@pytest.mark.parametrize("term", PAIRED)
def test_without_seams_there_is_no_gap(term):
    problem, unknowns, made = setup(term, "plane-cone-plane", 1, panels=1)
    state = problem.state(unknowns, derivatives=True)
    assert np.array_equal(made.cost(state), np.zeros(1))
    assert np.array_equal(made.add_to(Normal.zero(1, unknowns.shape[1], 0), state), np.zeros(1))
    assert made.rows(state) == []
    assert made.hold.excess(made.vectors(state)) == 0.0


@every_term
def test_rows_without_derivatives_are_refused(term):
    problem, unknowns, made = setup(term, "plane-cone-plane", 1)
    with pytest.raises(ValueError, match="without derivatives"):
        made.rows(problem.state(unknowns))


@few
@given(seed=seeds)
def test_drift_is_split_into_along_and_across(seed):
    problem, unknowns, _ = setup("drift along", "plane-cone-plane", seed)
    along, across = problem.drift_limits(FitSettings(), 0.0)
    state = problem.state(unknowns)
    outer = along.vectors(state).reshape(problem.panels, 2, -1, 1)[:, :, [0, -1]] * problem.outline.along[:, :, [0, -1]]
    drift = problem.outline.drift(state)[:, :, [0, -1]]
    sideways = across.vectors(state).reshape(problem.panels, 2, 2, 3)
    assert np.abs(outer + sideways - drift).max() <= 1e-14
    assert np.abs(np.sum(outer * sideways, axis=-1)).max() <= 1e-14


def test_inner_corners_may_slide_along_an_end_that_runs_askew():
    """Corners of the same cut plane lie on one plane: moved within it they stay on the reference's end."""
    problem, unknowns, _ = setup("drift along", "plane-cone-plane", 8)
    state = problem.state(unknowns)
    end_normals, _ = cut_planes(state.walked)
    sliding = np.cross(end_normals, [0.3, 0.2, 0.9])[:, :, None] * np.array([0.0, 0.1, -0.05, 0.0])[:, None]
    for shift, bound in ((sliding, 1e-24), (sliding + 1e-6 * end_normals[:, :, None], np.inf)):
        outline = Outline(state.corners.position + shift, problem.outline.along, end_normals)
        there = cost("drift along", Case(replace(problem, outline=outline), unknowns))
        assert there.max() <= bound
    assert there.min() > 1e-24


def test_a_corner_on_its_reference_has_no_drift_and_one_off_it_has():
    problem, unknowns, _ = setup("drift along", "plane-cone-plane", 2)
    state = problem.state(unknowns)
    outline = problem.outline
    there = replace(problem, outline=Outline(state.corners.position, outline.along, outline.gauge[:, :, 1]))
    assert all(cost(term, Case(there, unknowns)).sum() == 0.0 for term in ("drift along", "drift across"))
    unknowns[0, 0] += 1e-6
    assert all(cost(term, Case(there, unknowns))[0] > 0.0 for term in ("drift along", "drift across"))


@every_feature
@few
@given(seed=seeds)
def test_every_sample_belongs_to_the_patch_on_which_its_foot_lies(name, seed):
    of = FEATURES[name]
    problem = made_problem(of, seed)
    unknowns = random_unknowns(of, seed, problem.panels)
    walked = problem.state(unknowns).walked
    random = np.random.default_rng(seed)
    arcs, edges = walked.arcs, walked.edges
    curved = [i for i, patch in enumerate(of.patches) if patch.kind != "plane"]
    shares = arcs.p.shape[1] // len(curved)
    points, patches = [], []
    for k, i in enumerate(curved):
        points.append(arcs.p[:, k * shares : (k + 1) * shares])
        patches += [i] * shares
    for i, patch in enumerate(of.patches):
        if patch.kind == "plane":
            points.append(0.5 * (edges.p[:, i] + edges.p[:, i + 1])[:, None])
            patches.append(i)
    stacked = np.concatenate(points, axis=1)
    x = np.moveaxis(stacked, 2, 0)
    assert np.array_equal(assign(walked, x), np.broadcast_to(patches, stacked.shape[:2]))
    # They lie on the skin: no distance, and the normals are those of their rulings.
    on_skin = Deviation(x, np.ones(stacked.shape[:2]))
    assert np.abs(on_skin.distances(walked)[0]).max() <= 1e-12
    normals = skin_normals(walked, x, assign(walked, x))
    assert np.abs(normals[:, : arcs.n.shape[1]] - arcs.n).max() <= 1e-12
    # Off the skin by a height, along the normal: that height is the distance.
    height = random.uniform(-0.02, 0.02, stacked.shape[:2])
    lifted = Deviation(np.moveaxis(stacked + height[..., None] * normals, 2, 0), np.ones(stacked.shape[:2]))
    assert np.abs(lifted.distances(walked)[0] - height).max() <= 1e-12


def test_samples_of_weight_zero_do_not_count():
    problem, unknowns, _ = setup("deviation", "plane-cone-plane", 4)
    roots = problem.deviation.roots.copy()
    roots[:, ::2] = 0.0
    half = Deviation(problem.deviation.samples, roots)
    wild = problem.deviation.samples.copy()
    wild[:, :, ::2] += 0.7
    state = problem.state(unknowns)
    assert np.array_equal(half.cost(state), Deviation(wild, roots).cost(state))
    assert half.cost(state).sum() < problem.deviation.cost(state).sum()


def test_many_panels_are_worked_on_in_parts_that_do_not_show():
    """More panels than are worked on together, against each of them alone."""
    of = FEATURES["plane-cone-plane"]
    problem = made_problem(of, 9, panels=70)
    unknowns = random_unknowns(of, 9, 70)
    state = problem.state(unknowns, derivatives=True)
    normal = empty(replace(problem, pairs=problem.pairs[:0]))
    together = problem.deviation.add_to(normal, state)
    assert together == pytest.approx(problem.deviation.cost(state), rel=ROUNDING)
    for i in (0, 63, 64, 69):
        alone = Deviation(problem.deviation.samples[:, i : i + 1], problem.deviation.roots[i : i + 1])
        own = Normal.zero(1, unknowns.shape[1], 0)
        one = State(problem.state(unknowns[i : i + 1], derivatives=True).walked)
        assert alone.add_to(own, one)[0] == pytest.approx(together[i], rel=ROUNDING)
        assert np.abs(own.diagonal[0] - normal.diagonal[i]).max() <= ROUNDING * largest(own.diagonal)


def test_an_objective_is_the_sum_of_its_terms():
    problem, unknowns, _ = setup("deviation", "plane-cone-plane", 6)
    terms = [make(problem) for make in TERMS.values()]
    objective = Objective(problem, terms, coupled=True)
    state = problem.state(unknowns)
    assert objective.cost(unknowns) == pytest.approx(sum(term.cost(state) for term in terms), rel=ROUNDING)
    booked, normal = objective.linearize(unknowns)
    assert booked == pytest.approx(objective.cost(unknowns), rel=ROUNDING)
    parts = [np.linalg.norm(normal.coupling[i]) for i in range(len(problem.pairs))]
    assert min(parts) > 0.0
