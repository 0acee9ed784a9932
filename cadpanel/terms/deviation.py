"""Deviation: the distance of reference samples to the patch they belong to (the paper's regression term).

Each sample belongs to the patch between whose bounding rulings its foot point falls. Because neighbouring patches
share their tangent plane, the distance and its gradient are continuous where a sample changes patch, so samples are
assigned anew at every evaluation and none need be kept clear of the patches' boundaries.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.distance import assign, patch_distance, patch_distance_inner, patch_outer
from cadpanel.features.layout import Group, Layout
from cadpanel.features.rulings import Rulings, Walk
from cadpanel.geometry.cone import INNER, plane_distance
from cadpanel.solver.blocks import Normal
from cadpanel.terms.rows import Rows
from cadpanel.terms.state import State

# Panels worked on together: their samples and derivatives stay in the processor's cache.
_CHUNK = 64


@dataclass(frozen=True, slots=True)
class _Chunk:
    """Some panels of one feature: their walk, samples (3, n, m), roots of weights (n, m), who they are, and limits."""

    walked: Walk
    samples: Array
    roots: Array
    panels: IntArray
    allowed: tuple[IntArray, IntArray] | None

    def assign(self) -> IntArray:
        """The patch (n, m) of each sample, as near as it is allowed to the one under its foot point."""
        patch = assign(self.walked, self.samples)
        return patch if self.allowed is None else np.clip(patch, *self.allowed)


class Deviation:
    """Half the weighted sum of squared distances of the samples.

    Attributes:
        samples: (3, panels, m) coordinates in the panels' own frames, in units of the solver's length.
        roots: (panels, m) square roots of the samples' weights; 0 where a panel has fewer samples than others.
        allowed: first and last patch (panels, m) that each sample may be held to, None where the foot point rules
            alone.
    """

    def __init__(self, samples: Array, roots: Array, allowed: tuple[IntArray, IntArray] | None = None) -> None:
        """Keep the arrays."""
        self.samples, self.roots, self.allowed = samples, roots, allowed

    def take(self, panels: IntArray) -> Deviation:
        """The same term for some of its panels."""
        allowed = None if self.allowed is None else (self.allowed[0][panels], self.allowed[1][panels])
        return Deviation(np.ascontiguousarray(self.samples[:, panels]), self.roots[panels], allowed)

    def distances(self, state: State, *, held: bool = False) -> tuple[Array, IntArray]:
        """Signed distances (panels, m) in units of the solver's length, and the patch that each sample belongs to.

        To the panel as it is, under the samples' foot points; `held` to the patches that they may be held to, as the
        term's cost counts them.
        """
        distance, patches = np.zeros(self.roots.shape), np.zeros(self.roots.shape, dtype=np.intp)
        for chunk in self._chunks(state):
            patch = chunk.assign() if held else assign(chunk.walked, chunk.samples)
            own = np.zeros(patch.shape)
            for i in range(len(chunk.walked.feature.patches)):
                own = np.where(patch == i, patch_distance(chunk.walked, chunk.samples, i), own)
            distance[chunk.panels], patches[chunk.panels] = own, patch
        return distance, patches

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        cost = np.zeros(len(self.roots))
        for chunk in self._chunks(state):
            patch = chunk.assign()
            total = np.zeros(len(chunk.panels))
            for i in range(len(chunk.walked.feature.patches)):
                weighted = np.where(patch == i, chunk.roots, 0.0) * patch_distance(chunk.walked, chunk.samples, i)
                total += 0.5 * np.einsum("pm,pm->p", weighted, weighted)
            cost[chunk.panels] = total
        return cost

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`; the chain rule is applied to the summed 8 x 8 moments of each patch, not to every row."""
        cost = np.zeros(len(self.roots))
        for chunk in self._chunks(state):
            walked, feature = chunk.walked, chunk.walked.feature
            patch = chunk.assign()
            count = len(feature.free)
            gradient, square = np.zeros((len(chunk.panels), count)), np.zeros((len(chunk.panels), count, count))
            total = np.zeros(len(chunk.panels))
            for i in range(len(feature.patches)):
                root = np.where(patch == i, chunk.roots, 0.0) if len(feature.patches) > 1 else chunk.roots
                moments = _round_moments if feature.curved[i] else _plane_moments
                half, slope, bend = moments(walked, chunk.samples, i, root)
                outer = feature.by_unknowns(patch_outer(walked, i))
                turned = np.swapaxes(outer, 1, 2)
                total += half
                gradient += (turned @ slope[..., None])[..., 0]
                square += turned @ (bend @ outer)
            cost[chunk.panels] = total
            normal.gradient[chunk.panels, :count] += gradient
            normal.diagonal[chunk.panels, :count, :count] += square
        return cost

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        rows = []
        for chunk in self._chunks(state):
            walked, feature = chunk.walked, chunk.walked.feature
            patch = chunk.assign()
            residual, jacobian = np.zeros(patch.shape), np.zeros((*patch.shape, state.layout.size))
            for i in range(len(feature.patches)):
                distance, inner = patch_distance_inner(walked, chunk.samples, i)
                mine = patch == i
                residual = np.where(mine, distance * chunk.roots, residual)
                own = (inner @ feature.by_unknowns(patch_outer(walked, i))) * chunk.roots[..., None]
                jacobian[..., : own.shape[-1]] = np.where(mine[..., None], own, jacobian[..., : own.shape[-1]])
            rows.append(Rows(residual, (chunk.panels,), (jacobian,)))
        return rows

    def _chunks(self, state: State) -> Iterator[_Chunk]:
        for group, walked in zip(state.layout.groups, state.walks, strict=True):
            samples, roots = self._own(state.layout, group)
            for start in range(0, len(group.panels), _CHUNK):
                part = slice(start, start + _CHUNK)
                panels = group.panels[part]
                allowed = None if self.allowed is None else (self.allowed[0][panels], self.allowed[1][panels])
                yield _Chunk(_part(walked, part), samples[:, part], roots[part], panels, allowed)

    def _own(self, layout: Layout, group: Group) -> tuple[Array, Array]:
        if len(layout.groups) == 1:
            return self.samples, self.roots
        return self.samples[:, group.panels], self.roots[group.panels]


