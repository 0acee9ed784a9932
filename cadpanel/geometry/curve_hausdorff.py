"""Symmetric Hausdorff distance between chains of segments and arcs of ellipse, for many pairs at once. Millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.conic_chains import ConicChains, conic_chains
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.widest_place import widest


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


def _chains(pieces: CurvePieces, origin: Array) -> ConicChains:
    """Stacked pieces (m, k) seen from the origins (m, 3)."""
    arcs = pieces.arcs[..., None]
    along, turn = pieces.cosine_axes, pieces.stops - pieces.starts
    nothing = np.zeros_like(along)
    return conic_chains(
        constant=pieces.centers - origin[:, None],
        cosine=np.where(arcs, along, 0.0),
        sine=np.where(arcs, pieces.sine_axes, 0.0),
        weights=np.broadcast_to([1.0, 0.0, 0.0], along.shape),
        span=np.where(arcs, 0.0, turn[..., None] * along),
        start=np.where(pieces.arcs, pieces.starts, 0.0),
        turn=np.where(pieces.arcs, turn, 0.0),
        normals=(nothing, nothing, nothing),
    )


def hausdorff_distances(firsts: Sequence[CurvePieces], seconds: Sequence[CurvePieces]) -> Array:
    """(m,) symmetric Hausdorff distances between the chains of each pair, mm, within 1e-3 of their values.

    The pieces of a chain may stand in any order and direction.
    """
    if not firsts:
        return np.zeros(0)
    one, two = _stacked(firsts), _stacked(seconds)
    origin = 0.5 * (one.centers[:, 0] + two.centers[:, 0])
    return widest(_chains(one, origin), _chains(two, origin)).gap
