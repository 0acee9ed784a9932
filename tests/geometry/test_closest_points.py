"""Closest points of chains of segments and arcs: none is closer, each is a foot, of equals the first one counts."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.geometry.closest_points import STATIONS, closest_points, distances_near, stations
from cadpanel.geometry.conic_chains import ConicChains, conic_chains, followed, followed_twice, inner, seen_from
from cadpanel.geometry.end_curves import as_chains
from tests.seams import KINDS

pytestmark = pytest.mark.each_value_once

CURVES = 12
# Share of both steps by which ends may be apart where they meet.
JOINED = 1e-6
few = settings(max_examples=20)
seeds = st.integers(0, 2**32 - 1)


def chains_of(kind, seed) -> ConicChains:
    """End curves of panels, seen from their first corners, mm."""
    curves, _ = KINDS[kind](np.random.default_rng(seed), CURVES)
    return as_chains(curves, curves.corners[:, 0])


def segments(corners) -> ConicChains:
    """One chain through corners (k + 1, 3)."""
    corners = np.asarray(corners, dtype=float)[None]
    flat = np.zeros_like(corners[:, :-1])
    return conic_chains(
        constant=corners[:, :-1],
        cosine=flat,
        sine=flat,
        weights=np.broadcast_to([1.0, 0.0, 0.0], flat.shape),
        span=np.diff(corners, axis=1),
        start=flat[..., 0],
        turn=flat[..., 0],
        normals=[flat, flat, flat],
    )


def arcs(random, count, *, turn, flat=1.0) -> ConicChains:
    """Arcs of ellipse about the origin, in the plane of x and y: half axes of 1 and `flat` of it, 100 to 500 mm."""
    size = random.uniform(100.0, 500.0, (count, 1, 1))
    nothing = np.zeros((count, 1, 3))
    return conic_chains(
        constant=nothing,
        cosine=size * np.array([1.0, 0.0, 0.0]),
        sine=flat * size * np.array([0.0, 1.0, 0.0]),
        weights=np.broadcast_to([1.0, 0.0, 0.0], nothing.shape),
        span=nothing,
        start=random.uniform(0.0, 2.0 * np.pi, (count, 1)),
        turn=np.full((count, 1), turn),
        normals=[nothing, nothing, nothing],
    )


def dense(chains, of, points, steps=600):
    """(n,) the least distances of points to many points of their chains."""
    w = np.linspace(0.0, 1.0, steps + 1)
    columns = np.repeat(np.arange(chains.curves.shape[1]), len(w))
    on = followed(chains.curves[:, columns], np.tile(w, chains.curves.shape[1])).reshape(3, chains.count, -1)
    away = on[:, of] - points[:, :, None]
    return np.sqrt(inner(away, away)).min(axis=1)


def assert_closest(chains, of, points):
    column, w, distance = closest_points(stations(chains), of, points)
    assert np.array_equal(column // chains.pieces, of)
    assert w.min() >= 0.0
    assert w.max() <= 1.0
    away = followed(chains.curves[:, column], w) - points
    assert np.sqrt(inner(away, away)) == pytest.approx(distance, rel=1e-9, abs=1e-9)
    assert (distance <= dense(chains, of, points) * (1.0 + 1e-9) + 1e-9).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("spread", [1.0, 100.0, 2000.0])
def test_no_point_of_a_curve_is_closer_than_the_closest_one(kind, spread):
    """Of points near the curve, within its bends, and far away."""
    chains = chains_of(kind, 3)
    random = np.random.default_rng(7)
    of = np.repeat(np.arange(CURVES), 12)
    near = random.integers(0, chains.pieces, len(of)) + of * chains.pieces
    at = followed(chains.curves[:, near], random.uniform(size=len(of)))
    assert_closest(chains, of, at + spread * random.normal(size=at.shape))


@pytest.mark.parametrize(
    ("turn", "flat"), [(1.0, 1.0), (-2.0, 1.0), (5.0, 1.0), (6.28, 1.0), (1.0, 0.5), (-2.0, 0.5), (3.1, 0.5)]
)
def test_no_point_of_an_ellipse_is_closer_than_the_closest_one_wherever_the_point_lies(turn, flat):
    """Within the evolute, where feet run together, too."""
    random = np.random.default_rng(11)
    chains = arcs(random, CURVES, turn=turn, flat=flat)
    of = np.repeat(np.arange(CURVES), 150)
    assert_closest(chains, of, random.uniform(-300.0, 300.0, (3, len(of))) * np.array([[1.0], [1.0], [0.1]]))


@few
@given(seeds, st.sampled_from(sorted(set(KINDS) - {"nearly_flat"})), st.sampled_from([0.0, 1e-3, 1.0]))
def test_what_stands_off_a_curve_has_its_foot_there_to_rounding(seed, kind, off):
    """Wherever between the ends the foot lies; where stations are, too. (Radii of kilometres leave fewer digits.)"""
    chains = chains_of(kind, seed)
    columns = np.arange(CURVES * chains.pieces)
    shares = [*np.arange(1.0, STATIONS) / STATIONS, 0.1, 0.77]
    for share in shares:
        w = np.full(len(columns), share)
        foot, along, _ = followed_twice(chains.curves, w)
        aside = np.cross(along, np.random.default_rng(seed).normal(size=along.shape), axis=0)
        points = foot + off * aside / np.sqrt(inner(aside, aside))
        column, found, distance = closest_points(stations(chains), columns // chains.pieces, points)
        assert np.array_equal(column, columns)
        assert found == pytest.approx(w, abs=1e-10)
        assert distance == pytest.approx(off, abs=1e-9)


@pytest.mark.parametrize("beyond", [0.0, 1e-3, 500.0])
def test_beyond_an_end_the_end_is_closest(beyond):
    chains = segments([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [100.0, 50.0, 0.0]])
    points = np.array([[-beyond, 3.0, 0.0], [100.0, 50.0 + beyond, 4.0]]).T
    points[1, 0] = 0.0
    column, w, distance = closest_points(stations(chains), np.zeros(2, dtype=np.intp), points)
    assert column.tolist() == [0, 1]
    assert w.tolist() == [0.0, 1.0]
    assert distance == pytest.approx([beyond, np.hypot(beyond, 4.0)], abs=1e-12)


def test_of_two_pieces_that_are_equally_close_the_first_one_counts():
    chains = segments([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [100.0, 40.0, 0.0], [0.0, 40.0, 0.0]])
    points = np.array([[50.0, 20.0, 0.0], [10.0, 20.0, 5.0], [30.0, 21.0, 0.0]]).T
    column, w, _ = closest_points(stations(chains), np.zeros(3, dtype=np.intp), points)
    assert column.tolist() == [0, 0, 2]
    assert w == pytest.approx([0.5, 0.1, 0.7], abs=1e-12)


def test_no_points_have_no_closest_points():
    found = closest_points(stations(segments(np.eye(3))), np.zeros(0, dtype=np.intp), np.zeros((3, 0)))
    assert [len(of) for of in found] == [0, 0, 0]


@pytest.mark.parametrize("kind", KINDS)
def test_what_lies_between_two_stations_is_within_the_reach_of_either(kind):
    chains = chains_of(kind, 5)
    on = stations(chains)
    columns = np.arange(CURVES * chains.pieces)
    points, reach = on.points.reshape(3, len(columns), -1), on.reach.reshape(len(columns), -1)
    for station in range(STATIONS):
        for share in (0.1, 0.5, 0.9):
            between = followed(chains.curves, np.full(len(columns), (station + share) / STATIONS))
            for end in (station, station + 1):
                away = between - points[:, :, end]
                assert (np.sqrt(inner(away, away)) <= reach[:, end]).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("share", "joined"), [(0.0, True), (0.9, True), (1.1, False), (1e7, False)])
def test_pieces_join_where_one_begins_within_rounding_of_the_end_of_the_one_before(kind, share, joined):
    """A share of the steps on both sides of it; the first piece of a chain joins none, nor does anything behind all."""
    chains = chains_of(kind, 6)
    reach = stations(chains).reach
    wanted = np.full((CURVES, chains.pieces), joined)
    wanted[:, 0] = False
    away = np.array([[0.0], [0.0], [JOINED]])
    for piece in range(1, chains.pieces):
        columns = np.arange(CURVES) * chains.pieces + piece
        steps = reach[:, piece, 0] + reach[:, piece - 1, -1]
        # All that follows moves along with it.
        for column in range(piece, chains.pieces):
            own = columns - piece + column
            chains.curves[:, own] = seen_from(chains.curves[:, own], -share * steps * away)
    assert stations(chains).joins.tolist() == [*wanted.ravel(), False]


@pytest.mark.parametrize(("share", "joins"), [(0.9, True), (1.1, False)])
def test_where_pieces_join_the_steps_next_to_that_place_count(share, joins):
    """A quarter of a flat ellipse, whose last step is more than twice as long as its first, and a segment after it."""
    zero, x, y = np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])

    def gapped(gap):
        return conic_chains(
            constant=np.array([[zero, 10.0 * y + np.array([0.0, 0.0, gap])]]),
            cosine=np.array([[100.0 * x, zero]]),
            sine=np.array([[10.0 * y, zero]]),
            weights=np.array([[x, x]]),
            span=np.array([[zero, -6.0 * x]]),
            start=np.zeros((1, 2)),
            turn=np.array([[0.5 * np.pi, 0.0]]),
            normals=[np.zeros((1, 2, 3))] * 3,
        )

    reach = stations(gapped(0.0)).reach[0]
    assert reach[0, -1] > 2.0 * reach[0, 1]
    assert stations(gapped(share * JOINED * (reach[0, -1] + reach[1, 0]))).joins.tolist() == [False, joins, False]


@pytest.mark.parametrize("inside", [0.0, 40.0, 70.0, -200.0])
@pytest.mark.parametrize("off", [1e-3, -1e-3])
def test_one_step_from_nearby_leads_to_the_closest_point_of_a_bent_curve(inside, off):
    """The error of a place goes with its square, and that of a distance with the square of this."""
    chains = arcs(np.random.default_rng(3), 1, turn=1.0)
    foot, w = followed(chains.curves, np.array([0.5])), np.array([0.5 + off])
    radius = np.sqrt(inner(foot, foot))
    points = foot * (1.0 - inside / 100.0)
    found = distances_near(chains, np.zeros(1, dtype=np.intp), w, points)
    assert found == pytest.approx(abs(inside) / 100.0 * radius, abs=1e-8 * radius[0])


def test_a_chain_without_length_is_a_point_and_its_pieces_join():
    point = stations(segments(np.tile([3.0, 4.0, 0.0], (4, 1))))
    assert point.joins.tolist() == [False, True, True, False]
    column, _, distance = closest_points(
        point, np.zeros(2, dtype=np.intp), np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0]]).T
    )
    assert column.tolist() == [0, 0]
    assert distance.tolist() == [5.0, 0.0]
