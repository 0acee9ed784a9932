"""What a solver that holds vectors within distances sees of a problem."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from cadpanel.arrays import Array
from cadpanel.solver.blocks import BlockPattern, Normal
from cadpanel.solver.bounds import Bounds
from cadpanel.solver.hold import HeldVectors


@dataclass(frozen=True, slots=True)
class Point:
    """A problem at some unknowns, and how it changes beside them.

    Attributes:
        unknowns: (count, size).
        cost: (count,) the cost of everything that is not held, each residual booked on a block.
        normal: the Gauss-Newton model of that cost.
        vectors: for each batch of held vectors (groups, vectors, d).
        jacobians: for each batch, for each of its blocks (groups, vectors, d, size).
    """

    unknowns: Array
    cost: Array
    normal: Normal
    vectors: tuple[Array, ...]
    jacobians: tuple[tuple[Array, ...], ...]


class HeldModel(Protocol):
    """A sum of squares over blocks of unknowns, and vectors of these that are to stay within distances."""

    @property
    def pattern(self) -> BlockPattern:
        """Which blocks are coupled."""
        ...

    @property
    def bounds(self) -> Bounds:
        """Of the unknowns."""
        ...

    @property
    def lengths(self) -> Array:
        """(count,) how long what a block stands for is, the same for all of a connected component."""
        ...

    @property
    def powers(self) -> Array:
        """(count, size) the power of a length that each unknown counts in: 1 of lengths, 0 of angles."""
        ...

    @property
    def held(self) -> Sequence[HeldVectors]:
        """The batches of held vectors."""
        ...

    def at(self, unknowns: Array) -> Point:
        """The problem at the unknowns (count, size); costs or vectors of a trial that makes no sense are not finite."""
        ...

    def cost(self, unknowns: Array) -> tuple[Array, tuple[Array, ...]]:
        """The cost and the held vectors, without how they change."""
        ...

    def vectors(self, unknowns: Array) -> tuple[Array, ...]:
        """The held vectors alone."""
        ...
