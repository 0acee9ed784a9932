"""The patch under a point, and the ruling at which half of the turning is done."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.features.catalogue import feature
from cadpanel.features.distance import assign, middle, patch_distance_inner, round_numbers
from cadpanel.geometry.patch_under import half_way

UNEVEN = [(0.01, 1.6), (1.6, 0.01), (0.8, 0.8), (0.3, 2.5), (2.5, 0.3), (-1.6, -0.01)]


def fold(first, second, *, name="plane-cone-cone-plane"):
    """A fold of two cones that turn by so much, between flanges as wide as a panel is long."""
    of = feature(name)
    values = np.zeros((1, len(of.numbers)))
    sweeps = iter((first, second))
    for i, curved in enumerate(of.curved):
        values[0, of.patch_slice(i)] = (-0.25 if first < 0.0 else 0.25, 0.0, next(sweeps)) if curved else (1.0, 0.0)
    values[0, of.cut_numbers[:, 0]] = -0.5, 0.5
    return of.walk(values, derivatives=False)


def on_flanges(walked):
    """(2, 9, 3) points on the first and the last patch, from ruling to ruling."""
    share = np.linspace(0.02, 0.98, 9)[:, None]
    p = walked.edges.p[0]
    return np.stack([p[i] + share * (p[i + 1] - p[i]) for i in (0, len(p) - 2)])


@pytest.mark.parametrize(("first", "second"), UNEVEN)
def test_points_of_far_flanges_belong_to_them_however_unevenly_two_cones_share_the_fold(first, second):
    walked = fold(first, second)
    points = on_flanges(walked)
    for patch, own in zip((0, 3), points, strict=True):
        x = np.ascontiguousarray(own.T[:, None])
        assert (assign(walked, x) == patch).all()
        assert np.abs(patch_distance_inner(walked, x, patch)[0]).max() < 1e-12


def test_a_point_on_a_far_flange_changes_sides_where_the_walk_begins_in_the_first_of_two_cones():
    """What the ruling halfway is for: from that in the middle of the anchor patch the flange lies behind."""
    walked = fold(0.01, 2.5)
    flange = on_flanges(walked)[1]
    anchor = walked.anchor
    assert ((flange - anchor.p[0, 0]) @ anchor.b[0, 0]).min() < 0.0
    begin = middle(walked)
    assert ((flange - begin.p[0]) @ begin.b[0]).min() > 0.0


@pytest.mark.parametrize(("first", "second"), UNEVEN)
def test_half_of_the_turning_is_done_at_the_ruling_halfway(first, second):
    walked = fold(first, second)
    begin = middle(walked)
    tangents = walked.edges.b[0, [0, -1]]
    both = tangents @ begin.b[0]
    assert both == pytest.approx(np.cos(0.5 * abs(first + second)), abs=1e-12)
    assert begin.patch[0] == (1 if abs(first) >= abs(second) else 2)


def test_where_one_patch_turns_alone_it_is_the_middle_of_that_patch():
    of = feature("plane-cone-plane")
    values = np.zeros((1, len(of.numbers)))
    values[0, of.patch_slice(0)] = values[0, of.patch_slice(2)] = 1.0, 0.05
    values[0, of.patch_slice(1)] = 0.2, 0.1, 1.1
    walked = of.walk(values, derivatives=False)
    edges, own = walked.edges, middle(walked)
    found = half_way((edges.p, edges.t, edges.n), round_numbers(walked))
    assert found.patch == own.patch == 1
    assert found.p == pytest.approx(own.p, abs=1e-15)
    assert found.b == pytest.approx(own.b, abs=1e-15)


def test_turning_one_way_and_back_counts_both_ways():
    walked = fold(0.9, 0.7, name="plane-cone-plane-cone-plane")
    values = walked.values.copy()
    values[0, walked.feature.patch_slice(3)] = -0.1, 0.0, -0.7
    found = middle(walked.feature.walk(values, derivatives=False))
    assert found.patch[0] == 1
    assert found.b[0] @ walked.edges.b[0, 0] == pytest.approx(np.cos(0.8), abs=1e-12)


def test_chains_of_which_nothing_turns_have_a_ruling_halfway_too():
    walked = fold(0.0, 0.0)
    begin = middle(walked)
    assert np.isfinite(begin.p).all()
    assert begin.b[0] == pytest.approx(walked.edges.b[0, 1], abs=1e-15)


@pytest.mark.parametrize(("sweeps", "patch"), [((1.0, 0.4, 0.2), 0), ((0.4, 1.0, 0.2), 1), ((0.2, 0.4, 1.0), 2)])
def test_half_of_the_turning_is_done_in_the_right_one_of_three_cones_that_begin_at_the_side(sweeps, patch):
    of = feature("tri-cone")
    values = np.zeros((1, len(of.numbers)))
    for i, sweep in enumerate(sweeps):
        values[0, of.patch_slice(i)] = 0.1, 0.0, sweep
    values[0, of.cut_numbers[:, 0]] = -0.5, 0.5
    walked = of.walk(values, derivatives=False)
    begin = middle(walked)
    assert begin.patch[0] == patch
    assert walked.edges.b[0, [0, -1]] @ begin.b[0] == pytest.approx(np.cos(0.5 * sum(sweeps)), abs=1e-12)


def test_panels_together_have_the_patches_that_each_of_them_has():
    """Also where they have turned half of their way in different patches."""
    alone = [fold(first, second) for first, second in ((1.6, 0.01), (0.01, 1.6), (0.8, 0.8))]
    together = alone[0].feature.walk(np.concatenate([one.values for one in alone]), derivatives=False)
    assert len(set(middle(together).patch.tolist())) > 1
    x = np.random.default_rng(1).uniform(-1.5, 1.5, (3, len(alone), 200))
    found = assign(together, x)
    for i, one in enumerate(alone):
        assert found[i].tolist() == assign(one, np.ascontiguousarray(x[:, i : i + 1]))[0].tolist()
        assert len(set(found[i].tolist())) > 2
