"""Problems at some unknowns, told in other words; terms; and what the laws of terms measure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.catalogue import feature
from cadpanel.features.feature import Feature
from cadpanel.features.layout import Layout
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.polygon import Polygon
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.methods.holding import gap_terms
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.across_seams import across_edges
from cadpanel.solver.blocks import Normal
from cadpanel.terms.arc_gap import ArcGap
from cadpanel.terms.corner_gap import CornerGap
from cadpanel.terms.deviation import Deviation
from cadpanel.terms.edge_gap import MixedGap
from cadpanel.terms.limits.corner_drift import DriftTerm
from cadpanel.terms.limits.evenness import EvennessTerm
from cadpanel.terms.limits.kink import KinkTerm
from cadpanel.terms.limits.planes import PlaneTerm
from cadpanel.terms.limits.seam_turn import TurnTerm
from cadpanel.terms.outline import Limited, Pieces
from cadpanel.terms.parted_gap import PartedGap
from cadpanel.terms.rows import Rows
from cadpanel.terms.rules.alike import AlikeTerm
from cadpanel.terms.rules.mirrored import MirrorTerm
from cadpanel.terms.rules.near import NearTerm
from cadpanel.terms.seams import batches
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm, Term
from tests.chains import FEATURES, made_problem, mixed_unknowns, problem_of, random_unknowns

STEP = 1e-6
# Central differences with this step, relative to the largest derivative.
DIFFERENCES = 1e-6
# Sums of the same numbers in another order, relative to the largest.
ROUNDING = 1e-11


HELD = (CornerGap, ArcGap, MixedGap, PartedGap, DriftTerm, TurnTerm, EvennessTerm, KinkTerm)
RULES = (AlikeTerm, PlaneTerm, MirrorTerm, NearTerm)


class Together:
    """Terms of one kind, one for each batch of seams, as one term."""

    def __init__(self, problem: Problem, parts: Sequence[Term]) -> None:
        self.panels, self.parts = problem.panels, tuple(parts)

    def cost(self, state: State) -> Array:
        return sum((part.cost(state) for part in self.parts), np.zeros(self.panels))

    def add_to(self, normal: Normal, state: State) -> Array:
        return sum((part.add_to(normal, state) for part in self.parts), np.zeros(self.panels))

    def residual(self, state: State) -> Array:
        """(q,) what the rows' residuals are, in their order, from the distances and vectors that the terms tell of."""
        found = [np.zeros(0)]
        for part in self.parts:
            if isinstance(part, Deviation):
                weighted = part.roots * part.distances(state, held=True)[0]
                found += [weighted[group.panels].reshape(-1) for group in state.layout.groups]
            if isinstance(part, HELD + RULES):
                found.append((np.sqrt(part.hold.weight)[..., None] * part.vectors(state)).reshape(-1))
        return np.concatenate(found)

    def rows(self, state: State) -> list[Rows]:
        return [rows for part in self.parts for rows in part.rows(state)]


def drift_terms(problem: Problem) -> list[DriftTerm]:
    """Along and across."""
    return [term for term in problem.limits(FitSettings()) if isinstance(term, DriftTerm)]


def parted_gaps(problem: Problem) -> list[Term]:
    """Gaps in parts, looked at where every panel has the same numbers: whatever their order."""
    alike = np.zeros((problem.panels, problem.layout.size))
    for group in problem.layout.groups:
        (own,) = random_unknowns(group.feature, 3, 1)
        alike[group.panels, : len(own)] = own
    terms = gap_terms(problem, {"width": 500.0, "step": 200.0, "shift": 900.0}, problem.state(alike))
    return list(terms)


def limit_terms(kind: type[HeldTerm]) -> Callable[[Problem], list[Term]]:
    """What the limits of the catalogue hold of one kind."""
    settings = FitSettings(max_kink=5.0)

    def found(problem: Problem) -> list[Term]:
        return [term for term in problem.limits(settings) if isinstance(term, kind)]

    return found


TERMS: dict[str, Callable[[Problem], list[Term]]] = {
    "deviation": lambda problem: [problem.deviation],
    "corner gap": lambda problem: list(problem.corner_gaps(1.0)),
    "arc gap": lambda problem: [term for term in problem.curve_gaps(1.0) if isinstance(term, ArcGap)],
    "mixed gap": lambda problem: [term for term in problem.curve_gaps(1.0) if isinstance(term, MixedGap)],
    "parted gap": parted_gaps,
    "turn": limit_terms(TurnTerm),
    "evenness": limit_terms(EvennessTerm),
    "kink": limit_terms(KinkTerm),
    "drift along": lambda problem: list(drift_terms(problem)[:1]),
    "drift across": lambda problem: list(drift_terms(problem)[1:]),
}


