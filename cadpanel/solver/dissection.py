"""In which order to eliminate the blocks of a grid: nested dissection.

A few blocks that part the rest into two halves of about the same size are eliminated last, and each half is parted in
the same way (A. George, Nested dissection of a regular finite element mesh, SIAM J. Numerical Analysis 10, 1973). A
grid of n x n then costs n^3 operations instead of the n^4 of a band. The parting blocks are a level of a search from an
outermost block, which needs no coordinates (George and Liu, Computer Solution of Large Sparse Positive Definite
Systems, 1981, chapter 8).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from cadpanel.arrays import IntArray

# So few blocks are eliminated at once: dense matrices of this size cost less than more of them.
_LEAF = 24


@dataclass(frozen=True, slots=True)
class Part:
    """Blocks that are eliminated together, after all blocks of the parts that come before it.

    Attributes:
        own: (n,) the blocks.
        beyond: (m,) blocks of later parts that these are coupled with once all before them are gone, in their order.
        children: places of the parts whose `beyond` begins in this one.
    """

    own: IntArray
    beyond: IntArray
    children: tuple[int, ...]


def dissect(graph: csr_array) -> tuple[Part, ...]:
    """The parts of a symmetric graph, in the order of their elimination."""
    groups = _ordered(graph, np.arange(graph.shape[0], dtype=np.intp))
    position = np.empty(graph.shape[0], dtype=np.intp)
    position[np.concatenate(groups)] = np.arange(graph.shape[0])
    part_of = np.empty(graph.shape[0], dtype=np.intp)
    for number, own in enumerate(groups):
        part_of[own] = number
    waiting: list[list[int]] = [[] for _ in groups]
    parts: list[Part] = []
    for number, own in enumerate(groups):
        children = tuple(waiting[number])
        met = np.concatenate([_neighbours(graph, own), *(parts[child].beyond for child in children)])
        beyond = np.unique(position[met])
        beyond = np.concatenate(groups)[beyond[beyond > position[own].max()]] if len(beyond) else beyond
        if len(beyond):
            waiting[part_of[beyond[0]]].append(number)
        parts.append(Part(own, beyond, children))
    return tuple(parts)


def _ordered(graph: csr_array, blocks: IntArray) -> list[IntArray]:
    """Groups of the blocks, those that part the others last."""
    found: list[IntArray] = []
    halves = [blocks]
    # Depth first with a list of one's own: a long strip would be deeper than Python allows.
    while halves:
        some = halves.pop()
        if len(some) <= _LEAF:
            found.append(some)
            continue
        first, between, second = parted(graph[some][:, some])
        found.append(some[between])
        halves += [some[half] for half in (first, second) if len(half)]
    return [group for group in reversed(found) if len(group)]


def parted(graph: csr_array) -> tuple[IntArray, IntArray, IntArray]:
    """Two halves of a graph and what is between them."""
    count, label = connected_components(graph, directed=False)
    if count > 1:
        sizes = np.bincount(label)
        chosen = np.cumsum(sizes) <= max(len(label) // 2, int(sizes[0]))
        return np.flatnonzero(chosen[label]), np.empty(0, dtype=np.intp), np.flatnonzero(~chosen[label])
    level = _levels(graph, int(_levels(graph, 0).argmax()))
    # Of a level only those blocks part that are coupled with the next one; the others go with what is before them.
    row = np.repeat(np.arange(len(level)), np.diff(graph.indptr))
    parting = np.zeros(len(level), dtype=bool)
    parting[row[level[graph.indices] > level[row]]] = True
    size = np.bincount(level[parting], minlength=level.max() + 1)
    behind = np.cumsum(np.bincount(level))
    before, after = behind - size, len(level) - behind
    # The fewest blocks of those that leave a third on both sides, or else those in the middle.
    good = 3 * np.minimum(before, after) >= len(level)
    middle = np.abs(before - after)
    cut = int(np.lexsort((middle, np.where(good, size, len(level)), ~good))[0])
    between = parting & (level == cut)
    return np.flatnonzero((level <= cut) & ~between), np.flatnonzero(between), np.flatnonzero(level > cut)


def _levels(graph: csr_array, start: int) -> IntArray:
    """(blocks,) how many steps each block of a connected graph is from the first."""
    order, before = breadth_first_order(graph, start, directed=False, return_predecessors=True)
    level = np.zeros(graph.shape[0], dtype=np.intp)
    for block in order[1:].tolist():
        level[block] = level[before[block]] + 1
    return level


def _neighbours(graph: csr_array, blocks: IntArray) -> IntArray:
    rows = [graph.indices[graph.indptr[b] : graph.indptr[b + 1]] for b in blocks.tolist()]
    return np.concatenate(rows).astype(np.intp)
