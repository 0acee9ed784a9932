"""Seams in batches that are alike, and which corners meet there."""

import numpy as np
import pytest

from cadpanel.terms.seams import ends_of
from tests.terms.models import case_of, mixed_case

CASES = {"mixed": lambda: mixed_case(0), "lopsided": lambda: case_of("plane-cone", 1)}


@pytest.mark.parametrize("name", CASES)
def test_corners_meet_from_end_to_end_and_all_of_them_where_edges_have_the_same_pieces(name):
    problem = CASES[name]().problem
    features = problem.layout.feature_of
    for batch in problem.seams:
        for row, (panels, numbers) in enumerate(zip(batch.panels, batch.edges, strict=True)):
            first, second = (features[p].edges[e] for p, e in zip(panels, numbers, strict=True))
            way = -1 if batch.reversed[row] else 1
            assert batch.alike == (first.curved == second.curved[::way])
            met = [list(first.corners), list(second.corners[::way])]
            assert batch.corners[row].tolist() == (met if batch.alike else [[one[0], one[-1]] for one in met])


@pytest.mark.parametrize("name", CASES)
def test_in_one_batch_the_outermost_corners_meet(name):
    seams = CASES[name]().problem.seams
    (whole,) = ends_of(seams)
    assert not whole.alike
    assert whole.index.tolist() == [seam for batch in seams for seam in batch.index.tolist()]
    outermost = [[[one[0], one[-1]] for one in seam] for batch in seams for seam in batch.corners.tolist()]
    assert whole.corners.tolist() == outermost
    assert np.array_equal(whole.reversed, np.concatenate([batch.reversed for batch in seams]))
    assert ends_of(()) == ()