def applies(term: str, name: str) -> bool:
    """Whether a term has anything to say of a strip of one feature, every third seam of which is reversed."""
    curved = FEATURES[name].curved
    return {
        "arc gap": any(curved),
        # Turned round, an end is not alike unless it is a palindrome.
        "mixed gap": curved != curved[::-1],
        "evenness": isinstance(FEATURES[name], Feature),
    }.get(term, True)


def made_term(term: str, problem: Problem, seed: int | None = None) -> Together:
    """The term, its weights shaken where a seed is given, so that no two rows weigh the same."""
    parts = TERMS[term](problem)
    if seed is not None:
        random = np.random.default_rng(seed)
        for part in parts:
            if isinstance(part, HELD):
                part.hold.weight = random.uniform(0.5, 2.0, part.hold.weight.shape)
    return Together(problem, parts)


@dataclass
class Case:
    """A problem at some unknowns."""

    problem: Problem
    unknowns: Array
    _around: list[tuple[State, State]] = field(default_factory=list, init=False)

    def around(self) -> list[tuple[State, State]]:
        """For each unknown the states a step ahead and a step behind, walked once for all terms."""
        if not self._around:
            for j in range(self.unknowns.size):
                step = np.zeros(self.unknowns.size)
                step[j] = STEP
                shaped = step.reshape(self.unknowns.shape)
                self._around.append(
                    (self.problem.state(self.unknowns + shaped), self.problem.state(self.unknowns - shaped))
                )
        return self._around


def case_of(name: str, seed: int, *, panels: int = 4, ring: bool = False) -> Case:
    """A strip or ring of one feature at the unknowns that its samples and outline lie near to."""
    problem = made_problem(FEATURES[name], seed, panels=panels, ring=ring)
    return Case(problem, mixed_unknowns(problem.layout, seed))


MIXED: tuple[PanelFeature, ...] = (
    feature("plane-cone-plane"),
    feature("planar-quadrilateral"),
    feature("cylinder"),
    feature("tri-cone"),
    Polygon(6),
    feature("plane-cone-plane"),
)
# Panel and edge of either side; an edge is end 0, end 1, side 0 or side 1 of a chain.
_MIXED_SEAMS = (
    ((0, 1), (1, 0)),  # a fold's end against a straight one
    ((1, 2), (3, 2)),  # sides
    ((2, 3), (1, 0)),  # two ends, one patch against three
    ((3, 4), (1, 4)),  # an end against a polygon's edge
    ((0, 4), (3, 2)),  # a side against a polygon's edge
    ((0, 3), (0, 1)),  # two ends of three patches, which are curved elsewhere
    ((0, 1), (3, 3)),  # the same two panels once more, on another edge
    ((1, 2), (0, 0)),  # a straight end against a cylinder's
    ((0, 5), (1, 0)),  # ends that are alike
    ((4, 5), (0, 1)),
)


def mixed_case(seed: int) -> Case:
    """Panels of several features that meet along all kinds of edges."""
    panels, edges = zip(*_MIXED_SEAMS, strict=True)
    problem = problem_of(MIXED, seed, panels, edges)
    return Case(problem, mixed_unknowns(problem.layout, seed))


def cost(term: str, case: Case) -> Array:
    return made_term(term, case.problem).cost(case.problem.state(case.unknowns))


def empty(problem: Problem) -> Normal:
    """A model of the problem to add to."""
    return Normal.zero(problem.panels, problem.layout.size, len(problem.pairs))


def largest(values: Array) -> float:
    return max(1.0, float(np.abs(values).max(initial=0.0)))


def dense(rows: Sequence[Rows], problem: Problem) -> tuple[Array, Array]:
    """Residuals (q,) and their Jacobian (q, panels x size) by all unknowns."""
    size = problem.layout.size
    residuals, jacobians = [np.zeros(0)], [np.zeros((0, problem.panels * size))]
    for group in rows:
        count, q = group.residual.shape
        jacobian = np.zeros((count, q, problem.panels, size))
        for panels, part in zip(group.panels, group.jacobians, strict=True):
            for g in range(count):
                jacobian[g, :, panels[g]] += part[g]
        residuals.append(group.residual.reshape(-1))
        jacobians.append(jacobian.reshape(count * q, problem.panels * size))
    return np.concatenate(residuals), np.concatenate(jacobians)


