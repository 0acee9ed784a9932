"""How far apart and at which angle fitted panels meet; millimetres and radians."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.geometry.end_curves import EndCurves, seam_gap
from cadpanel.geometry.seam_frames import SHIFT, seam_frames
from cadpanel.geometry.vectors import dot, norm, unit
from cadpanel.reference.model import Seam


@dataclass(frozen=True, slots=True, kw_only=True)
class AlongSeams:
    """What is largest along each whole seam.

    Attributes:
        gap: (seams,) symmetric Hausdorff distance between the two edges, mm.
        width: (seams,) of the gap the part in the skins' mean tangent plane and square to the seam, mm.
        step: (seams,) the part along the skins' mean normal, which people see and feel, mm.
        shift: (seams,) the part along the seam at its outermost corners, mm.
        kink: (seams,) radians.
    """

    gap: Array
    width: Array
    step: Array
    shift: Array
    kink: Array


def along_seams(edges: PanelEdges, seams: Sequence[Seam]) -> AlongSeams:
    """How panels whose edges are known meet along whole seams."""
    gap, width, step, shift, kink = np.zeros((5, len(seams)))
    for met in met_seams(edges, seams):
        first, second = met.curves(edges)
        found = seam_gap(first, second)
        gap[met.index], kink[met.index], width[met.index], step[met.index] = found
        for backwards, way in ((False, 1), (True, -1)):
            rows = np.flatnonzero(met.reversed == backwards)
            shift[met.index[rows]] = _shifts(first.take(rows), second.take(rows), way)
    return AlongSeams(gap=gap, width=width, step=step, shift=shift, kink=kink)


def _shifts(first: EndCurves, second: EndCurves, way: int) -> Array:
    """(m,) how far the outermost corners lie apart along the seam; the second curves run `way` (1 or -1) along it.

    Those between them are where patches of one panel meet without a kink: whether they are in line nobody sees.
    """
    one, other = first.corners, second.corners[:, ::way]
    ends, others = one[:, [0, -1]], other[:, [0, -1]]
    tangents = unit(one[:, [1, -1]] - one[:, [0, -2]]) + unit(other[:, [1, -1]] - other[:, [0, -2]])
    frames = seam_frames(tangents, first.n[:, [0, -1]] + second.n[:, ::way][:, [0, -1]])
    return np.asarray(np.abs(dot(ends - others, frames[:, :, SHIFT])).max(axis=1))


def corner_gaps(edges: PanelEdges, seams: Sequence[Seam]) -> tuple[Array, ...]:
    """For each seam the gaps (corners,) at the corners that meet, in the order of its first panel, mm.

    All corners meet where both edges have the same pieces, else only the two outermost.
    """
    gaps: dict[int, Array] = {}
    for met in met_seams(edges, seams):
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
class Met:
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


def met_seams(edges: PanelEdges, seams: Sequence[Seam]) -> Iterator[Met]:
    """All seams, those between edges of like batches together."""
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
        yield Met(index, (first, second), row[index], backwards[index])
