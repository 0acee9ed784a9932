"""The turns of planes along a strip, of made-up bending: the least squares within what is allowed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.brep.skin.conjugate import STRAIGHT, SeamBending
from cadpanel.brep.skin.seam_turns import EVEN, SHORTER, SQUARE, STATIONS, seam_turns

seeds = st.integers(0, 2**32 - 1)
LENGTH, WIDTH = 12_000.0, 1500.0
STATION = np.linspace(0.0, 1.0, STATIONS)


def made_up(seed, size=3e-5, points=2000):
    """Bending that changes smoothly along a strip, otherwise on its two halves."""
    random = np.random.default_rng(seed)
    places, sides = random.uniform(0.0, 1.0, points), np.sign(random.uniform(-1.0, 1.0, points))
    waves = random.uniform(-1.0, 1.0, (2, 3, 3))
    phases = np.stack([np.ones(points), np.sin(3.0 * places), np.cos(3.0 * places)])
    each = np.einsum("ski,ip->skp", waves, phases)
    conjugate = size * np.where(sides > 0.0, each[0], each[1]).T
    weights = random.uniform(0.5, 1.0, points)
    return SeamBending(
        places=places, sides=sides, conjugate=conjugate, leans=np.zeros(points), weights=weights / weights.sum()
    )


def objective(bending, turns):
    """What the turns are to make small, written out."""
    e = bending.conjugate
    a, b = (np.interp(bending.places, STATION, turn) for turn in turns.T)
    mean = bending.weights @ np.sum(e * e, axis=1)
    rest = bending.weights @ (e[:, 0] + a * e[:, 1] + b * e[:, 2]) ** 2
    size = np.sum(turns**2) / (STATIONS - 1)
    slope = np.sum(np.diff(turns, axis=0) ** 2) * (STATIONS - 1) * (WIDTH / LENGTH) ** 2
    return rest + (SQUARE * mean + STRAIGHT**2) * size + EVEN * mean * slope


@settings(max_examples=15)
@given(seed=seeds, most=st.floats(1.0, 40.0))
def test_no_turn_is_too_large_or_too_sudden_and_none_makes_it_worse(seed, most):
    bending = made_up(seed)
    turns = seam_turns(bending, LENGTH, WIDTH, np.radians(most)).turns
    sizes = np.linalg.norm(turns, axis=1)
    assert sizes.max() <= np.tan(np.radians(most)) * (1.0 + 1e-12)
    assert sizes[[0, -1]].max() == 0.0
    steps = np.linalg.norm(np.diff(turns, axis=0), axis=1) * (STATIONS - 1) / LENGTH
    assert 0.5 * WIDTH * steps.max() <= SHORTER * (1.0 + 0.02)
    assert objective(bending, turns) <= objective(bending, np.zeros_like(turns)) * (1.0 + 1e-12)


@settings(max_examples=15)
@given(seed=seeds, shake=seeds)
def test_no_other_turns_within_what_is_allowed_are_better(seed, shake):
    bending, most = made_up(seed), np.radians(15.0)
    turns = seam_turns(bending, LENGTH, WIDTH, most).turns
    random = np.random.default_rng(shake)
    wave = random.uniform(-0.05, 0.05, (2, 4)) @ np.sin(np.outer(np.arange(1, 5), np.pi * STATION))
    for share in (0.1, 0.5, 1.0):
        others = [turns + share * wave.T, (1.0 - share) * turns]
        for other in others:
            radii = np.minimum(np.tan(most), 2.0 * SHORTER * LENGTH / WIDTH * np.minimum(STATION, 1.0 - STATION))
            steps = np.linalg.norm(np.diff(other, axis=0), axis=1) * (STATIONS - 1) / LENGTH
            if (np.linalg.norm(other, axis=1) <= radii).all() and 0.5 * WIDTH * steps.max() <= SHORTER:
                assert objective(bending, turns) <= objective(bending, other) * (1.0 + 1e-3)


@given(seed=seeds)
@settings(max_examples=10)
def test_a_strip_walked_from_its_other_end_has_its_turns_the_other_way_round(seed):
    bending = made_up(seed)
    back = SeamBending(
        places=1.0 - bending.places,
        sides=bending.sides,
        conjugate=bending.conjugate * np.array([-1.0, 1.0, 1.0]),
        leans=bending.leans,
        weights=bending.weights,
    )
    there, other = (seam_turns(one, LENGTH, WIDTH, np.radians(15.0)).turns for one in (bending, back))
    np.testing.assert_allclose(other[::-1], -there, atol=1e-9)


def test_bending_that_leaves_no_step_turns_no_plane():
    turns = seam_turns(made_up(3, size=1e-9), LENGTH, WIDTH, np.radians(15.0)).turns
    assert np.abs(turns).max() < 1e-3


def test_planes_are_between_their_stations_what_these_are():
    turns = seam_turns(made_up(5), LENGTH, WIDTH, np.radians(15.0))
    frames = np.broadcast_to(np.eye(3), (STATIONS, 3, 3))
    normals = turns.normals(STATION, frames)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    np.testing.assert_allclose(normals[:, 1:] / normals[:, :1], turns.turns, atol=1e-12)
    between = turns.normals(np.array([0.5 * (STATION[7] + STATION[8])]), np.eye(3)[None])[0]
    assert between[1:] / between[0] == pytest.approx(0.5 * (turns.turns[7] + turns.turns[8]))
