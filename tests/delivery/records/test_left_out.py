"""A seam that the report leaves out is seen where two panels meet."""

import pytest

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.records.left_out import seams_left_out
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from tests.delivered import strip

TIGHT = FitSettings(gap_tolerance=0.4, seam_turn=90.0, evenness=0.5, drift_along=0.05)


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    return deliver(fit(strip(), TIGHT), tmp_path_factory.mktemp("left") / "out", shop=ShopSettings(outputs=("step",)))


def without(report, place):
    return report.model_copy(update={"seams": tuple(seam for i, seam in enumerate(report.seams) if i != place)})


def test_where_all_are_told_none_is_missed(report):
    assert list(seams_left_out(report)) == []


@pytest.mark.parametrize("place", [0, 1])
def test_a_seam_that_is_left_out_is_named(report, place):
    (said,) = seams_left_out(without(report, place))
    first, second = report.seams[place].panels
    assert said.startswith(f"Panels '{first}' (end 1) and '{second}' (end 0) meet within 0.")


def test_edges_that_are_farther_apart_than_half_the_tolerance_are_none(report):
    fine = report.settings.model_copy(update={"seam_tolerance": 1e-3})
    assert list(seams_left_out(replace_settings(without(report, 0), fine))) == []


def replace_settings(report, settings):
    return report.model_copy(update={"settings": settings})


def test_panels_that_meet_nobody_have_none_left_out(report):
    alone = report.model_copy(update={"panels": report.panels[:1], "seams": ()})
    assert list(seams_left_out(alone)) == []
