"""Small sums of squares for the solver, which knows nothing of panels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.blocks import BlockPattern, Normal
from cadpanel.solver.bounds import Bounds
from cadpanel.solver.held_model import Point
from cadpanel.solver.hold import Hold

Residual = Callable[[Array], Array]


def pattern(count: int, size: int, pairs: list[tuple[int, int]]) -> BlockPattern:
    """A pattern of coupled blocks."""
    return BlockPattern(count, size, np.array(pairs, dtype=np.intp).reshape(-1, 2))


def strip(count: int) -> list[tuple[int, int]]:
    """Each block coupled to the next."""
    return [(i, i + 1) for i in range(count - 1)]


def ring(count: int) -> list[tuple[int, int]]:
    """A closed strip."""
    return [*strip(count), (0, count - 1)]


def grid(rows: int, columns: int) -> list[tuple[int, int]]:
    """Blocks side by side in rows and columns."""
    right = [(r * columns + c, r * columns + c + 1) for r in range(rows) for c in range(columns - 1)]
    down = [(r * columns + c, (r + 1) * columns + c) for r in range(rows - 1) for c in range(columns)]
    return right + down


def shuffled(pairs: list[tuple[int, int]], count: int, seed: int) -> list[tuple[int, int]]:
    """The same couplings with the blocks renumbered at random."""
    where = np.random.default_rng(seed).permutation(count)
    return sorted((min(where[i], where[j]), max(where[i], where[j])) for i, j in pairs)


@dataclass
class Separate:
    """One residual function on every block by itself; block k scales its residuals by `scale[k]`."""

    residual: Residual
    jacobian: Residual
    pattern: BlockPattern
    scale: Array
    bounds: Bounds | None = None

    def cost(self, unknowns: Array) -> Array:
        """Half the squares, block by block."""
        squares: Array = np.sum(np.array([self.residual(u) for u in unknowns]) ** 2, axis=1)
        return 0.5 * self.scale**2 * squares

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """The Gauss-Newton model."""
        normal = Normal.zero(len(unknowns), unknowns.shape[1], len(self.pattern.pairs))
        for k, u in enumerate(unknowns):
            r, j = self.scale[k] * self.residual(u), self.scale[k] * self.jacobian(u)
            normal.gradient[k], normal.diagonal[k] = j.T @ r, j.T @ j
        return self.cost(unknowns), normal


def rosenbrock(u: Array) -> Array:
    """Rosenbrock's valley (1960); its minimum is 0 at (1, 1)."""
    return np.array([10.0 * (u[1] - u[0] ** 2), 1.0 - u[0]])


def rosenbrock_jacobian(u: Array) -> Array:
    """Derivatives of `rosenbrock`."""
    return np.array([[-20.0 * u[0], 10.0], [-1.0, 0.0]])


def powell(u: Array) -> Array:
    """Powell's singular function (1962); its minimum is 0 at the origin, where the Jacobian loses rank."""
    a, b, c, d = u
    return np.array([a + 10.0 * b, np.sqrt(5.0) * (c - d), (b - 2.0 * c) ** 2, np.sqrt(10.0) * (a - d) ** 2])


def powell_jacobian(u: Array) -> Array:
    """Derivatives of `powell`."""
    a, b, c, d = u
    s, t = np.sqrt(5.0), np.sqrt(10.0)
    return np.array(
        [
            [1.0, 10.0, 0.0, 0.0],
            [0.0, 0.0, s, -s],
            [0.0, 2.0 * (b - 2.0 * c), -4.0 * (b - 2.0 * c), 0.0],
            [2.0 * t * (a - d), 0.0, 0.0, -2.0 * t * (a - d)],
        ]
    )


class HeldBatch:
    """Vectors x_second - x_first - offset of pairs of points, or x - offset of single ones, held within distances."""

    def __init__(self, hold: Hold, offset: Array, blocks: tuple[IntArray, ...], pair: IntArray | None = None) -> None:
        """`offset` (groups, vectors, d)."""
        self.hold, self.offset, self.blocks, self.pair = hold, offset, blocks, pair

    def vectors(self, unknowns: Array) -> Array:
        """(groups, vectors, d)."""
        of = [unknowns[block] for block in self.blocks]
        apart = of[0] if len(of) == 1 else of[1] - of[0]
        return np.asarray(apart[:, None] - self.offset)

    def jacobians(self) -> tuple[Array, ...]:
        """For each block (groups, vectors, d, d)."""
        unit = np.broadcast_to(np.eye(self.offset.shape[-1]), (*self.offset.shape, self.offset.shape[-1]))
        return (unit,) if len(self.blocks) == 1 else (-unit, unit)


class HeldTargets:
    """Points (count, d) that want to be at their targets, half the squared distance, and batches that are held."""

    def __init__(self, targets: Array, held: Sequence[HeldBatch], pairs: Sequence[tuple[int, int]] = ()) -> None:
        """`targets` (points, d)."""
        self.targets, self.held = targets, tuple(held)
        free = np.full(targets.shape, np.inf)
        self.bounds = Bounds(-free, free)
        self.pattern = pattern(targets.shape[0], targets.shape[1], list(pairs))
        self.lengths, self.powers = np.ones(len(targets)), np.ones(targets.shape)

    def free_cost(self, unknowns: Array) -> float:
        """The cost of what is not held."""
        return 0.5 * float(np.sum((unknowns - self.targets) ** 2))

    def vectors(self, unknowns: Array) -> tuple[Array, ...]:
        """See `solver.HeldModel.vectors`."""
        return tuple(batch.vectors(unknowns) for batch in self.held)

    def cost(self, unknowns: Array) -> tuple[Array, tuple[Array, ...]]:
        """See `solver.HeldModel.cost`."""
        return 0.5 * np.sum((unknowns - self.targets) ** 2, axis=1), self.vectors(unknowns)

    def at(self, unknowns: Array) -> Point:
        """See `solver.HeldModel.at`; the model is exact."""
        count, size = unknowns.shape
        normal = Normal.zero(count, size, len(self.pattern.pairs))
        normal.gradient += unknowns - self.targets
        normal.diagonal += np.eye(size)
        cost, vectors = self.cost(unknowns)
        return Point(unknowns, cost, normal, vectors, tuple(batch.jacobians() for batch in self.held))


