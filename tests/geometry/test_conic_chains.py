"""Laws of chains of conic arcs: they are the curves they are made from, and their derivatives are exact."""

import numpy as np
import pytest

from cadpanel.geometry.conic_chains import ConicChains, followed, followed_twice, joined
from cadpanel.geometry.end_curves import as_chains
from tests.seams import KINDS

SEAMS = 20
STEP = 1e-4


def pieces(kind):
    """Curves of a kind, their chains, and a place on every piece of each."""
    curves, _ = KINDS[kind](np.random.default_rng(4), SEAMS)
    chains = as_chains(curves, curves.corners[:, 0])
    columns = np.arange(SEAMS * curves.patches)
    return curves, chains, columns, np.random.default_rng(5).uniform(0.05, 0.95, len(columns))


def numbered(pieces, count, first):
    """Chains whose columns are told by a number each."""
    columns = first + np.arange(float(pieces * count))
    return ConicChains(pieces=pieces, curves=np.tile(columns, (17, 1)), normals=np.tile(-columns, (9, 1)))


def test_of_chains_joined_to_longer_ones_the_last_piece_stands_there_again():
    for chains in (joined(numbered(2, 2, 0), numbered(4, 1, 10)), joined(numbered(4, 1, 10), numbered(2, 2, 0))):
        short, long = [0, 1, 1, 1, 2, 3, 3, 3], [10, 11, 12, 13]
        assert chains.pieces == 4
        assert chains.count == 3
        assert chains.curves[0].tolist() in (short + long, long + short)
        assert chains.normals == pytest.approx(-chains.curves[:9])
    assert joined(numbered(2, 1, 0), numbered(2, 1, 5)).curves[16].tolist() == [0, 1, 5, 6]


def test_a_part_of_chains_has_whole_ones():
    chains = numbered(2, 4, 0)
    assert chains.part(slice(1, 3)).curves[0].tolist() == [2, 3, 4, 5]
    assert chains.part(slice(2, None)).normals[8].tolist() == [-4, -5, -6, -7]


@pytest.mark.parametrize("kind", KINDS)
def test_a_chain_runs_where_its_curve_runs(kind):
    curves, chains, columns, w = pieces(kind)
    u = (np.arange(curves.patches) + w.reshape(SEAMS, -1)).reshape(SEAMS, -1)
    points, normals = curves.follow(u)
    scale = max(1.0, np.abs(curves.radius).max() / 1e3)
    found = followed(chains.curves, w).T.reshape(points.shape) + curves.corners[:, :1]
    assert found == pytest.approx(points, abs=1e-9 * scale)
    assert chains.normals_at(columns, w)[0].T.reshape(points.shape) == pytest.approx(normals, abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_are_those_of_the_points_and_normals(kind):
    _, chains, columns, w = pieces(kind)
    point, along, bend = followed_twice(chains.curves, w)
    before, after = (followed(chains.curves, w + side) for side in (-STEP, STEP))
    size = np.abs(along).max()
    assert np.array_equal(point, followed(chains.curves, w)) or np.allclose(
        point, followed(chains.curves, w), atol=1e-9
    )
    assert (after - before) / (2.0 * STEP) == pytest.approx(along, abs=1e-6 * size)
    assert (after - 2.0 * point + before) / STEP**2 == pytest.approx(bend, abs=1e-3 * size)
    turning = chains.normals_at(columns, w)[1]
    normals = [chains.normals_at(columns, w + side)[0] for side in (-STEP, STEP)]
    assert (normals[1] - normals[0]) / (2.0 * STEP) == pytest.approx(turning, abs=1e-6)
