"""Fixing holes keep away from edges, bends and each other, and stand as close as asked, on every feature."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.special import ellipe, ellipk

from cadpanel.geometry.fixings import TOO_NEAR, FixingRule, clearance, fixings, hole_bending
from cadpanel.geometry.flat_places import flat_places
from cadpanel.geometry.unroll import unroll
from tests.chains import FEATURES
from tests.flat_panels import panels
from tests.shapes import folded_panel

RULE = FixingRule(diameter=8.0, pitch=220.0, distance=18.0)


@pytest.mark.parametrize("name", sorted(FEATURES))
def test_holes_keep_their_distance_and_their_pitch(name: str) -> None:
    pattern = unroll(panels(name, 3)[0], -1.5)
    found = fixings(pattern, RULE)
    places = np.array([hole.place for hole in found.holes])
    assert clearance(pattern, places).min() >= RULE.distance - TOO_NEAR
    apart = np.linalg.norm(places[:, None] - places, axis=-1) + 1e9 * np.eye(len(places))
    assert apart.min() >= 2.2 * RULE.diameter - TOO_NEAR
    rows = list(dict.fromkeys((hole.edge, hole.patch) for hole in found.holes))
    for edge, patch in rows:
        row = [hole.place for hole in found.holes if (hole.edge, hole.patch) == (edge, patch)]
        if edge not in found.short:
            assert all(np.linalg.norm(one - other) <= RULE.pitch + 1.0 for one, other in pairwise(row))
    # Every edge has holes, or is said not to have room for all.
    assert {edge for edge, _ in rows} | set(found.short) == set(pattern.edges)


def test_a_straight_edge_has_evenly_spaced_holes_from_its_corners_on() -> None:
    pattern = unroll(folded_panel(chain="p", widths=(600.0,), turns=(0.0,), length=1000.0))
    found = fixings(pattern, RULE)
    row = np.array([hole.place for hole in found.holes if hole.edge == "side 1"])
    assert row[:, 0] == pytest.approx(600.0 - RULE.distance)
    assert np.diff(row[:, 1]) == pytest.approx((1000.0 - 2.0 * RULE.from_corner) / 5)
    assert row[[0, -1], 1] == pytest.approx([RULE.from_corner, 1000.0 - RULE.from_corner])
    assert found.short == ()


def test_at_corners_the_holes_of_two_edges_are_as_near_to_each_other_as_holes_may_be() -> None:
    pattern = unroll(folded_panel(chain="p", widths=(600.0,), turns=(0.0,), length=1000.0))
    found = fixings(pattern, FixingRule(diameter=8.0, pitch=220.0, distance=11.0))
    assert found.short == ()
    places = np.array([hole.place for hole in found.holes])
    apart = np.linalg.norm(places[:, None] - places, axis=-1) + 1e9 * np.eye(len(places))
    assert np.sort(apart.min(axis=1))[:8] == pytest.approx(2.2 * 8.0)


@pytest.mark.parametrize(
    ("width", "holes"),
    [(70.0, 0), (71.9, 0), (72.1, 1), (85.0, 1), (92.0, 2), (72.0 + RULE.pitch, 2), (72.2 + RULE.pitch, 3)],
)
def test_a_short_edge_has_one_hole_in_its_middle_or_none_and_says_so(width: float, holes: int) -> None:
    pattern = unroll(folded_panel(chain="p", widths=(width,), turns=(0.0,)))
    found = fixings(pattern, RULE)
    row = [hole.place for hole in found.holes if hole.edge == "end 0"]
    assert len(row) == holes
    assert found.short == (() if holes else ("end 0", "end 1"))
    assert np.mean([place[0] for place in row] or [0.5 * width]) == pytest.approx(0.5 * width)


def test_a_cylinder_has_the_holes_of_the_flat_panel_that_it_was_rolled_from() -> None:
    flat, rolled = (
        fixings(unroll(folded_panel(length=900.0, **numbers)), RULE)
        for numbers in (
            {"chain": "p", "widths": (600.0,), "turns": (0.0,)},
            {"chain": "c", "widths": (), "turns": (), "radius": 300.0, "sweep": 2.0},
        )
    )
    assert rolled.short == flat.short == ()
    assert [hole.edge for hole in rolled.holes] == [hole.edge for hole in flat.holes]
    places = np.array([[hole.place for hole in found.holes] for found in (flat, rolled)])
    assert places[1] == pytest.approx(places[0], abs=1e-9)


@pytest.mark.parametrize(("narrower", "rows"), [(0.9, 1), (1.1, 0)])
def test_a_hole_comes_no_nearer_to_another_edge_than_curves_are_measured_to(narrower: float, rows: int) -> None:
    width = 2.0 * RULE.distance - narrower * TOO_NEAR
    pattern = unroll(folded_panel(chain="p", widths=(width,), turns=(0.0,)))
    assert len({hole.edge for hole in fixings(pattern, RULE).holes}) == rows


def test_where_a_strip_is_too_narrow_for_two_rows_the_second_one_is_left_out() -> None:
    pattern = unroll(folded_panel(chain="p", widths=(40.0,), turns=(0.0,)))
    found = fixings(pattern, RULE)
    assert {hole.edge for hole in found.holes} == {"side 1"}
    assert set(found.short) == {"end 0", "end 1", "side 0"}


def test_what_a_hole_takes_of_a_parallel_surface_is_its_bending_times_the_height() -> None:
    for half_angle in (0.0, 0.05):
        shape = folded_panel(chain="c", widths=(), turns=(), half_angle=half_angle, radius=250.0)
        (place,) = flat_places(shape, unroll(shape, -1.0), -1.0)
        middle, step = np.array([110.0, 500.0]), 0.25
        grid = np.arange(-10.0, 10.0, step) + 0.5 * step
        cells = np.array(np.meshgrid(grid, grid)).reshape(2, -1).T
        inside = cells[np.linalg.norm(cells, axis=-1) < 10.0] + middle
        summed = float((1.0 / place.normal_radii(inside)).sum()) * step**2
        assert hole_bending(place, middle, 20.0) == pytest.approx(summed, rel=3e-3)
        flat = folded_panel(chain="p", widths=(200.0,), turns=(0.0,))
        assert hole_bending(flat_places(flat, unroll(flat), 0.0)[0], middle, 20.0) == 0.0


def test_the_bending_of_a_hole_in_a_cone_is_that_of_a_disc_about_its_apex() -> None:
    """Over a circle the mean of 1 / r is 2 K / (pi d), d how far its middle is from the apex, K an elliptic integral.

    Added up over radii up to a, with k = a / d, that is 4 d (E(k) - (1 - k^2) K(k)) for the whole disc.
    """
    half_angle, diameter = 0.5, 260.0
    shape = folded_panel(chain="c", widths=(), turns=(), half_angle=half_angle, radius=300.0)
    pattern = unroll(shape)
    (place,) = flat_places(shape, pattern, 0.0)
    apex = place.origin - 300.0 / math.tan(half_angle) * place.along
    for middle in apex + np.array([[40.0, 250.0], [-200.0, 700.0]]):
        away = float(np.linalg.norm(middle - apex))
        square = (0.5 * diameter / away) ** 2
        whole = 4.0 * away * (ellipe(square) - (1.0 - square) * ellipk(square))
        assert hole_bending(place, middle, diameter) == pytest.approx(whole / math.tan(half_angle), rel=1e-7)