def held_points(targets: Array, centres: Array, radius: Array, **how: Any) -> HeldTargets:
    """Points held near fixed centres, |x - centre| <= radius; each ends at its target's projection onto its ball."""
    hold = Hold(radius[:, None], **{"weight": 0.0, "gives_way": True, **how})
    return HeldTargets(targets, [HeldBatch(hold, centres[:, None], (np.arange(len(targets)),))])


def held_chain(targets: Array, radius: float, **how: Any) -> HeldTargets:
    """Neighbours in a chain held near each other: |x_k+1 - x_k| <= radius."""
    count, size = targets.shape
    hold = Hold(np.full((count - 1, 1), radius), **{"weight": 0.0, "gives_way": True, **how})
    first = np.arange(count - 1)
    batch = HeldBatch(hold, np.zeros((count - 1, 1, size)), (first, first + 1), first)
    return HeldTargets(targets, [batch], strip(count))


def side_by_side(*models: HeldTargets) -> HeldTargets:
    """Models whose batches are alike, beside each other with nothing between them."""
    first = np.cumsum([0, *(len(model.targets) for model in models)])[:-1]
    coupled = [model.pattern.pairs + begin for model, begin in zip(models, first, strict=True)]
    pairs = [(int(a), int(b)) for a, b in np.concatenate(coupled)]
    starts = np.cumsum([0, *(len(model.pattern.pairs) for model in models)])[:-1]
    held = []
    for batches in zip(*(model.held for model in models), strict=True):
        one = batches[0]
        hold = Hold(np.concatenate([batch.hold.radius for batch in batches]), weight=0.0, gives_way=one.hold.gives_way)
        blocks = tuple(
            np.concatenate([batch.blocks[side] + begin for batch, begin in zip(batches, first, strict=True)])
            for side in range(len(one.blocks))
        )
        own = [batch.pair + begin for batch, begin in zip(batches, starts, strict=True) if batch.pair is not None]
        offset = np.concatenate([batch.offset for batch in batches])
        held.append(HeldBatch(hold, offset, blocks, np.concatenate(own) if own else None))
    return HeldTargets(np.concatenate([model.targets for model in models]), held, pairs)


class SpringChain:
    """Points (count, d) that want to be at their targets and near their neighbours: half of all squared distances."""

    def __init__(self, targets: Array) -> None:
        self.targets, self.bounds = targets, None
        self.pattern = pattern(targets.shape[0], targets.shape[1], strip(len(targets)))

    def cost(self, unknowns: Array) -> Array:
        """Of the targets, and each spring booked on its first point."""
        cost: Array = 0.5 * np.sum((unknowns - self.targets) ** 2, axis=1)
        cost[:-1] += 0.5 * np.sum(np.diff(unknowns, axis=0) ** 2, axis=1)
        return cost

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """The model, which is exact."""
        count, size = unknowns.shape
        normal = Normal.zero(count, size, count - 1)
        pull = np.diff(unknowns, axis=0)
        normal.gradient += unknowns - self.targets
        normal.gradient[:-1] -= pull
        normal.gradient[1:] += pull
        normal.diagonal += np.eye(size)
        normal.diagonal[:-1] += np.eye(size)
        normal.diagonal[1:] += np.eye(size)
        normal.coupling -= np.eye(size)
        return self.cost(unknowns), normal


class LinearChain:
    """A strip of blocks with residual A u - b and narrow bounds."""

    def __init__(self, random: np.random.Generator, blocks: int, size: int) -> None:
        self.pattern = pattern(blocks, size, strip(blocks))
        rows = 3 * size
        self.matrix = np.zeros((blocks * rows, blocks * size))
        for k in range(blocks):
            wide = slice(k * size, min(k + 2, blocks) * size)
            self.matrix[k * rows : (k + 1) * rows, wide] = random.normal(size=(rows, wide.stop - wide.start))
        self.right = random.normal(size=len(self.matrix))
        self._rows = rows
        self.bounds = Bounds(np.full((blocks, size), -0.1), np.full((blocks, size), 0.1))

    def cost(self, unknowns: Array) -> Array:
        """Half the squares, booked on the block that a row begins with."""
        residual = self.matrix @ unknowns.ravel() - self.right
        booked: Array = 0.5 * np.sum(residual.reshape(len(unknowns), -1) ** 2, axis=1)
        return booked

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """The Gauss-Newton model."""
        count, size = unknowns.shape
        residual = self.matrix @ unknowns.ravel() - self.right
        square = (self.matrix.T @ self.matrix).reshape(count, size, count, size)
        i = np.arange(count)
        normal = Normal((self.matrix.T @ residual).reshape(count, size), square[i, :, i], square[i[:-1], :, i[1:]])
        return self.cost(unknowns), normal
