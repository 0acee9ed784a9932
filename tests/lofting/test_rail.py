"""A rail is followed by the share of its length, with exact derivatives, whatever its parameter was."""

import numpy as np
import pytest

from cadpanel.errors import LoftError
from cadpanel.lofting.rail import Rail, Stretch, chained, rail_of, stretch_through

# A quarter of a circle of radius 100 as a rational parabola: weights 1, 1 / sqrt 2, 1.
WEIGHT = np.sqrt(0.5)
QUARTER = Stretch(
    2,
    np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
    np.array([[100.0, 0.0, 0.0, 1.0], [100.0 * WEIGHT, 100.0 * WEIGHT, 0.0, WEIGHT], [0.0, 100.0, 0.0, 1.0]]),
)
LINE = stretch_through(np.array([[0.0, 100.0, 0.0], [-50.0, 100.0, 0.0]]))
STEM = stretch_through(np.array([[100.0, -40.0, 30.0], [100.0, 0.0, 0.0]]))


def test_a_rational_arc_is_followed_by_its_length():
    share = np.linspace(0.0, 1.0, 11)
    rail = Rail("arc", (QUARTER,))
    jet, angle = rail.at(share), 0.5 * np.pi * share
    out = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1)
    assert rail.length == pytest.approx(50.0 * np.pi, rel=1e-12)
    assert np.abs(jet.point - 100.0 * out).max() < 1e-9
    assert np.linalg.norm(jet.first, axis=1) == pytest.approx(rail.length, rel=1e-9)
    assert np.abs(jet.second + 100.0 * (0.5 * np.pi) ** 2 * out).max() < 1e-6


def test_stretches_follow_each_other_in_any_order_and_only_corners_are_corners():
    rail = chained("all", [LINE.reversed(), QUARTER, STEM])
    assert rail.corners() in ([1], [2])
    assert len(rail.cut(rail.corners())) == 2
    assert rail.length == pytest.approx(50.0 * np.pi + 50.0 + 50.0, rel=1e-12)
    way = rail.at(np.array([0.0, 1.0])).point
    back = rail.reversed().at(np.array([1.0, 0.0])).point
    assert np.abs(way - back).max() < 1e-9
    with pytest.raises(LoftError, match="do not follow each other"):
        chained("apart", [STEM, LINE])


@pytest.mark.parametrize("given", [np.zeros((3, 2)), np.zeros((4, 3)), "no rail", np.full((3, 3), np.nan)])
def test_what_is_no_curve_is_refused(given):
    with pytest.raises(LoftError):
        rail_of(given, "A")