def jacobian_fault(made: Together, case: Case) -> float:
    """How far the rows' Jacobian is from central differences, relative to its largest entry."""
    problem, unknowns = case.problem, case.unknowns
    residual, exact = dense(made.rows(problem.state(unknowns, derivatives=True)), problem)
    assert np.abs(residual - made.residual(problem.state(unknowns))).max(initial=0.0) <= ROUNDING * largest(residual)
    numeric = np.empty_like(exact)
    for j, (ahead, behind) in enumerate(case.around()):
        numeric[:, j] = (made.residual(ahead) - made.residual(behind)) / (2.0 * STEP)
    return float(np.abs(exact - numeric).max(initial=0.0)) / largest(exact)


def assert_model_is_that_of_the_rows(made: Together, case: Case) -> None:
    """Gradient, diagonal and coupled blocks are J^T r and J^T J of the rows, and no other blocks are coupled."""
    problem, (panels, size) = case.problem, case.unknowns.shape
    state = problem.state(case.unknowns, derivatives=True)
    residual, jacobian = dense(made.rows(state), problem)
    normal = empty(problem)
    made.add_to(normal, state)
    gradient = (jacobian.T @ residual).reshape(panels, size)
    square = (jacobian.T @ jacobian).reshape(panels, size, panels, size)
    assert np.abs(normal.gradient - gradient).max() <= ROUNDING * largest(gradient)
    whole = np.zeros_like(square)
    for i in range(panels):
        whole[i, :, i] = normal.diagonal[i]
    for (i, j), block in zip(problem.pairs, normal.coupling, strict=True):
        whole[i, :, j], whole[j, :, i] = block, block.T
    assert np.abs(whole - square).max() <= ROUNDING * largest(square)


def assert_cost_is_half_the_squares(made: Together, case: Case) -> None:
    state = case.problem.state(case.unknowns, derivatives=True)
    residual, _ = dense(made.rows(state), case.problem)
    booked = made.cost(case.problem.state(case.unknowns))
    assert booked.shape == (case.problem.panels,)
    half = 0.5 * residual @ residual
    assert abs(booked.sum() - half) <= ROUNDING * half
    assert np.allclose(made.add_to(empty(case.problem), state), booked, rtol=ROUNDING, atol=0.0)


def with_seams(problem: Problem, panels: ArrayLike, edges: ArrayLike, backwards: ArrayLike) -> Problem:
    """The same panels with other seams, (seams, 2), (seams, 2) and (seams,); the lower panel need not come first."""
    which, along = (np.array(one, dtype=np.intp).reshape(-1, 2) for one in (panels, edges))
    swap = which[:, 0] > which[:, 1]
    which[swap], along[swap] = which[swap, ::-1], along[swap, ::-1]
    pairs, pair = np.unique(which, axis=0, return_inverse=True)
    against = np.asarray(backwards, dtype=bool)
    found = batches(problem.layout, which, along, against, pair.reshape(-1))
    index = problem.across.index
    across = across_edges(index, which[index], along[index], against[index], problem.across.normals)
    return replace(problem, seams=found, pairs=pairs, across=across)


def seams_of(problem: Problem) -> tuple[IntArray, IntArray, BoolArray]:
    """Panels, edges and whether they run against each other, of all seams in their order."""
    order = np.argsort(np.concatenate([batch.index for batch in problem.seams]))
    panels, edges = (np.concatenate([getattr(b, what) for b in problem.seams])[order] for what in ("panels", "edges"))
    return panels, edges, np.concatenate([batch.reversed for batch in problem.seams])[order]


def renumbered(case: Case, order: IntArray) -> Case:
    """The same panels in another order; seams have their lower panel first again."""
    p, where = case.problem, np.argsort(order)
    panels, edges, backwards = seams_of(p)
    problem = replace(
        p,
        names=tuple(p.names[i] for i in order),
        layout=Layout.of([p.layout.feature_of[i] for i in order]),
        place=replace(p.place, origins=p.place.origins[order], axes=p.place.axes[order]),
        deviation=Deviation(np.ascontiguousarray(p.deviation.samples[:, order]), p.deviation.roots[order]),
        outline=p.outline.take(order),
        lengths=p.lengths[order],
    )
    return Case(with_seams(problem, where[panels], edges, backwards), case.unknowns[order])


_HALF_TURN = np.array([-1.0, -1.0, 1.0])


