"""Sums and largest values by connected component: what the solvers know of each one, whatever stands beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.blocks import BlockPattern

Value = TypeVar("Value", bound=np.generic)


@dataclass(frozen=True, slots=True)
class Components:
    """Connected components and who belongs to them.

    Attributes:
        count: number of components.
        label: (n,) the component that each of some blocks, or groups of vectors, belongs to.
    """

    count: int
    label: IntArray

    @staticmethod
    def of(pattern: BlockPattern) -> Components:
        """Of a pattern's blocks."""
        return Components(pattern.components, pattern.component)

    def seen_by(self, blocks: IntArray) -> Components:
        """The same, of things that see these blocks (n,)."""
        return Components(self.count, self.label[blocks])

    def total(self, values: Array) -> Array:
        """(count,) sums of values (n,)."""
        return np.bincount(self.label, values, minlength=self.count).astype(np.float64, copy=False)

    def mean(self, values: Array) -> Array:
        """(count,) means of values (n,)."""
        return np.asarray(self.total(values) / np.bincount(self.label, minlength=self.count))

    def largest(self, values: Array, least: float = 0.0) -> Array:
        """(count,) the largest of values (n, ...), at least `least`; no number where one of them is none."""
        found = np.full(self.count, least)
        if values.size:
            with np.errstate(invalid="ignore"):
                np.maximum.at(found, self.label, values.reshape(len(values), -1).max(axis=1))
        return found

    def smallest(self, values: Array, most: float = np.inf) -> Array:
        """(count,) the smallest of values (n, ...), at most `most`."""
        return -self.largest(-values, -most)

    def each(self, values: NDArray[Value]) -> NDArray[Value]:
        """(n, 1) those of values (count,) that count for each."""
        return values[self.label][:, None]
