"""All held vectors of a model in a row: what is worked out for each by itself is worked out for all batches at once.

A small problem has a dozen batches of a few vectors each, and most of the time of a step would go to calls.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.solver.hold import HeldVectors
from cadpanel.solver.scatter import Scatter


class Rowed(NamedTuple):
    """Vectors of all batches after each other.

    Attributes:
        rows: (rows,) their components.
        squares: (vectors,) |v|^2; of numbers below 0 it is 0.
        values: (vectors,) the first component: all of what is a number.
    """

    rows: Array
    squares: Array
    values: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Bundle:
    """Batches whose groups see the same blocks, one by one: to a matrix of blocks they are one batch.

    Attributes:
        batches: which.
        columns: for each where its components stand in a group of all of them.
        rows: (groups, components) where these stand in the row.
        blocks: how groups add to blocks.
        pair: how they add to pairs of coupled blocks; None where a group sees one block.
    """

    batches: tuple[int, ...]
    columns: tuple[slice, ...]
    rows: IntArray
    blocks: tuple[Scatter, ...]
    pair: Scatter | None


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldRows:
    """Where the vectors of each batch stand in the row.

    Attributes:
        held: the batches.
        shapes: of each batch's vectors, (groups, vectors, d).
        vectors, rows: for each batch where its vectors and their components stand.
        starts: (vectors,) the first component of each.
        of: (rows,) whose component it is.
        first, second: (vectors,) the blocks that each sees, the same one twice where it sees one.
        gives_way, one_sided: (vectors,) see `Hold`.
        bundles: batches that are added to a matrix together.
    """

    held: tuple[HeldVectors, ...]
    shapes: tuple[tuple[int, int, int], ...]
    vectors: tuple[slice, ...]
    rows: tuple[slice, ...]
    starts: IntArray
    of: IntArray
    first: IntArray
    second: IntArray
    gives_way: BoolArray
    one_sided: BoolArray
    bundles: tuple[Bundle, ...]

    @staticmethod
    def of_batches(held: Sequence[HeldVectors], vectors: Sequence[Array], blocks: int, pairs: int) -> HeldRows:
        """The row of batches.

        Args:
            held: the batches.
            vectors: (groups, vectors, d) of each.
            blocks: number of all blocks.
            pairs: number of all pairs of coupled blocks.
        """
        shapes = [(len(one), one.shape[1], one.shape[2]) for one in vectors]
        counts = [groups * each for groups, each, _ in shapes]
        sizes = np.repeat(np.array([d for _, _, d in shapes], dtype=np.intp), counts)
        starts = np.cumsum(sizes) - sizes
        first, second = (
            [np.repeat(one.blocks[side], shape[1]) for one, shape in zip(held, shapes, strict=True)] for side in (0, -1)
        )
        none = np.zeros(0, dtype=np.intp)
        rows = _slices([count * d for count, (_, _, d) in zip(counts, shapes, strict=True)])
        return HeldRows(
            held=tuple(held),
            shapes=tuple(shapes),
            vectors=_slices(counts),
            rows=rows,
            starts=starts,
            of=np.repeat(np.arange(len(starts)), sizes),
            first=np.concatenate([none, *first]),
            second=np.concatenate([none, *second]),
            gives_way=np.repeat(np.array([one.hold.gives_way for one in held], dtype=bool), counts),
            one_sided=np.repeat(np.array([one.hold.one_sided for one in held], dtype=bool), counts),
            bundles=_bundles(held, rows, blocks, pairs),
        )

    def told(self, parts: Sequence[Array]) -> Array:
        """One array (vectors,) or (rows,) of one for each batch (groups, vectors, ...)."""
        return np.concatenate([np.zeros(0), *(part.reshape(-1) for part in parts)])

    def by_batch(self, values: Array) -> tuple[Array, ...]:
        """For each batch (groups, vectors), of values (vectors,)."""
        return tuple(values[part].reshape(shape[:2]) for part, shape in zip(self.vectors, self.shapes, strict=True))

    def weights(self) -> Array:
        """(vectors,) see `Hold`."""
        return self.told([one.hold.weight for one in self.held])

    def measured(self, vectors: Sequence[Array]) -> Rowed:
        """Vectors (groups, vectors, d) of each batch in a row."""
        rows = self.told(vectors)
        values = rows[self.starts]
        squares = np.where(self.one_sided & (values < 0.0), 0.0, self.total(rows * rows))
        return Rowed(rows, squares, values)

    def total(self, rows: Array) -> Array:
        """(vectors,) sums over the components of each."""
        return np.asarray(np.add.reduceat(rows, self.starts)) if len(rows) else np.zeros(0)


def _bundles(held: Sequence[HeldVectors], rows: Sequence[slice], blocks: int, pairs: int) -> tuple[Bundle, ...]:
    alike: dict[tuple[bytes, ...], list[int]] = {}
    seen: dict[tuple[bytes, ...], list[IntArray]] = {}
    for batch, one in enumerate(held):
        sees = [*one.blocks] if one.pair is None else [*one.blocks, one.pair]
        run = _run(sees)
        key = (b"" if one.pair is None else b"pair", *(index[::run].tobytes() for index in sees))
        alike.setdefault(key, []).append(batch)
        seen[key] = [index[::run] for index in sees]
    found = []
    for key, batches in alike.items():
        coupled = key[0] == b"pair"
        sees = seen[key]
        own = [np.arange(rows[i].start, rows[i].stop).reshape(len(sees[0]), -1) for i in batches]
        found.append(
            Bundle(
                batches=tuple(batches),
                columns=_slices([part.shape[1] for part in own]),
                rows=np.concatenate(own, axis=1),
                blocks=tuple(Scatter(index, blocks) for index in (sees[:-1] if coupled else sees)),
                pair=Scatter(sees[-1], pairs) if coupled else None,
            )
        )
    return tuple(found)


def _run(sees: Sequence[IntArray]) -> int:
    """How many groups after each other, all along, see the same: they may count as one group."""
    first = sees[0]
    run = int(np.argmax(np.append(first, -1) != first[0])) if len(first) else 1
    alike = len(first) % run == 0 and all(bool((index.reshape(-1, run) == index[::run, None]).all()) for index in sees)
    return run if alike else 1


def _slices(counts: Sequence[int]) -> tuple[slice, ...]:
    stops = np.cumsum([0, *counts]).tolist()
    return tuple(slice(*pair) for pair in pairwise(stops))
