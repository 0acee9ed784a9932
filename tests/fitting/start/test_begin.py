"""What every start keeps to, whatever the feature."""

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from cadpanel.features.catalogue import feature
from cadpanel.fitting.problem import pose
from cadpanel.fitting.start import cone_strips
from tests.instances import random_shapes
from tests.known_panels import alone


def test_strips_are_solved_on_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Threads that wait for each other cost more than they do, and let sums end otherwise from machine to machine."""
    seen: set[int] = set()
    solve = cone_strips.cones_of

    def watched(*given):
        seen.update(library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas")
        return solve(*given)

    monkeypatch.setattr(cone_strips, "cones_of", watched)
    of = feature("plane-cone-cone-plane")
    with threadpool_limits(2, user_api="blas"):
        _, starts = pose(alone(*random_shapes(of, 3, 2)), [of] * 2)
    assert seen == {1}
    assert all(np.isfinite(start).all() for start in starts)
