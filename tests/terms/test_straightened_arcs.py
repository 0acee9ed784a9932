"""Arc points are held by their distance from where the other panel's cone and cut plane meet, however these lean."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.terms.arc_gap import ArcGap
from tests.chains import FEATURES, made_problem, mixed_unknowns

STEP = 1e-5


@pytest.mark.parametrize("seed", range(3))
def test_straightened_vectors_are_as_long_as_the_way_to_where_cone_and_cut_meet(seed):
    """The shortest way that changes both distances by what they are: by their slopes, told by moving one panel."""
    problem = made_problem(FEATURES["plane-cone-plane"], seed, panels=2)
    state = problem.state(mixed_unknowns(problem.layout, seed))
    (arcs,) = problem.curve_gaps(1.0)
    assert isinstance(arcs, ArcGap)
    place, distances, slopes = problem.place, arcs.vectors(state), []
    for axis in np.eye(3):
        moved = []
        for side in (STEP, -STEP):
            shift = np.outer([1.0, 0.0], side * place.length * axis)
            there = replace(place, origins=place.origins + shift)
            moved.append(ArcGap(arcs.seams, there, problem.layout, tolerance=1.0).vectors(state))
        slopes.append((moved[0] - moved[1]) / (2.0 * STEP))
    arcs.straighten(state)
    # (seams, points, 2, 3): the cone's normal and the cut plane's.
    rates = np.stack(slopes, axis=-1)
    rates /= np.linalg.norm(rates, axis=-1, keepdims=True)
    # The shortest step s with rates s = distances: s^2 = d (rates rates^T)^-1 d.
    gram = rates @ np.swapaxes(rates, -1, -2)
    wanted = np.einsum("gqa,gqa->gq", distances, np.linalg.solve(gram, distances[..., None])[..., 0])
    assert np.abs(gram[..., 0, 1]).max() > 0.03
    np.testing.assert_allclose(np.sum(arcs.vectors(state) ** 2, axis=-1), wanted, rtol=1e-6)
