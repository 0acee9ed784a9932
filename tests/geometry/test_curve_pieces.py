"""How far segments and arcs reach is what many of their points show."""

import numpy as np
import pytest

from cadpanel.geometry.curve_pieces import CurvePieces, segments, together

CLOSE = 1e-4  # parts of the size, between two of the points


def arcs(seed: int, count: int = 40) -> CurvePieces:
    rng = np.random.default_rng(seed)
    frames = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    starts = rng.uniform(0.0, 2.0 * np.pi, count)
    return CurvePieces(
        centers=rng.normal(size=(count, 3)),
        cosine_axes=rng.uniform(1.0, 3.0, (count, 1)) * frames[:, 0],
        sine_axes=rng.uniform(0.1, 1.0, (count, 1)) * frames[:, 1],
        starts=starts,
        stops=starts + rng.uniform(0.1, 6.0, count),
        arcs=np.ones(count, dtype=bool),
    )


def along(pieces: CurvePieces, shares: np.ndarray) -> np.ndarray:
    w = pieces.starts[:, None] + shares * (pieces.stops - pieces.starts)[:, None]
    return (
        pieces.centers[:, None]
        + np.cos(w)[..., None] * pieces.cosine_axes[:, None]
        + np.sin(w)[..., None] * pieces.sine_axes[:, None]
    )


@pytest.mark.parametrize("seed", range(4))
def test_an_arc_reaches_as_far_as_the_farthest_of_its_points(seed):
    pieces = arcs(seed)
    directions = np.random.default_rng(seed).normal(size=(6, 3))
    values = np.einsum("dx,nqx->dnq", directions, along(pieces, np.linspace(0.0, 1.0, 2001)))
    least, greatest = pieces.reach(directions)
    assert (least <= values.min(axis=-1) + 1e-12).all()
    assert (greatest >= values.max(axis=-1) - 1e-12).all()
    assert least == pytest.approx(values.min(axis=-1), abs=CLOSE)
    assert greatest == pytest.approx(values.max(axis=-1), abs=CLOSE)


def test_a_segment_reaches_to_its_ends():
    ends = np.random.default_rng(5).normal(size=(2, 7, 3))
    least, greatest = segments(*ends).reach(np.eye(3))
    assert least == pytest.approx(ends.min(axis=0).T)
    assert greatest == pytest.approx(ends.max(axis=0).T)


def test_pieces_together_are_the_same_pieces():
    some = arcs(1, 3), segments(np.zeros((2, 3)), np.ones((2, 3)))
    both = together(some)
    assert len(both) == 5
    assert both.take(np.arange(3)).centers == pytest.approx(some[0].centers)
    assert both.arcs.tolist() == [True] * 3 + [False] * 2
