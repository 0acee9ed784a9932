"""How far apart and at which angle fitted panels meet; millimetres and radians."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.geometry.end_curves import EndCurves, seam_gap
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.vectors import norm
from cadpanel.reference.model import Seam


def along_seams(shapes: Sequence[Panel], seams: Sequence[Seam]) -> tuple[Array, Array]:
    """(seams,) gaps along whole seams in mm, and kinks in radians."""
    return gaps_and_kinks(PanelEdges.of(shapes), seams)


def gaps_and_kinks(edges: PanelEdges, seams: Sequence[Seam]) -> tuple[Array, Array]:
    """The same of panels whose edges are known."""
    gaps, kinks = np.zeros(len(seams)), np.zeros(len(seams))
    for met in _batches(edges, seams):
        gaps[met.index], kinks[met.index] = seam_gap(*met.curves(edges))
    return gaps, kinks


def corner_gaps(edges: PanelEdges, seams: Sequence[Seam]) -> tuple[Array, ...]:
    """For each seam the gaps (corners,) at the corners that meet, in the order of its first panel, mm.

    All corners meet where both edges have the same pieces, else only the two outermost.
    """
    gaps: dict[int, Array] = {}
    for met in _batches(edges, seams):
        first, second = met.curves(edges)
        pieces, others = (edges.pieces[batch] for batch in met.batches)
        for backwards, way in ((False, 1), (True, -1)):
            which = met.reversed == backwards
            one, other = first.corners[which], second.corners[which, ::way]
            if pieces != others[::way]:
                one, other = one[:, [0, -1]], other[:, [0, -1]]
            gaps |= zip(met.index[which].tolist(), norm(one - other), strict=True)
    return tuple(gaps[i] for i in range(len(seams)))


@dataclass(frozen=True, slots=True)
class _Met:
    """m seams between edges of two batches, the edge of the lower panel first.

    Attributes:
        index: (m,) which seams.
        batches: of the edges.
        rows: (m, 2) the edges' rows there.
        reversed: (m,) whether the two edges run against each other.
    """

    index: IntArray
    batches: tuple[int, int]
    rows: IntArray
    reversed: BoolArray

    def curves(self, edges: PanelEdges) -> tuple[EndCurves, EndCurves]:
        """The edges on both sides."""
        first, second = (edges.curves[batch].take(self.rows[:, side]) for side, batch in enumerate(self.batches))
        return first, second


def _batches(edges: PanelEdges, seams: Sequence[Seam]) -> Iterator[_Met]:
    if not seams:
        return
    panels, on = (np.array([getattr(seam, what) for seam in seams], dtype=np.intp) for what in ("panels", "edges"))
    swapped = panels[:, 0] >= panels[:, 1]
    panels[swapped], on[swapped] = panels[swapped, ::-1], on[swapped, ::-1]
    batch, row = edges.batch[panels, on], edges.row[panels, on]
    backwards = np.array([seam.reversed for seam in seams], dtype=np.bool_)
    pairs, which = np.unique(batch, axis=0, return_inverse=True)
    for pair, (first, second) in enumerate(pairs.tolist()):
        index = np.flatnonzero(which.reshape(-1) == pair)
        yield _Met(index, (first, second), row[index], backwards[index])
