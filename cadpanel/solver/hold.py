"""Vectors that are to stay within a distance, or numbers that are to stay below one: tolerances instead of weights."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from cadpanel.arrays import Array, IntArray


class Hold:
    """Distances and weights of a batch of held vectors.

    Attributes:
        radius: (groups, vectors) the distances tau that vectors may be long, or that numbers may reach.
        weight: (groups, vectors) weights of their squares in the cost, whatever the tolerance says; 0 for none.
        scale: (groups, vectors) what counts as a large change: the radius, or for numbers a length of their own.
        one_sided: whether these are numbers that may be as far below 0 as they like.
        gives_way: whether they may exceed their distances where not everything can be held.
        ties: how heavily steps are damped in their directions, a share of the damping.
    """

    def __init__(
        self,
        radius: Array,
        *,
        weight: float,
        scale: Array | None = None,
        one_sided: bool = False,
        gives_way: bool = False,
        ties: float = 1.0,
    ) -> None:
        """Start with one weight for all vectors; distances are above 0."""
        self.radius = radius
        self.weight = np.full(radius.shape, weight)
        self.scale = scale
        self.one_sided, self.gives_way, self.ties = one_sided, gives_way, ties

    def squares(self, vectors: Array) -> Array:
        """(groups, vectors) the squares that weights count, of vectors (groups, vectors, d)."""
        counted = np.maximum(vectors, 0.0) if self.one_sided else vectors
        squares: Array = np.einsum("gqd,gqd->gq", counted, counted)
        return squares

    def ratio(self, vectors: Array) -> Array:
        """(groups, vectors) |v| / tau."""
        ratio: Array = np.sqrt(self.squares(vectors)) / self.radius
        return ratio

    def excess(self, vectors: Array) -> float:
        """The largest |v| / tau."""
        return float(self.ratio(vectors).max(initial=0.0))

    def tighten(self, share: Array) -> None:
        """Shrink the distances of every group to a share (groups,) of themselves."""
        self.radius = self.radius * share[:, None]


class HeldVectors(Protocol):
    """Who a batch of held vectors belongs to.

    Attributes:
        hold: their distances.
        blocks: one or two arrays (groups,): the blocks of unknowns that each group of vectors sees.
        pair: (groups,) which pair of coupled blocks these are; None where a group sees one block.
    """

    hold: Hold

    @property
    def blocks(self) -> tuple[IntArray, ...]:
        """See the class."""
        ...

    @property
    def pair(self) -> IntArray | None:
        """See the class."""
        ...
