"""Symmetric block matrices of a Gauss-Newton model, and their direct factorization.

Unknowns come in `count` blocks of `size`; a pair of blocks is coupled where some residual sees both. Strips couple
neighbours only, rings and grids a little more. Blocks are reordered by reverse Cuthill-McKee and the matrix is
factorized as a band (LAPACK pbtrf), which is linear in the length of a strip. Where that band would be wide, as of
large grids, it is factorized by nested dissection instead.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from scipy.linalg.lapack import dpbtrf, dpbtrs, dpotrf, dpotrs
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.solver.dissection import dissect
from cadpanel.solver.multifrontal import Fronts

# A band that couples blocks so far apart takes longer than a dissection does (both measured on square grids).
_WIDE = 32


@dataclass(slots=True)
class Normal:
    """The Gauss-Newton model of a cost: gradient J^T r and the blocks of J^T J.

    Attributes:
        gradient: (count, size).
        diagonal: (count, size, size).
        coupling: (pairs, size, size), rows belong to the first block of the pair, columns to the second.
    """

    gradient: Array
    diagonal: Array
    coupling: Array

    @staticmethod
    def zero(count: int, size: int, pairs: int) -> Normal:
        """An empty model to add to."""
        return Normal(np.zeros((count, size)), np.zeros((count, size, size)), np.zeros((pairs, size, size)))

    def where(self, chosen: BoolArray, other: Normal) -> Normal:
        """The model of blocks none of which is coupled: of those `chosen` (count,) the other's."""
        gradient = np.where(chosen[:, None], other.gradient, self.gradient)
        diagonal = np.where(chosen[:, None, None], other.diagonal, self.diagonal)
        return Normal(gradient, diagonal, self.coupling)

    def without(self, held: BoolArray, pairs: IntArray) -> Normal:
        """The model of a step that leaves the unknowns `held` (count, size) where they are."""
        free = ~held
        diagonal = self.diagonal * (free[:, :, None] & free[:, None, :])
        i = np.arange(held.shape[1])
        diagonal[:, i, i] += held
        coupling = self.coupling
        if len(pairs):
            coupling = coupling * (free[pairs[:, 0], :, None] & free[pairs[:, 1], None, :])
        return Normal(self.gradient * free, diagonal, coupling)