def flipped(case: Case, panel: int) -> Case:
    """The same panels, one chain of them walked from its other end: both its directions turn, outwards stays."""
    p, of = case.problem, case.problem.layout.feature_of[panel]
    assert isinstance(of, Feature)
    axes, samples = p.place.axes.copy(), p.deviation.samples.copy()
    axes[panel] *= _HALF_TURN
    samples[:, panel] *= _HALF_TURN[:, None]
    corners, count = p.outline.corners.copy(), of.corner_count
    corners[panel, :count] = corners[panel, :count][::-1] * _HALF_TURN

    def turned(limited: Limited, held: int) -> Limited:
        """Corners are held in the same places, the last as the first; what counts is seen in the turned frame."""
        part = limited.part.copy()
        part[panel, :held] = part[panel, :held][::-1] * _HALF_TURN
        return Limited(corners=limited.corners, part=part)

    panels, edges, backwards = seams_of(p)
    here = panels == panel
    problem = replace(
        p,
        place=replace(p.place, axes=axes),
        deviation=Deviation(samples, p.deviation.roots),
        outline=replace(
            p.outline,
            corners=corners,
            along=turned(p.outline.along, count),
            across=turned(p.outline.across, 4),
            pieces=_turned_pieces(p.outline.pieces, panel, count, len(ARC_SHARES) * 2 * sum(of.curved)),
        ),
    )
    unknowns = case.unknowns.copy()
    unknowns[panel, : len(of.free)] = _turned_end_for_end(of, case.unknowns[panel, : len(of.free)])
    return Case(with_seams(problem, panels, np.where(here, edges ^ 1, edges), backwards ^ here.any(axis=1)), unknowns)


def _turned_pieces(pieces: Pieces, panel: int, corners: int, arcs: int) -> Pieces:
    """The same pieces of a panel whose corners and arc points are counted from its other end."""
    points, planes = pieces.points.copy(), pieces.planes.copy()
    own = points[panel]
    points[panel] = np.where(own < 0, -1 - (arcs - 1 - (-1 - own)), corners - 1 - own)
    planes[panel] *= _HALF_TURN
    return Pieces(points=points, planes=planes, lengths=pieces.lengths)


def _turned_end_for_end(of: Feature, unknowns: Array) -> Array:
    """(free,) the same panel in the frame that is turned by half a turn about its normal."""
    (old,) = of.expand(unknowns[None])
    values = old.copy()
    values[:5] = old[:5] * [-1.0, 1.0, -1.0, -1.0, 1.0]
    last = len(of.patches) - 1
    for i, curved in enumerate(of.curved):
        signs = [1.0, -1.0, 1.0] if curved else [1.0, -1.0]
        far = of.patches[last - i].dimensions(old[None, of.patch_slice(last - i)])
        values[of.patch_slice(i)] = of.patches[i].numbers_for(far.values * signs)[0]
    for end in (0, 1):
        values[of.cut_numbers[end]] = old[of.cut_numbers[1 - end]] * [-1.0, 1.0, -1.0]
    turned: Array = values[of.free]
    return turned


def counted_from(case: Case, panel: int, corner: int) -> Case:
    """The same panels, the corners of one polygon counted from another one."""
    p, of = case.problem, case.problem.layout.feature_of[panel]
    assert isinstance(of, Polygon)
    count = of.corner_count
    order = (np.arange(count) + corner) % count
    corners, unknowns = p.outline.corners.copy(), case.unknowns.copy()
    corners[panel, :count] = corners[panel, order]
    unknowns[panel, 3 : 3 + 2 * count] = unknowns[panel, 3 : 3 + 2 * count].reshape(count, 2)[order].reshape(-1)
    panels, edges, backwards = seams_of(p)
    points = p.outline.pieces.points.copy()
    points[panel] = (points[panel] - corner) % count
    problem = replace(p, outline=replace(p.outline, corners=corners, pieces=replace(p.outline.pieces, points=points)))
    return Case(
        with_seams(problem, panels, np.where(panels == panel, (edges - corner) % count, edges), backwards), unknowns
    )


def moved(case: Case, seed: int) -> Case:
    """Everything turned (or mirrored) and shifted."""
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    place = case.problem.place
    place = replace(place, origins=place.origins @ turn.T + 500.0, axes=turn @ place.axes)
    return Case(replace(case.problem, place=place), case.unknowns)


def twice_in_place(name: str, seed: int, edge: int) -> Case:
    """One panel twice in the same place, and a seam between the same edge of both."""
    problem = made_problem(FEATURES[name], seed, panels=2)
    place = problem.place
    place = replace(place, origins=np.repeat(place.origins[:1], 2, axis=0), axes=np.repeat(place.axes[:1], 2, axis=0))
    problem = with_seams(replace(problem, place=place), [(0, 1)], [(edge, edge)], [False])
    return Case(problem, np.repeat(mixed_unknowns(problem.layout, seed)[:1], 2, axis=0))
