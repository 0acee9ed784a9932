"""Deviation: the distance of reference samples to the patch they belong to (the paper's regression term).

Each sample belongs to the patch between whose bounding rulings its foot point falls. Because neighbouring patches
share their tangent plane, the distance and its gradient are continuous where a sample changes patch, so samples are
assigned anew at every evaluation and none need be kept clear of the patches' boundaries.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.distance import assign, patch_outers, skins_under
from cadpanel.features.layout import Group, Layout
from cadpanel.features.rulings import Walk
from cadpanel.geometry.cone import INNER
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
    panels: IntArray | slice
    allowed: tuple[IntArray, IntArray] | None

    @property
    def outer(self) -> Array:
        """(n, k, 8, unknowns) how the inner numbers of the patches follow the unknowns."""
        return self.walked.feature.by_unknowns(patch_outers(self.walked))

    def linear(self) -> tuple[Array, BoolArray]:
        """How residuals follow their own patches' numbers, and they themselves (n, 8 + 1, m); whose they are (n, k, m).

        As rows of one array: what is summed over the samples then is so in one product of matrices.
        """
        patch = self.assign()
        distance, inner = skins_under(self.walked, patch).distance_inner(self.samples)
        rows = np.empty((INNER + 1, *distance.shape))
        np.multiply(inner, self.roots, out=rows[:INNER])
        np.multiply(distance, self.roots, out=rows[INNER])
        mine = patch[:, None] == np.arange(len(self.walked.feature.patches))[:, None]
        return rows.swapaxes(0, 1), mine

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
            distance[chunk.panels] = skins_under(chunk.walked, patch).distance(chunk.samples)
            patches[chunk.panels] = patch
        return distance, patches

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        cost = np.zeros(len(self.roots))
        for chunk in self._chunks(state):
            residual = chunk.roots * skins_under(chunk.walked, chunk.assign()).distance(chunk.samples)
            cost[chunk.panels] = 0.5 * np.einsum("pm,pm->p", residual, residual)
        return cost

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`; the chain rule is applied to the summed 8 x 8 moments of each patch, not to every row."""
        cost = np.zeros(len(self.roots))
        for chunk in self._chunks(state):
            (rows, mine), each = chunk.linear(), chunk.outer
            panels, (n, patches, _, count) = chunk.panels, each.shape
            bend = np.empty((n, patches, INNER, INNER + 1))
            turned, own = rows.swapaxes(1, 2), np.empty((n, INNER, rows.shape[2]))
            for i in range(patches):
                np.multiply(rows[:, :INNER], mine[:, i, None], out=own)
                np.matmul(own, turned, out=bend[:, i])
            outer = each.reshape(n, -1, count)
            moved = (bend[..., :INNER] @ each).reshape(outer.shape)
            turned = outer.swapaxes(1, 2)
            normal.gradient[panels, :count] += (turned @ bend[..., INNER].reshape(n, -1, 1))[..., 0]
            normal.diagonal[panels, :count, :count] += turned @ moved
            cost[panels] = 0.5 * np.einsum("pm,pm->p", rows[:, INNER], rows[:, INNER])
        return cost

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        rows = []
        for chunk in self._chunks(state):
            own, mine = chunk.linear()
            (panels, _, _, count), residual = chunk.outer.shape, own[:, INNER]
            jacobian = np.zeros((*residual.shape, state.layout.size))
            by_patch = (own[:, None, :INNER] * mine[:, :, None]).reshape(panels, -1, residual.shape[1])
            jacobian[..., :count] = np.swapaxes(by_patch, 1, 2) @ chunk.outer.reshape(panels, -1, count)
            rows.append(Rows(residual, (np.arange(len(self.roots))[chunk.panels],), (jacobian,)))
        return rows

    def _chunks(self, state: State) -> Iterator[_Chunk]:
        for group, walked in zip(state.layout.groups, state.walks, strict=True):
            samples, roots = self._own(state.layout, group)
            for start in range(0, len(group.panels), _CHUNK):
                part = slice(start, start + _CHUNK)
                panels = part if len(state.layout.groups) == 1 else group.panels[part]
                allowed = None if self.allowed is None else (self.allowed[0][panels], self.allowed[1][panels])
                yield _Chunk(_part(walked, part), samples[:, part], roots[part], panels, allowed)

    def _own(self, layout: Layout, group: Group) -> tuple[Array, Array]:
        if len(layout.groups) == 1:
            return self.samples, self.roots
        return self.samples[:, group.panels], self.roots[group.panels]


def _part(walked: Walk, part: slice) -> Walk:
    """The same walk for some of its panels."""
    if len(walked.values) <= _CHUNK:
        return walked

    w = walked
    dimensions = tuple(one.take(part) for one in w.dimensions)
    return Walk(w.feature, w.values[part], dimensions, w.anchor.of(part), w.edges.of(part), w.carriers.of(part))