@dataclass(frozen=True)
class BlockPattern:
    """Which blocks are coupled, and where their entries go in the band.

    Attributes:
        count: number of blocks.
        size: unknowns a block.
        pairs: (pairs, 2) indices of coupled blocks, the lower first; a pair stands once.
        component: (count,) label of the connected component that each block belongs to.
    """

    count: int
    size: int
    pairs: IntArray
    components: int = field(init=False)
    component: IntArray = field(init=False)
    _order: IntArray = field(init=False, repr=False)
    _width: int = field(init=False, repr=False)
    _diagonal_at: IntArray = field(init=False, repr=False)
    _coupling_at: IntArray = field(init=False, repr=False)
    _lower: tuple[IntArray, IntArray] = field(init=False, repr=False)
    _fronts: Fronts | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Order the blocks and prepare the scatter into band storage."""
        set_ = object.__setattr__
        pairs = np.asarray(self.pairs, dtype=np.intp).reshape(-1, 2)
        if len(np.unique(pairs, axis=0)) != len(pairs) or np.any(pairs[:, 0] >= pairs[:, 1]):
            raise ValueError("pairs of blocks must be unique, the lower index first")
        set_(self, "pairs", pairs)
        if not len(pairs):
            self._all_apart()
            return
        graph = csr_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(self.count, self.count))
        graph = (graph + graph.T).tocsr()
        components, labels = connected_components(graph, directed=False)
        set_(self, "components", int(components))
        set_(self, "component", labels.astype(np.intp))
        order = reverse_cuthill_mckee(graph, symmetric_mode=True).astype(np.intp)
        position = np.empty(self.count, dtype=np.intp)
        position[order] = np.arange(self.count)
        set_(self, "_order", order)
        span = int(np.abs(np.diff(position[pairs], axis=1)).max(initial=0))
        wide = span >= _WIDE
        set_(self, "_fronts", Fronts.of(dissect(graph), self.size, pairs, self.count) if wide else None)
        width = (span + 1) * self.size
        set_(self, "_width", width)
        # Lower band storage in Fortran order: entry (row, column) stands at [column * width + row - column].
        rows, columns = np.tril_indices(self.size)
        set_(self, "_lower", (rows, columns))
        first = position * self.size
        set_(self, "_diagonal_at", (first[:, None] + columns) * width + (rows - columns))
        i, j = np.indices((self.size, self.size))
        row, column = first[pairs[:, 0], None, None] + i, first[pairs[:, 1], None, None] + j
        high, low = np.maximum(row, column), np.minimum(row, column)
        set_(self, "_coupling_at", low * width + high - low)

    def _all_apart(self) -> None:
        """Every block is a component, and there is nothing to put in order."""
        set_, none = object.__setattr__, np.zeros(0, dtype=np.intp)
        set_(self, "components", self.count)
        set_(self, "component", np.arange(self.count))
        for name in ("_order", "_diagonal_at", "_coupling_at"):
            set_(self, name, none)
        set_(self, "_lower", (none, none))
        set_(self, "_width", 0)
        set_(self, "_fronts", None)

    def around(self, values: Array) -> Array:
        """(count,) the sum of values (count,) over each block and those coupled to it."""
        total = values.copy()
        np.add.at(total, self.pairs[:, 0], values[self.pairs[:, 1]])
        np.add.at(total, self.pairs[:, 1], values[self.pairs[:, 0]])
        return total

    def multiply(self, normal: Normal, vectors: Array) -> Array:
        """(count, size) the product of J^T J with vectors (count, size)."""
        product: Array = (normal.diagonal @ vectors[..., None])[..., 0]
        if not len(self.pairs):
            return product
        first, second = self.pairs.T
        np.add.at(product, first, (normal.coupling @ vectors[second, :, None])[..., 0])
        np.add.at(product, second, (np.swapaxes(normal.coupling, 1, 2) @ vectors[first, :, None])[..., 0])
        return product

    def solve(self, normal: Normal, damping: Array) -> Array | None:
        """(count, size) the step s of (J^T J + diag(damping)) s = -gradient, or None if it is not positive definite.

        Args:
            normal: the model.
            damping: (count, size) added to the diagonal.
        """
        factors = self.factorize(normal, damping)
        return None if factors is None else factors.solve(-normal.gradient)

    def factorize(self, normal: Normal, damping: Array) -> Factors | None:
        """The Cholesky factors of J^T J + diag(damping), or None if that is not positive definite.

        Args:
            normal: the model.
            damping: (count, size) added to the diagonal.
        """
        diagonal = normal.diagonal.copy()
        i = np.arange(self.size)
        diagonal[:, i, i] += damping
        if not len(self.pairs):
            return _Separate.of(diagonal)
        if self._fronts is not None:
            return self._fronts.factorize(diagonal, normal.coupling)
        flat = np.zeros(self._width * self.count * self.size)
        flat[self._diagonal_at] = diagonal[:, self._lower[0], self._lower[1]]
        flat[self._coupling_at] = normal.coupling
        band, info = dpbtrf(flat.reshape(-1, self._width).T, lower=1, overwrite_ab=1)
        return _Band(self._order, band) if info == 0 else None


class Factors(Protocol):
    """A factorized matrix."""

    def solve(self, right: Array) -> Array:
        """(count, size) what the matrix times which is `right` (count, size)."""
        ...


@dataclass(frozen=True, slots=True)
class _Band:
    """The factor of a matrix whose blocks stand in another order, as LAPACK stores it."""

    order: IntArray
    lower: Array

    def solve(self, right: Array) -> Array:
        solution, _ = dpbtrs(self.lower, right[self.order].reshape(-1), lower=1, overwrite_b=1)
        step = np.empty(right.shape)
        step[self.order] = solution.reshape(right.shape)
        return step


@dataclass(frozen=True, slots=True)
class _Separate:
    """Factors of blocks that are coupled with none."""

    lower: list[Array]

    @staticmethod
    def of(matrices: Array) -> _Separate | None:
        """Of symmetric matrices (count, size, size), which are overwritten."""
        found = []
        for matrix in matrices:
            lower, info = dpotrf(matrix.T, lower=1, clean=0, overwrite_a=1)
            if info != 0:
                return None
            found.append(lower)
        return _Separate(found)

    def solve(self, right: Array) -> Array:
        step = np.empty(right.shape)
        # NumPy solves many systems in one call, but none that is factorized: it would take each apart once more.
        for place, lower in enumerate(self.lower):
            step[place], _ = dpotrs(lower, right[place], lower=1)
        return step