def _round_moments(walked: Walk, x: Array, patch: int, root: Array) -> tuple[Array, Array, Array]:
    """Half the squares (n,), gradient (n, 8) and J^T J (n, 8, 8) by the inner numbers of a cone or cylinder."""
    distance, inner = patch_distance_inner(walked, x, patch)
    distance *= root
    inner *= root[..., None]
    turned = np.swapaxes(inner, 1, 2)
    return 0.5 * np.einsum("pm,pm->p", distance, distance), (turned @ distance[..., None])[..., 0], turned @ inner


def _plane_moments(walked: Walk, x: Array, patch: int, root: Array) -> tuple[Array, Array, Array]:
    """The same for a plane, whose rows -(x cross n), -n are linear in (x, 1): four sums of samples make its moments."""
    p, n = walked.carriers.p[:, patch], walked.carriers.n[:, patch]
    distance = root * plane_distance(x, p, n)
    lifted = np.empty((*root.shape, 4))
    for axis in range(3):
        np.multiply(x[axis], root, out=lifted[..., axis])
    lifted[..., 3] = root
    turned = np.swapaxes(lifted, 1, 2)
    rows = np.zeros((len(p), INNER, 4))
    # n cross x, written as a matrix on x.
    rows[:, 0, 1], rows[:, 0, 2] = -n[:, 2], n[:, 1]
    rows[:, 1, 0], rows[:, 1, 2] = n[:, 2], -n[:, 0]
    rows[:, 2, 0], rows[:, 2, 1] = -n[:, 1], n[:, 0]
    rows[:, 3:6, 3] = -n
    slope = (rows @ (turned @ distance[..., None]))[..., 0]
    return 0.5 * np.einsum("pm,pm->p", distance, distance), slope, rows @ (turned @ lifted) @ np.swapaxes(rows, 1, 2)


def _part(walked: Walk, part: slice) -> Walk:
    """The same walk for some of its panels."""
    if len(walked.values) <= _CHUNK:
        return walked

    def cut(rulings: Rulings) -> Rulings:
        twist = None if rulings.twist is None else rulings.twist[part]
        return Rulings(rulings.p[part], rulings.b[part], rulings.t[part], rulings.n[part], twist)

    w = walked
    dimensions = tuple(one.take(part) for one in w.dimensions)
    return Walk(w.feature, w.values[part], dimensions, cut(w.anchor), cut(w.edges), cut(w.carriers))
