"""Linear algebra on one thread: matrices here are many and small, and threads that wait for each other spin.

A band matrix of 64 panels takes one thread a millisecond; two on a busy machine took 200. Besides, sums come out the
same to the last bit on machines of one core and of many.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, wraps
from typing import ParamSpec, TypeVar

from threadpoolctl import ThreadpoolController

Arguments = ParamSpec("Arguments")
Given = TypeVar("Given")


def on_one_thread(function: Callable[Arguments, Given]) -> Callable[Arguments, Given]:
    """The same function, during which NumPy's and SciPy's linear algebra starts no threads of its own."""

    @wraps(function)
    def alone(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Given:
        with _libraries().limit(limits=1, user_api="blas"):
            return function(*args, **kwargs)

    return alone


@cache
def _libraries() -> ThreadpoolController:
    """The libraries of linear algebra that are loaded when the first system is to be solved: all that there will be."""
    return ThreadpoolController()
