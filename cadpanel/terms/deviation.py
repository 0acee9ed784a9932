"""Deviation: the distance of reference samples to the patch they belong to (the paper's regression term).

Each sample belongs to the patch between whose bounding rulings its foot point falls. Because neighbouring patches
share their tangent plane, the distance and its gradient are continuous where a sample changes patch, so samples are
assigned anew at every evaluation and none need be kept clear of the patches' boundaries.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.walk import Rulings, Walk
from cadpanel.geometry.cone import (
    INNER,
    beyond,
    cone_distance,
    cone_distance_inner,
    cone_normal,
    plane_distance,
    plane_inner,
)
from cadpanel.solver.blocks import Normal
from cadpanel.terms.rows import Rows
from cadpanel.terms.state import State

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

# Panels worked on together: their samples and derivatives stay in the processor's cache.
_CHUNK = 64


class Deviation:
    """Half the weighted sum of squared distances of the samples.

    Attributes:
        samples: (3, panels, m) coordinates in the panels' own frames, in units of the solver's length.
        roots: (panels, m) square roots of the samples' weights; 0 where a panel has fewer samples than others.
    """

    def __init__(self, samples: Array, roots: Array) -> None:
        """Keep the arrays."""
        self.samples, self.roots = samples, roots

    def distances(self, walked: Walk) -> tuple[Array, IntArray]:
        """Signed distances (panels, m) in units of the solver's length, and the patch that each sample belongs to."""
        patch = assign(walked, self.samples)
        distance = np.zeros(patch.shape)
        for i in range(len(walked.feature.patches)):
            here = _patch_distance(walked, self.samples, i)
            distance = np.where(patch == i, here, distance)
        return distance, patch

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        cost = np.zeros(len(self.roots))
        for chunk in self._chunks():
            walked, x = _part(state.walked, chunk), self.samples[:, chunk]
            patch = assign(walked, x)
            for i in range(len(walked.feature.patches)):
                distance = _patch_distance(walked, x, i)
                weighted = np.where(patch == i, self.roots[chunk], 0.0) * distance
                cost[chunk] += 0.5 * np.einsum("pm,pm->p", weighted, weighted)
        return cost

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`; the chain rule is applied to the summed 8 x 8 moments of each patch, not to every row."""
        cost = np.zeros(len(self.roots))
        free = state.walked.feature.free
        for chunk in self._chunks():
            walked, x = _part(state.walked, chunk), self.samples[:, chunk]
            patch = assign(walked, x)
            for i in range(len(walked.feature.patches)):
                distance, inner = _patch_distance_inner(walked, x, i)
                root = np.where(patch == i, self.roots[chunk], 0.0)
                distance *= root
                inner *= root[..., None]
                cost[chunk] += 0.5 * np.einsum("pm,pm->p", distance, distance)
                outer = _outer(walked, i)[:, :, free]
                turned, moment = np.swapaxes(inner, 1, 2), np.swapaxes(outer, 1, 2)
                normal.gradient[chunk] += (moment @ (turned @ distance[..., None]))[..., 0]
                normal.diagonal[chunk] += moment @ ((turned @ inner) @ outer)
        return cost

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        walked, free = state.walked, state.walked.feature.free
        patch = assign(walked, self.samples)
        residual = np.zeros(patch.shape)
        jacobian = np.zeros((*patch.shape, len(free)))
        for i in range(len(walked.feature.patches)):
            distance, inner = _patch_distance_inner(walked, self.samples, i)
            mine = patch == i
            residual = np.where(mine, distance * self.roots, residual)
            rows = (inner @ _outer(walked, i)[:, :, free]) * self.roots[..., None]
            jacobian = np.where(mine[..., None], rows, jacobian)
        return [Rows(residual, (np.arange(len(patch)),), (jacobian,))]

    def _chunks(self) -> list[slice]:
        return [slice(i, i + _CHUNK) for i in range(0, len(self.roots), _CHUNK)]


def assign(walked: Walk, x: Array) -> IntArray:
    """(panels, m) the patch of each sample x (3, panels, m).

    Walks outwards from the anchor ruling: a sample that is beyond one ruling may be beyond the next. Asking in this
    order keeps folds of up to half a turn apart, whose far flange lies behind the near ruling's plane.
    """
    anchor, edges, feature = walked.anchor, walked.edges, walked.feature
    right = beyond(x, anchor.p[:, 0], anchor.b[:, 0])
    patch = np.full(right.shape, feature.anchor, dtype=np.intp)
    passed = right
    for i in range(feature.anchor + 1, len(feature.patches)):
        passed = passed & beyond(x, edges.p[:, i], edges.b[:, i])
        patch += passed
    passed = ~right
    for i in range(feature.anchor, 0, -1):
        passed = passed & ~beyond(x, edges.p[:, i], edges.b[:, i])
        patch -= passed
    return patch


def skin_normals(walked: Walk, x: Array, patch: IntArray) -> Array:
    """(panels, m, 3) the skin's unit normals at the foot points of samples x (3, panels, m) on their patches."""
    normals = np.empty((*patch.shape, 3))
    for i, spec in enumerate(walked.feature.patches):
        p, t, n = _carrier(walked, i)
        if spec.kind == "plane":
            here = np.broadcast_to(n[:, None], normals.shape)
        else:
            start = walked.feature.patch_slice(i).start
            here = cone_normal(x, p, t, n, walked.values[:, start], walked.values[:, start + 1])
        normals = np.where((patch == i)[..., None], here, normals)
    return normals


def _part(walked: Walk, chunk: slice) -> Walk:
    """The same walk for some of its panels."""

    def cut(rulings: Rulings) -> Rulings:
        twist = None if rulings.twist is None else rulings.twist[chunk]
        return Rulings(rulings.p[chunk], rulings.b[chunk], rulings.t[chunk], rulings.n[chunk], twist)

    w = walked
    return Walk(w.feature, w.values[chunk], cut(w.anchor), cut(w.edges), cut(w.carriers), cut(w.arcs))


def _carrier(walked: Walk, patch: int) -> tuple[Array, Array, Array]:
    carriers = walked.carriers
    return carriers.p[:, patch], carriers.t[:, patch], carriers.n[:, patch]


def _patch_distance(walked: Walk, x: Array, patch: int) -> Array:
    p, t, n = _carrier(walked, patch)
    if walked.feature.patches[patch].kind == "plane":
        return plane_distance(x, p, n)
    start = walked.feature.patch_slice(patch).start
    return cone_distance(x, p, t, n, walked.values[:, start], walked.values[:, start + 1])


def _patch_distance_inner(walked: Walk, x: Array, patch: int) -> tuple[Array, Array]:
    p, t, n = _carrier(walked, patch)
    if walked.feature.patches[patch].kind == "plane":
        return plane_distance(x, p, n), plane_inner(x, n)
    start = walked.feature.patch_slice(patch).start
    return cone_distance_inner(x, p, t, n, walked.values[:, start], walked.values[:, start + 1])


def _outer(walked: Walk, patch: int) -> Array:
    """(panels, 8, N) how the patch's eight inner numbers follow the feature's numbers."""
    panels = np.arange(len(walked.values))
    start = walked.feature.patch_slice(patch).start if walked.feature.patches[patch].kind != "plane" else None
    return patch_outer(
        walked, panels, np.full(len(panels), patch), None if start is None else np.full(len(panels), start)
    )


def patch_outer(walked: Walk, panels: IntArray, patch: IntArray, start: IntArray | None) -> Array:
    """(groups, 8, N) how the eight inner numbers of one patch of each of some panels follow the feature's numbers.

    Args:
        walked: the panels, walked with derivatives.
        panels: (groups,) which panel.
        patch: (groups,) which of its patches.
        start: (groups,) where the patch's radius stands among the numbers (its half angle follows), None for planes.
    """
    if walked.carriers.twist is None:
        raise ValueError("the state was walked without derivatives")
    outer = np.zeros((len(panels), INNER, walked.values.shape[1]))
    outer[:, :6] = walked.carriers.twist[panels, patch]
    if start is not None:
        outer[np.arange(len(panels)), 6, start] = 1.0
        outer[np.arange(len(panels)), 7, start + 1] = 1.0
    return outer
