"""Symmetric Hausdorff distance between chains of segments and arcs of ellipse, for many pairs at once. Millimetres.

The farthest point of one chain is looked for on a grid of samples and then in ever smaller grids around the best of
them; the distance from a point to the other chain is exact for segments and by Newton's method for arcs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import dot

PEAKS = 4
"""Samples on each piece around which the farthest point is looked for."""
SAMPLES = 33
"""Samples on each piece before refinement."""
ROUNDS = 4
"""Refinements, each on 9 samples over two steps of the one before: 1e-4 of a sample's step in the end."""
NEWTON_STEPS = 8
STILL = 1e-10
"""Radians; after Newton steps no longer than this the next ones, which go with their square, would change nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CurvePieces:
    """n pieces center + cos(w) * cosine_axis + sin(w) * sine_axis for arcs, center + w * cosine_axis for segments.

    Attributes:
        centers: (n, 3) mm; a segment's start.
        cosine_axes: (n, 3); a segment's whole span.
        sine_axes: (n, 3); zero for a segment.
        starts: (n,) least parameter; 0 for a segment.
        stops: (n,) greatest parameter; 1 for a segment.
        arcs: (n,) whether it is an arc.
    """

    centers: Array
    cosine_axes: Array
    sine_axes: Array
    starts: Array
    stops: Array
    arcs: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    def __len__(self) -> int:
        return len(self.centers)


def _stacked(chains: Sequence[CurvePieces]) -> CurvePieces:
    """Chains as one batch of (m, most pieces); short ones repeat their last piece, which changes no distance."""
    most = max(len(chain) for chain in chains)
    rows = [np.minimum(np.arange(most), len(chain) - 1) for chain in chains]
    fields = (
        np.stack([getattr(chain, name)[row] for chain, row in zip(chains, rows, strict=True)])
        for name in ("centers", "cosine_axes", "sine_axes", "starts", "stops", "arcs")
    )
    centers, cosines, sines, starts, stops, arcs = fields
    return CurvePieces(centers=centers, cosine_axes=cosines, sine_axes=sines, starts=starts, stops=stops, arcs=arcs)


def _points(pieces: CurvePieces, parameters: Array) -> Array:
    """(m, k, s, 3) points at parameters (m, k, s) of pieces (m, k)."""
    arcs = pieces.arcs[..., None]
    cosine = np.where(arcs, np.cos(parameters), parameters)[..., None]
    sine = np.where(arcs, np.sin(parameters), 0.0)[..., None]
    turned = cosine * pieces.cosine_axes[..., None, :] + sine * pieces.sine_axes[..., None, :]
    return np.asarray(pieces.centers[..., None, :] + turned)


def _to_piece(points: Array, pieces: CurvePieces, index: int) -> Array:
    """(m, s) distances from points (m, s, 3) to piece `index` of each chain."""
    center, along = pieces.centers[:, None, index], pieces.cosine_axes[:, None, index]
    across = pieces.sine_axes[:, None, index]
    start, stop = pieces.starts[:, None, index], pieces.stops[:, None, index]
    arc = pieces.arcs[:, None, index]
    offset = points - center
    x, y = dot(offset, along), dot(offset, across)
    a2, b2 = dot(along, along), dot(across, across)
    middle = 0.5 * (start + stop)
    # The centre sees (x / a, y / b) of the unit circle; x and y hold a factor of a and b already.
    guess = np.arctan2(y * a2, np.where(arc, x * b2, 1.0))
    guess = middle + np.remainder(guess - middle + np.pi, 2.0 * np.pi) - np.pi
    w = np.clip(np.where(arc, guess, x / a2), start, stop)
    for _ in range(NEWTON_STEPS if arc.any() else 0):
        cosine, sine = np.cos(w), np.sin(w)
        slope = x * sine - y * cosine + (b2 - a2) * sine * cosine
        bend = x * cosine + y * sine + (b2 - a2) * (cosine**2 - sine**2)
        # Away from a minimum the bend may vanish or turn; a step of the circle's then still leads downhill.
        step = slope / np.where(bend > 0.1 * a2, bend, a2)
        before, w = w, np.where(arc, np.clip(w - step, start, stop), w)
        if np.abs(w - before).max(initial=0.0) <= STILL:
            break
    candidates = np.stack([w, np.broadcast_to(start, w.shape), np.broadcast_to(stop, w.shape)], axis=-1)
    cosine = np.where(arc[..., None], np.cos(candidates), candidates)[..., None]
    sine = np.where(arc[..., None], np.sin(candidates), 0.0)[..., None]
    off = offset[..., None, :] - cosine * along[..., None, :] - sine * across[..., None, :]
    return np.asarray(np.sqrt(dot(off, off).min(axis=-1)))


def _to_chain(points: Array, pieces: CurvePieces) -> Array:
    """(m, s) distances from points (m, s, 3) to the nearest piece of each chain."""
    return np.asarray(np.min([_to_piece(points, pieces, index) for index in range(pieces.centers.shape[1])], axis=0))


def _farthest(chain: CurvePieces, other: CurvePieces) -> Array:
    """(m,) greatest distance of a point of `chain` from `other`."""
    pairs, count = chain.starts.shape
    spans = chain.stops - chain.starts
    fractions = np.linspace(0.0, 1.0, SAMPLES)
    parameters = chain.starts[..., None] + spans[..., None] * fractions
    points = _points(chain, parameters).reshape(pairs, -1, 3)
    distances = _to_chain(points, other).reshape(pairs, count, SAMPLES)
    # The farthest point may hide between two samples while a third is the farthest of all: look around several.
    best = np.argsort(-distances, axis=-1, kind="stable")[..., :PEAKS]
    peak = np.take_along_axis(parameters, best, axis=-1)
    greatest = distances.max(axis=(1, 2))
    step = spans / (SAMPLES - 1)
    for _ in range(ROUNDS):
        grid = peak[..., None] + step[..., None, None] * np.linspace(-1.0, 1.0, 9)
        grid = np.clip(grid, chain.starts[..., None, None], chain.stops[..., None, None])
        on_chain = _points(chain, grid.reshape(pairs, count, -1)).reshape(pairs, -1, 3)
        near = _to_chain(on_chain, other).reshape(grid.shape)
        peak = np.take_along_axis(grid, near.argmax(axis=-1)[..., None], axis=-1)[..., 0]
        greatest = np.maximum(greatest, near.max(axis=(1, 2, 3)))
        step = step / 4.0
    return np.asarray(greatest)


def hausdorff_distances(firsts: Sequence[CurvePieces], seconds: Sequence[CurvePieces]) -> Array:
    """(m,) symmetric Hausdorff distances between the chains of each pair, mm."""
    if not firsts:
        return np.zeros(0)
    one, two = _stacked(firsts), _stacked(seconds)
    return np.maximum(_farthest(one, two), _farthest(two, one))
