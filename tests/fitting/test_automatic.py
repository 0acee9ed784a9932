"""`auto`: each panel gets the cheapest feature that will do, and another one where it will not."""

from collections import Counter
from copy import deepcopy
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep.read import read_reference
from cadpanel.features.catalogue import feature
from cadpanel.fitting import feature_choice
from cadpanel.fitting.feature_choice import CHEAPEST_FIRST, Choice
from cadpanel.fitting.measures.verdict import limits_of
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import LIKE_THE_PAPER, FitSettings
from fixtures.arrays import reference
from fixtures.lips import Lip
from tests.instances import random_polygon, random_shapes
from tests.known_panels import alone
from tests.thorough import cases, thorough

# Panels that are exactly what their feature is; each is cheapest for itself.
KINDS = [
    "cylinder",
    "cone",
    "plane-cylinder-plane",
    "plane-cone-plane",
    "tri-cone",
    "plane-cone-cone-plane",
    "plane-cone-plane-cone-plane",
]
CLOSE = FitSettings(feature="auto", max_deviation=0.01, method="local")


@cache
def known():
    shapes = [random_shapes(feature(kind), 2, 1)[0] for kind in KINDS]
    return alone(random_polygon(3, 5), *shapes)


@cache
def tried(most):
    return Choice(known(), replace(CLOSE, max_deviation=most))


def choice_within(most):
    """The choice among the known panels, to be changed by whoever asks; the panels are fitted once only."""
    return deepcopy(tried(most))


def names(choice):
    return [CHEAPEST_FIRST[place] for place in choice.chosen]


def test_panels_of_every_kind_get_their_own_feature():
    shapes = known()
    assert names(choice_within(0.01)) == ["planar-polygon", *KINDS]
    result = fit(shapes, CLOSE)
    assert [shape.feature for shape in result.shapes] == ["planar-polygon", *KINDS]
    assert result.measures.max_deviation.max() <= 0.01


def test_a_wider_limit_gives_cheaper_features():
    chosen = [choice_within(most).chosen for most in (0.01, 20.0, 5000.0)]
    assert np.all(np.diff(chosen, axis=0) <= 0)
    assert np.any(np.diff(chosen, axis=0) < 0, axis=1).all()
    assert not chosen[-1].any()


def test_a_feature_that_is_taken_away_is_replaced_by_the_next_that_will_do():
    choice = choice_within(0.01)
    folded = 1 + KINDS.index("plane-cone-plane")
    assert choice.forbid(np.array([folded]))
    # A tri-cone can follow a cone between two flanges only nearly; three patches of the right kind can exactly.
    assert CHEAPEST_FIRST.index("plane-cone-plane") < choice.chosen[folded]
    assert choice.deviations[folded, choice.chosen[folded]] < np.inf
    others = np.delete(np.arange(len(choice.chosen)), folded)
    assert [names(choice)[i] for i in others] == [["planar-polygon", *KINDS][i] for i in others]


def test_when_all_are_taken_away_it_says_so():
    choice = choice_within(0.01)
    assert not all(choice.forbid(np.array([0])) for _ in CHEAPEST_FIRST)


def test_panels_that_cannot_be_built_among_their_neighbours_get_another_feature(monkeypatch):
    """What cannot be built is told by the builder; here it refuses every cylinder."""
    built = feature_choice.can_be_built
    refused = lambda shape: shape.feature != "cylinder" and built(shape)  # noqa: E731
    monkeypatch.setattr("cadpanel.fitting.automatic.can_be_built", refused)
    result = fit(alone(random_shapes(feature("cylinder"), 2, 1)[0]), CLOSE)
    assert result.shapes[0].feature != "cylinder"
    assert result.measures.max_deviation.max() <= 0.01


@pytest.mark.parametrize("most", [20.0, 50.0])
def test_promoting_gives_the_next_closer_feature(most):
    choice = choice_within(most)
    before = choice.chosen.copy()
    choice.promote(np.arange(len(before)))
    rows = np.arange(len(before))
    assert np.all(choice.chosen >= before)
    assert np.all(choice.rms[rows, choice.chosen] <= choice.rms[rows, before] * (1.0 + 1e-6) + 1e-6)
    assert np.any(choice.chosen > before)


@cache
def strip(name):
    return read_reference(Path(__file__).parents[2] / "fixtures" / f"{name}.step")


@thorough
def test_panels_that_closing_takes_too_far_get_a_closer_feature_and_no_others():
    result = fit(strip("kai_tak_se_east"), replace(LIKE_THE_PAPER, feature="auto", max_deviation=40.0))
    assert result.tolerance_met
    found = Counter(shape.feature for shape in result.shapes)
    assert found["plane-cylinder-plane"] >= 7
    # With a wider limit nobody is taken too far, and all keep what they have alone.
    wide = fit(strip("kai_tak_se_east"), replace(LIKE_THE_PAPER, feature="auto", max_deviation=60.0))
    assert {shape.feature for shape in wide.shapes} == {"plane-cylinder-plane"}


@thorough
def test_where_no_feature_follows_closely_enough_everything_else_holds():
    result = fit(strip("kai_tak_nw"), replace(LIKE_THE_PAPER, feature="auto", max_deviation=10.0))
    assert not result.tolerance_met
    assert result.measures.max_deviation.max() > 10.0
    assert result.measures.max_seam_gap <= 1.0
    assert all(limit.kept(result.measures, allowed).all() for limit, allowed in limits_of(result.settings))


def test_what_is_chosen_is_worth_no_less_than_the_common_feature_and_holds_seams():
    """A lip that no feature follows to 20 mm: trials end when they took what they may, and the best seen is given."""
    lip = reference(Lip(panels=4))
    common = fit(lip, FitSettings())
    result = fit(lip, FitSettings(feature="auto", max_deviation=20.0))
    assert common.tolerance_met
    assert not result.tolerance_met
    assert result.measures.max_deviation.max() <= common.measures.max_deviation.max() * 1.001
    assert all(np.all(result.measures.gaps[what] <= most) for what, most in result.settings.gaps.items())


CHAINS = ["plane-cone-cone-plane", "plane-cone-plane-cone-plane", "tri-cone", "cone-spline-5"]


@pytest.mark.parametrize("name", cases(CHAINS[::2], CHAINS))
def test_chains_of_several_curved_patches_hold_a_strip_that_one_would_do_for(name):
    result = fit(strip("kai_tak_nw"), FitSettings(feature=name))
    assert result.tolerance_met
    assert result.measures.overall_rms < 7.0
