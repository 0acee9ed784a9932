"""What a choice of features may cost is counted in steps, by how much work they are."""

from __future__ import annotations

import pytest

from cadpanel.features.catalogue import feature
from cadpanel.fitting.effort import Effort, work_of
from cadpanel.fitting.problem import pose
from fixtures.arrays import reference
from fixtures.lips import Lip

COMMON, OTHER = "plane-cone-plane", "tri-cone"


@pytest.fixture(scope="module")
def posed():
    lip = reference(Lip(panels=3))
    return [pose(lip, [feature(name) for name in names])[0] for names in ((COMMON,) * 3, (COMMON, OTHER, COMMON))]


def test_a_step_on_panels_of_several_features_is_more_work(posed):
    alike, mixed = posed
    assert work_of(mixed) > 1.5 * work_of(alike)


def test_nothing_may_be_spent_before_something_measured_it_and_then_a_multiple_of_that(posed):
    alike, mixed = posed
    effort = Effort()
    assert effort.steps(alike) == 0
    effort.measured_by(alike, 20)
    assert 100 <= effort.steps(alike) <= 180
    assert effort.steps(mixed) < effort.steps(alike)


def test_what_was_spent_is_left_no_more_and_never_less_than_nothing(posed):
    alike, _ = posed
    effort = Effort()
    effort.measured_by(alike, 20)
    before = effort.steps(alike)
    effort.spend(alike, 7)
    assert effort.steps(alike) == before - 7
    effort.spend(alike, 1000)
    assert effort.steps(alike) == 0
