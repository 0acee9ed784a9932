"""Which corners of two panels follow one another across the seam between them, edge on edge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.vectors import dot, unit
from cadpanel.reference.model import PanelReference, Seam

# The outer corners of a panel with four sides are counted end by end; those of each edge, and those across from them.
_ON = np.array([[0, 1], [2, 3], [0, 2], [1, 3]])
_ACROSS = np.array([[2, 3], [0, 1], [1, 3], [0, 2]])


@dataclass(frozen=True, slots=True, kw_only=True)
class AcrossSeams:
    """Seams between two panels with four sides each, and the lines that go on across them.

    Attributes:
        index: (s,) which seams.
        panels: (s, 2), the lower first.
        on, across: (s, 2, 2) outer corners (0 to 3, end by end) of each of the two panels: on the seam, and at the
            other end of the line that runs to each of them.
        normals: (s, 2, 3) unit normals of the drawing at the two corners on the seam, the mean of both panels'.
    """

    index: IntArray
    panels: IntArray
    on: IntArray
    across: IntArray
    normals: Array


def across_seams(panels: Sequence[PanelReference], seams: Sequence[Seam]) -> AcrossSeams:
    """The seams whose panels both have ends and sides."""
    sided = [i for i, seam in enumerate(seams) if all(panels[p].four_sided for p in seam.panels)]
    table = np.array([(*seams[i].panels, *seams[i].edges, seams[i].reversed) for i in sided], dtype=np.intp)
    table = table.reshape(-1, 5)
    swapped = table[:, 0] > table[:, 1]
    table[swapped, :4] = table[swapped][:, [1, 0, 3, 2]]
    which, edges = table[:, :2], table[:, 2:4]
    backwards = table[:, 4] > 0
    first, second = (
        np.array(
            [panels[p].edge_normals[e][[0, -1]] for p, e in zip(which[:, side], edges[:, side], strict=True)]
        ).reshape(-1, 2, 3)
        for side in (0, 1)
    )
    normals = unit(first + np.where(backwards[:, None, None], second[:, ::-1], second))
    return across_edges(np.array(sided, dtype=np.intp), which, edges, backwards, normals)


def across_edges(
    index: IntArray, panels: IntArray, edges: IntArray, backwards: BoolArray, normals: Array
) -> AcrossSeams:
    """The same from arrays: which seams, their panels and edges (s, 2), whether the edges run against each other."""
    on, across = _ON[edges], _ACROSS[edges]
    for corners in (on, across):
        corners[backwards, 1] = corners[backwards, 1, ::-1]
    return AcrossSeams(index=index, panels=panels, on=on, across=across, normals=normals)


def unevenness(drift: Array, seams: AcrossSeams) -> Array:
    """(s, 2) how far the corners on seams lie off the middle between those before and after them, against the drawing.

    Half the second difference of the drifts along the two lines that go on across a seam, as far as it lies in the
    skin: of panels that all drift alike, or more and more evenly, it is nothing.

    Args:
        drift: (panels, 4, 3) of the outer corners of all panels from the drawing's, mm.
        seams: which.
    """
    panels = seams.panels[:, :, None]
    off = 0.5 * (drift[panels, seams.on] - drift[panels, seams.across]).sum(axis=1)
    off = off - dot(off, seams.normals)[..., None] * seams.normals
    sizes: Array = np.sqrt(dot(off, off))
    return sizes
