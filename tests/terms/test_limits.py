"""What every limit of the catalogue owes: it measures what it holds, tells kept from broken, and says so in words."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, cast

import numpy as np
import pytest

from cadpanel.arrays import Array
from cadpanel.errors import SettingsError
from cadpanel.features.feature import Feature
from cadpanel.fitting.automatic import offenders
from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.measures.verdict import keeps_limits
from cadpanel.fitting.methods.weighted import weighted_objective
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.setting import options_of
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.limits.corner_drift import DriftAcross, DriftAlong, DriftTerm
from cadpanel.terms.limits.flange_width import FlangeWidth, WidthTerm
from cadpanel.terms.limits.kink import Kink
from cadpanel.terms.limits.limit import Limit
from cadpanel.terms.limits.lower_bound import LackTerm
from cadpanel.terms.limits.min_radius import MinRadius, RadiusTerm
from cadpanel.terms.limits.outline_drift import DriftOutline
from cadpanel.terms.limits.seam_level import SeamLevel
from cadpanel.terms.limits.seam_turn import SeamTurn
from tests.chains import FEATURES, made_problem, mixed_unknowns
from tests.columns import column
from tests.delivered import fitted, strip
from tests.known_panels import posed

every_limit = pytest.mark.parametrize("limit", LIMITS, ids=lambda limit: limit.name)
ASKED = [limit for limit in LIMITS if limit.asked]
chains = pytest.mark.parametrize(
    "name", sorted(name for name, of in FEATURES.items() if isinstance(of, Feature) and any(of.curved))
)


@dataclass
class Measured:
    """As much of the measures as limits look at."""

    shapes: Any
    lengths: Array
    drift_along: Array
    drift_across: Array
    outline_drift: Array
    turn: Array
    uneven: Array
    off_level: Array
    kink: Array
    seam_panels: Any


def lengths_held(term: LackTerm, problem: Any, unknowns: Array) -> Array:
    """(panels,) the least of the lengths that a term holds, mm."""
    state = problem.state(unknowns)
    lengths, _ = term.lengths(state.walks[0], state.corners, derivatives=False)
    return np.asarray(lengths.min(axis=1) * problem.place.length)


@chains
def test_radii_and_widths_are_measured_where_they_are_held(name: str) -> None:
    problem = made_problem(FEATURES[name], 5)
    unknowns = mixed_unknowns(problem.layout, 5)
    shapes = panel_shapes(problem, unknowns)
    zero = np.zeros(problem.panels)
    measured = Measured(
        shapes=shapes,
        lengths=zero,
        drift_along=zero,
        drift_across=zero,
        outline_drift=zero,
        turn=zero,
        uneven=zero,
        off_level=zero,
        kink=zero,
        seam_panels=zero,
    )
    for limit, kind in ((MinRadius(), RadiusTerm), (FlangeWidth(), WidthTerm)):
        terms = [term for term in limit.held(problem, FitSettings().allowed, 0.0) if isinstance(term, kind)]
        if terms:
            assert limit.measure(measured) == pytest.approx(lengths_held(terms[0], problem, unknowns), rel=1e-9)
        else:
            assert all(problem.layout.feature_of[0].curved)
            assert np.isinf(limit.measure(measured)).all()


@pytest.mark.parametrize("name", ["planar-quadrilateral", "polygon of 5"])
def test_flat_panels_have_neither_radii_nor_flanges(name: str) -> None:
    problem = made_problem(FEATURES[name], 2)
    for limit in (MinRadius(), FlangeWidth()):
        assert limit.held(problem, FitSettings().allowed, 0.0) == []


@pytest.mark.parametrize("limit", [MinRadius(), FlangeWidth()], ids=lambda limit: limit.name)
def test_least_lengths_are_held_in_the_units_of_the_solver(limit: Limit) -> None:
    """What may be lacking is a tenth of them."""
    problem = made_problem(FEATURES["plane-cone-plane"], 2)
    assert problem.place.length != 1.0
    (term,) = limit.held(problem, {limit.name: 40.0}, 0.0)
    assert isinstance(term, LackTerm)
    assert problem.place.length * term.hold.radius == pytest.approx(np.full(term.hold.radius.shape, 4.0), rel=1e-12)


@every_limit
def test_the_names_of_a_limit_are_its_own_and_its_default_is_in_its_range(limit: Limit) -> None:
    others = [other for other in LIMITS if other is not limit]
    assert limit.name not in {other.name for other in others}
    assert not {row.key for row in limit.rows} & {row.key for other in others for row in other.rows}
    assert limit.least <= limit.default <= limit.most
    assert "{" not in limit.rows[-1].form.format(1.0)


@cache
def measured_result() -> FitResult:
    """A strip of which every limit measures something; nothing of it is level, so that is made up."""
    result = fitted()
    return replace(result, measures=replace(result.measures, off_level=np.array([np.nan, 0.4, 0.3])))


def broken(limit: Limit, by: float) -> tuple[dict[str, float], float]:
    """What would have to be allowed for the strip to miss a limit by a share, or to keep it by one below 0."""
    found = limit.measure(measured_result().measures)
    worst = float(found.min() if limit.at_least else found.max())
    return {limit.name: worst * (1.0 + by if limit.at_least else 1.0 - by)}, worst


@pytest.mark.parametrize("limit", ASKED, ids=lambda limit: limit.name)
def test_a_limit_that_is_just_kept_is_kept_and_one_that_is_just_broken_is_told(limit: Limit) -> None:
    result = measured_result()
    for by, kept in ((-1e-6, True), (0.0, True), (1e-3, False)):
        allowed, worst = broken(limit, by)
        how = replace(result.settings, **cast("dict[str, Any]", allowed))
        assert keeps_limits(result.measures, how) is kept
        assert bool(limit.excess(result.measures, allowed[limit.name]).max() <= 1.0) is kept
        again = replace(result, settings=how, tolerance_met=kept)
        # What a seam does counts for both of its panels.
        beyond = int((limit.excess(result.measures, allowed[limit.name]) > 1.0).sum())
        assert len(offenders(again)) == beyond
        assert (beyond == 0) is kept
        said = again.shortfall()
        if kept:
            assert said is None
            continue
        panel = int((limit.measure(result.measures) == worst).argmax())
        assert said is not None
        assert f"panel '{result.shapes[panel].name}'" in said
        assert f"; allow a larger gap or {limit.remedy}" in said
        # With weights nothing but a deviation is asked for.
        assert keeps_limits(result.measures, replace(how, weights=Weights()))


def test_a_flange_that_is_too_narrow_is_told() -> None:
    limit = FlangeWidth()
    assert limit.missed("N 1", 0.25, limit.default, 2000.0) == (
        "a flange of panel 'N 1' is 0.25 mm wide at an end, where 1 mm are the least"
    )
    assert limit.kept(fitted().measures, 400.0).all()
    assert not limit.kept(fitted().measures, 600.0).any()


def test_the_advice_without_a_limit_that_is_missed_is_a_larger_gap_or_more_drift() -> None:
    result = replace(fitted(), settings=FitSettings(gap_tolerance=1e-3), tolerance_met=False)
    said = result.shortfall()
    assert said is not None
    assert said.startswith("the gap tolerance of 0.001 mm is not met")
    assert re.search(r"; allow a larger gap( \(--gap-tolerance [\d.]+ would hold\))? or more drift", said)


@every_limit
def test_the_worst_is_stated_in_the_units_that_people_read(limit: Limit) -> None:
    measures = measured_result().measures
    found = limit.measure(measures)
    worst = found.min() if limit.at_least else found.max()
    assert limit.worst(measures) == pytest.approx(100.0 * worst if limit.percent else worst, rel=1e-15)


def test_drift_is_held_as_shares_of_lengths_less_a_margin() -> None:
    problem = made_problem(FEATURES["plane-cone-plane"], 1)
    for limit, share in ((DriftAlong(), 0.02), (DriftAcross(), 0.02)):
        (term,) = limit.held(problem, FitSettings().allowed, 0.1)
        assert isinstance(term, DriftTerm)
        assert term.hold.radius == pytest.approx(np.full(term.hold.radius.shape, 0.9 * share), rel=1e-15)
    allowed = FitSettings(drift_along=0.05).allowed
    (across,) = DriftAcross().held(made_problem(FEATURES["polygon of 5"], 1), allowed, 0.0)
    # All of a polygon's drift is limited as one, by the first limit.
    assert np.all(across.hold.radius == 0.05)


@cache
def _problem() -> tuple[Any, Array]:
    problem = made_problem(FEATURES["plane-cone-plane"], 3)
    return problem, mixed_unknowns(problem.layout, 3)


def test_weights_hold_the_radius_that_was_asked_for_and_not_the_default() -> None:
    problem, unknowns = _problem()
    usual, strict = (
        weighted_objective(problem, Weights(), FitSettings(min_radius=radius)).cost(unknowns).sum()
        for radius in (10.0, 5000.0)
    )
    assert strict > usual


def test_the_weight_of_drift_is_that_of_its_terms() -> None:
    problem, _ = _problem()
    model = weighted_objective(problem, Weights(drift=0.5, deviation=2.0), FitSettings())
    weights = [term.hold.weight for term in model.terms if isinstance(term, DriftTerm)]
    assert len(weights) == 2
    assert all(np.all(weight == 0.25) for weight in weights)


def test_measures_are_what_limits_look_at() -> None:
    result: FitResult = fitted()
    measures: Measures = result.measures
    assert measures.shapes == result.shapes


@pytest.mark.parametrize("limit", [limit for limit in LIMITS if limit.percent], ids=lambda limit: limit.name)
def test_shares_of_a_length_are_asked_for_in_percent_within_the_limits_own_range(limit: Limit) -> None:
    (option,) = (option for one, option in options_of(FitSettings) if one.name == limit.name)
    assert option.read is not None
    assert option.show is not None
    for share in (limit.least, 0.07, limit.most):
        assert option.read("--it", 100.0 * share) == pytest.approx(share, rel=1e-15)
        assert option.show(share) == pytest.approx(100.0 * share, rel=1e-12)
    for share in (0.99 * limit.least, 1.01 * limit.most):
        with pytest.raises(SettingsError, match=r"--it must be between 0\.01 and 50 percent of the panel's length"):
            option.read("--it", 100.0 * share)


UPPER = [limit for limit in ASKED if not limit.at_least]


def radii(limit: Limit, allowed: float, margin: float) -> list[Array]:
    """How far vectors may reach in every term that a limit holds of a strip, in the solver's unit."""
    level = limit.name == SeamLevel.name
    both = {limit.name: allowed, DriftAlong.name: allowed}  # drifts along and across are held together
    problem, _ = (
        posed(column(rows=2, columns=4), FitSettings(feature="cone")) if level else posed(strip(), FitSettings())
    )
    return [np.asarray(term.hold.radius) for term in limit.held(problem, both, margin)]


@pytest.mark.parametrize("limit", UPPER, ids=lambda limit: limit.name)
def test_a_margin_holds_a_limit_as_if_less_by_it_were_allowed(limit: Limit) -> None:
    allowed = min(limit.default, 0.5 * limit.most)
    with_margin, without = radii(limit, allowed, 0.2), radii(limit, 0.8 * allowed, 0.0)
    assert len(with_margin) == len(without) > 0
    for one, other, whole in zip(with_margin, without, radii(limit, allowed, 0.0), strict=True):
        assert one == pytest.approx(other, rel=1e-12)
        assert (one < 0.9 * whole).all()


@pytest.mark.parametrize("limit", [Kink(), SeamTurn(), SeamLevel(), DriftOutline()], ids=lambda limit: limit.name)
def test_what_may_be_as_large_as_it_likes_is_not_held(limit: Limit) -> None:
    assert radii(limit, 0.999 * limit.most, 0.0)
    assert radii(limit, limit.most, 0.0) == []
