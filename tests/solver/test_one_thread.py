"""While something is solved linear algebra keeps to one thread, and afterwards has as many as before."""

import numpy as np
from threadpoolctl import threadpool_info, threadpool_limits

from cadpanel.arrays import Array
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from cadpanel.solver.one_thread import on_one_thread
from tests.solver.models import Separate, pattern


def threads() -> set[int]:
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


def test_it_has_one_thread_meanwhile_and_as_many_as_before_after_it() -> None:
    assert np.linalg.inv(np.eye(2)).any()
    with threadpool_limits(2, user_api="blas"):
        before = threads()
        assert on_one_thread(threads)() == {1}
        assert threads() == before


def test_it_has_as_many_as_before_after_an_error_too() -> None:
    @on_one_thread
    def fails() -> None:
        assert threads() == {1}
        raise KeyboardInterrupt

    with threadpool_limits(2, user_api="blas"):
        before = threads()
        try:
            fails()
        except KeyboardInterrupt:
            assert threads() == before


def test_the_solvers_keep_to_it() -> None:
    seen: set[int] = set()

    def residual(unknowns: Array) -> Array:
        seen.update(threads())
        return unknowns - 3.0

    start = np.zeros((1, 2))
    with threadpool_limits(2, user_api="blas"):
        levenberg_marquardt(Separate(residual, lambda _: np.eye(2), pattern(1, 2, []), np.ones(1)), start, Stopping())
    assert seen == {1}
