"""Adding up what many groups say of few blocks."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from cadpanel.arrays import Array, IntArray

if TYPE_CHECKING:
    from scipy.sparse import csr_array


class Scatter:
    """Which blocks groups add to, for those that add to them again and again."""

    def __init__(self, index: IntArray, count: int) -> None:
        """`index` (groups,) says to which of so many blocks each group adds."""
        self._index, self._count = index, count

    @cached_property
    def _once(self) -> bool:
        return bool(np.all(self._index[1:] > self._index[:-1]))

    @cached_property
    def _to_all(self) -> bool:
        return self._once and len(self._index) == self._count

    @cached_property
    def _gather(self) -> csr_array:
        # Here, not above: terms use this, settings ask limits for their ranges, and neither help nor a refusal should
        # wait for SciPy.
        from scipy.sparse import csr_array

        groups = len(self._index)
        return csr_array((np.ones(groups), (self._index, np.arange(groups))), shape=(self._count, groups))

    def add(self, target: Array, values: Array) -> None:
        """target[index] += values (groups, ...), adding up where an index repeats."""
        if self._to_all:
            target += values
            return
        if self._once:
            target[self._index] += values
            return
        summed: Array = np.asarray(self._gather @ values.reshape(len(self._index), -1))
        target += summed.reshape(target.shape)
