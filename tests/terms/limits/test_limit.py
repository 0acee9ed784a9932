"""Laws of all limits: how far they hold follows the panels' lengths, the margin and what is allowed; what is kept."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cadpanel.fitting.problem import Problem
from cadpanel.fitting.settings import FitSettings
from cadpanel.terms.limits.corner_drift import DriftAcross, DriftAlong
from cadpanel.terms.limits.evenness import Evenness, EvennessTerm
from cadpanel.terms.limits.kink import Kink
from cadpanel.terms.limits.limit import Limit
from cadpanel.terms.limits.obliqueness import Obliqueness
from cadpanel.terms.limits.outline_drift import DriftOutline
from cadpanel.terms.limits.seam_level import SeamLevel
from cadpanel.terms.limits.seam_turn import SeamTurn
from cadpanel.terms.outline import Level, Line
from tests.terms.models import case_of

SHARES = (DriftAlong(), DriftAcross(), Evenness(), DriftOutline())
ANGLES = (Kink(), SeamTurn())
# Asked for at the most, they ask for nothing.
UNASKED = (Kink(), SeamTurn(), SeamLevel(), DriftOutline())
ALLOWED = {limit.name: 0.04 for limit in SHARES} | {limit.name: 5.0 for limit in ANGLES}


def by_name(limit: Limit) -> str:
    return limit.name


def drawn(lengths: float = 1.0) -> Problem:
    """A strip with a level seam and a free line, of panels with these lengths."""
    problem = case_of("plane-cone-plane", 3).problem
    level = Level(
        panels=np.array([1, 2]), points=np.array([0, -1]), normals=np.tile([0.0, 0.6, 0.8], (2, 1)), offsets=np.zeros(2)
    )
    line = Line(
        panels=np.array([0, 3]),
        places=np.tile([0, 4], (2, 3, 1)),
        shares=np.tile([0.2, 0.5, 0.8], (2, 1)),
        straight=np.array([True, False]),
        drawn=np.tile([[0.1, -1.0, 0.2], [0.0, 1.0, 0.1]], (2, 1, 1)),
    )
    outline = replace(problem.outline, level=level, line=line)
    return replace(problem, outline=outline, lengths=np.full(problem.panels, lengths))


def radii(limit: Limit, problem: Problem, allowed: float, margin: float = 0.0) -> list[np.ndarray]:
    terms = limit.held(problem, FitSettings().allowed | {limit.name: allowed}, margin)
    assert terms
    return [term.hold.radius for term in terms]


@pytest.mark.parametrize("limit", [*SHARES, *ANGLES, Obliqueness()], ids=by_name)
def test_panels_twice_as_long_are_held_twice_as_far(limit: Limit) -> None:
    """In directions it is the same: what an angle leads aside is told in the length of the panel."""
    allowed = ALLOWED.get(limit.name, limit.default)
    for once, twice in zip(radii(limit, drawn(), allowed), radii(limit, drawn(2.0), allowed), strict=True):
        assert twice == pytest.approx(2.0 * once, rel=1e-12)


@pytest.mark.parametrize("limit", SHARES, ids=by_name)
def test_shares_of_a_length_are_held_less_a_margin(limit: Limit) -> None:
    """Of the free outline a little less besides, as edges part between the places that are held."""
    for held in radii(limit, drawn(3.0), 0.04, 0.25):
        shares = held / (0.75 * 0.04 * 3.0)
        if isinstance(limit, DriftOutline):
            shares = shares / np.array([[0.98], [0.8]])
        assert shares == pytest.approx(np.ones(held.shape), rel=1e-12)


@pytest.mark.parametrize("limit", ANGLES, ids=by_name)
def test_angles_are_held_by_what_they_lead_aside_less_a_margin(limit: Limit) -> None:
    for held in radii(limit, drawn(3.0), 40.0, 0.25):
        angle = 2.0 * np.arcsin(0.5 * held / 3.0) if isinstance(limit, Kink) else np.arcsin(held / 3.0)
        assert np.degrees(angle) == pytest.approx(np.full(held.shape, 30.0), rel=1e-12)


def test_level_seams_are_held_in_the_solvers_length_less_a_margin() -> None:
    problem = drawn()
    assert problem.place.length == 2000.0
    (held,) = radii(SeamLevel(), problem, 8.0, 0.25)
    assert held == pytest.approx(np.full((2, 1), 0.003), rel=1e-12)


@pytest.mark.parametrize("limit", UNASKED, ids=by_name)
def test_at_the_most_nothing_is_held_and_a_little_below_it_is(limit: Limit) -> None:
    assert limit.held(drawn(), {limit.name: limit.most}, 0.0) == []
    assert radii(limit, drawn(), 0.99 * limit.most)


@pytest.mark.parametrize("limit", [SeamTurn(), SeamLevel(), DriftOutline(), Evenness()], ids=by_name)
def test_where_nothing_is_drawn_that_it_could_hold_it_holds_nothing(limit: Limit) -> None:
    problem = case_of("plane-cone-plane", 3, panels=1).problem
    pieces = replace(problem.outline.pieces, planes=0.0 * problem.outline.pieces.planes)
    bare = replace(problem, outline=replace(problem.outline, pieces=pieces))
    assert limit.held(bare, FitSettings().allowed | {limit.name: 0.4 * limit.most}, 0.0) == []


def test_of_panels_of_which_all_corners_drift_alike_seams_are_even() -> None:
    """And one corner that drifts a little further makes them uneven by half of that."""
    case = case_of("plane-cone-plane", 4)
    problem, state = case.problem, case.problem.state(case.unknowns)
    away = np.random.default_rng(1).normal(size=(problem.panels, 1, 3))
    outline = replace(problem.outline, corners=state.corners.position - away)
    (even,) = Evenness().held(replace(problem, outline=outline), ALLOWED, 0.0)
    assert np.abs(even.vectors(state)).max() <= 1e-14
    assert isinstance(even, EvennessTerm)
    met = problem.across
    normal = problem.place.axes[met.panels[0, 0]].T @ met.normals[0, 0]
    aside = np.cross(normal, [0.0, 0.0, 1.0])
    outline.corners[met.panels[0, 0], even._on[0, 0, 0]] -= 0.01 * aside / np.linalg.norm(aside)
    (uneven,) = Evenness().held(replace(problem, outline=outline), ALLOWED, 0.0)
    assert np.linalg.norm(uneven.vectors(state)[0, 0]) == pytest.approx(0.005, rel=1e-9)


def measures(**found: Any) -> Any:
    """As much of the measures as a limit looks at."""
    return SimpleNamespace(lengths=np.array([2000.0, 500.0]), seam_panels=np.array([[0, 1]]), **found)


def test_drift_and_unevenness_are_shares_of_each_panels_own_length() -> None:
    off = np.array([10.0, 10.0])
    assert DriftAlong().measure(measures(drift_along=off)).tolist() == [0.005, 0.02]
    assert DriftAcross().measure(measures(drift_across=off)).tolist() == [0.005, 0.02]
    assert DriftOutline().measure(measures(outline_drift=off)).tolist() == [0.005, 0.02]
    assert Evenness().measure(measures(uneven=off[:1])).tolist() == [0.005, 0.02]


class Known(DriftAlong):
    """A limit of numbers as they are given."""

    percent = False

    def measure(self, measured: Any) -> np.ndarray:
        return np.asarray(measured.known)


class KnownLeast(Known):
    """The same of numbers that must not fall below it."""

    at_least = True


@pytest.mark.parametrize(
    ("limit", "kept", "excess", "worst"),
    [(Known(), [True, True, False], [0.5, 1.0, 1.5], 6.0), (KnownLeast(), [False, True, True], [1.5, 1.0, 0.5], 2.0)],
    ids=["most", "least"],
)
def test_what_is_just_allowed_is_kept_and_used_up(limit: Limit, kept: list[bool], excess: list[float], worst: float):
    found = measures(known=[2.0, 4.0, 6.0])
    assert limit.kept(found, 4.0).tolist() == kept
    assert limit.excess(found, 4.0).tolist() == excess
    assert limit.worst(found) == worst
    assert limit.stated(3.0) == 3.0
    assert DriftAlong().stated(3.0) == 300.0
