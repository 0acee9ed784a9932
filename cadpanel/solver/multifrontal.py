"""A Cholesky factorization part by part, each a small dense matrix.

Every part of a dissection has a front: the rows of its own blocks and of those that it is coupled with later. What is
left of it once its own blocks are eliminated is added to the front of a later part (Duff and Reid, The multifrontal
solution of indefinite sparse symmetric linear equations, ACM Transactions on Mathematical Software 9, 1983).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.linalg.lapack import dpotrf

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.dissection import Part


@dataclass(frozen=True, slots=True)
class _Front:
    """Where the numbers of a part's front come from and go to.

    Attributes:
        own, rows: number of its own rows, and of all rows.
        at, source: places in the front, column by column, and in the matrix's numbers, which belong there.
        places: (rows,) of these rows in the unknowns.
        children: the parts whose rest is added, each with the rows (n,) of this front that it is added to.
    """

    own: int
    rows: int
    at: IntArray
    source: IntArray
    places: IntArray
    children: tuple[tuple[int, IntArray], ...]


@dataclass(frozen=True, slots=True)
class Fronts:
    """How the fronts of a pattern of coupled blocks are put together."""

    size: int
    fronts: tuple[_Front, ...]

    @staticmethod
    def of(parts: tuple[Part, ...], size: int, pairs: IntArray, count: int) -> Fronts:
        """The fronts of a dissection.

        Args:
            parts: of the dissection.
            size: rows of a block.
            pairs: (pairs, 2) coupled blocks.
            count: number of blocks.
        """
        order = np.concatenate([part.own for part in parts])
        position = np.empty(count, dtype=np.intp)
        position[order] = np.arange(count)
        part_of = np.empty(count, dtype=np.intp)
        for number, part in enumerate(parts):
            part_of[part.own] = number
        # A pair belongs to the part of the block that goes first.
        early = np.where(position[pairs[:, 0]] < position[pairs[:, 1]], pairs[:, 0], pairs[:, 1])
        of_part = np.argsort(part_of[early], kind="stable")
        bounds = np.searchsorted(part_of[early][of_part], np.arange(len(parts) + 1))
        inner = np.arange(size)
        within = np.empty(count, dtype=np.intp)
        fronts = []
        for number, part in enumerate(parts):
            blocks = np.concatenate([part.own, part.beyond])
            within[blocks] = np.arange(len(blocks))
            rows = len(blocks) * size
            mine = of_part[bounds[number] : bounds[number + 1]]
            at, source = _diagonal(part.own, within, size, rows)
            pair_at, pair_source = _coupled(pairs[mine], mine, within, size, rows)
            children = tuple(
                (child, (within[parts[child].beyond][:, None] * size + inner).reshape(-1)) for child in part.children
            )
            fronts.append(
                _Front(
                    own=len(part.own) * size,
                    rows=rows,
                    at=np.concatenate([at, pair_at]),
                    source=np.concatenate([source, count * size * size + pair_source]),
                    places=(blocks[:, None] * size + inner).reshape(-1),
                    children=children,
                )
            )
        return Fronts(size, tuple(fronts))

    def factorize(self, diagonal: Array, coupling: Array) -> FrontFactors | None:
        """Factors of the matrix with these blocks, (count, size, size) and (pairs, size, size); None if it has none."""
        numbers = np.concatenate([diagonal.reshape(-1), coupling.reshape(-1)])
        rest: dict[int, Array] = {}
        corners, sides = [], []
        for number, front in enumerate(self.fronts):
            flat = np.zeros(front.rows * front.rows)
            flat[front.at] = numbers[front.source]
            matrix = flat.reshape(front.rows, front.rows).T  # column by column, as LAPACK has it
            for child, rows in front.children:
                matrix[rows[:, None], rows] += rest.pop(child)
            corner, info = dpotrf(matrix[: front.own, : front.own], lower=1, clean=0)
            if info != 0:
                return None
            side = matrix[front.own :, : front.own]
            if front.rows > front.own:
                side = dtrsm(1.0, corner, side, side=1, lower=1, trans_a=1)
                rest[number] = dsyrk(-1.0, side, beta=1.0, c=matrix[front.own :, front.own :], lower=1)
            corners.append(corner)
            sides.append(side)
        return FrontFactors(self.fronts, corners, sides)


@dataclass(frozen=True, slots=True)
class FrontFactors:
    """The factors of all fronts."""

    fronts: tuple[_Front, ...]
    corners: list[Array]
    sides: list[Array]

    def solve(self, right: Array) -> Array:
        """(count, size) what the matrix times which is `right` (count, size)."""
        x = right.reshape(-1).copy()
        parts = list(zip(self.fronts, self.corners, self.sides, strict=True))
        for front, corner, side in parts:
            own, beyond = front.places[: front.own], front.places[front.own :]
            x[own] = solve_triangular(corner, x[own], lower=True, check_finite=False)
            x[beyond] -= side @ x[own]
        for front, corner, side in reversed(parts):
            own, beyond = front.places[: front.own], front.places[front.own :]
            x[own] = solve_triangular(corner, x[own] - side.T @ x[beyond], trans="T", lower=True, check_finite=False)
        return x.reshape(right.shape)


def _diagonal(own: IntArray, within: IntArray, size: int, rows: int) -> tuple[IntArray, IntArray]:
    row, column = np.indices((size, size))
    first = within[own][:, None, None] * size
    at = (first + column) * rows + first + row
    source = own[:, None, None] * size * size + row * size + column
    return at.reshape(-1), source.reshape(-1)


def _coupled(pairs: IntArray, which: IntArray, within: IntArray, size: int, rows: int) -> tuple[IntArray, IntArray]:
    """Below the diagonal: the block of the pair, or its transpose where its first block goes first."""
    i, j = np.indices((size, size))
    first, second = (within[pairs[:, k]][:, None, None] * size for k in (0, 1))
    row, column = first + i, second + j
    at = np.minimum(row, column) * rows + np.maximum(row, column)
    source = which[:, None, None] * size * size + i * size + j
    return at.reshape(-1), source.reshape(-1)
