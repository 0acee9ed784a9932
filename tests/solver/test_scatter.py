"""Adding up groups by blocks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.solver.scatter import Scatter


@given(index=st.lists(st.integers(0, 4), max_size=12), seed=st.integers(0, 100))
def test_it_adds_every_group_to_its_block_however_often_a_block_stands(index, seed):
    values = np.random.default_rng(seed).normal(size=(len(index), 2, 3))
    found, expected = np.ones((5, 2, 3)), np.ones((5, 2, 3))
    for block, value in zip(index, values, strict=True):
        expected[block] += value
    Scatter(np.array(index, dtype=np.intp), len(found)).add(found, values)
    assert found == pytest.approx(expected, abs=1e-12)
