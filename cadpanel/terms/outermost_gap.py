"""Gaps between the outermost corners of neighbours, and the directions of the seams there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Layout
from cadpanel.geometry.seam_frames import seam_frames
from cadpanel.geometry.vectors import unit
from cadpanel.terms.corner_gap import CornerGap
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import SeamBatch
from cadpanel.terms.state import State


class OutermostGap(CornerGap):
    """Holds both ends of seams: between them patches of a panel meet without a kink, and need not be in line.

    Attributes:
        parts: how many parts its vectors have: width, step and shift.
    """

    parts = 3

    def __init__(self, seams: SeamBatch, place: Placement, layout: Layout, *, tolerance: float) -> None:
        """Hold the outermost corners that meet within `tolerance`, in units of the solver's length."""
        super().__init__(replace(seams, corners=seams.corners[:, :, [0, -1]]), place, tolerance=tolerance)
        features = layout.feature_of
        beside = np.zeros((len(seams.index), 2, 2), dtype=np.intp)
        for seam, (panels, edges) in enumerate(zip(seams.panels.tolist(), seams.edges.tolist(), strict=True)):
            for side, (panel, edge) in enumerate(zip(panels, edges, strict=True)):
                corners = features[panel].edges[edge].corners
                beside[seam, side] = corners[1], corners[-2]
        beside[seams.reversed, 1] = beside[seams.reversed, 1, ::-1]
        self._beside = beside

    def frames(self, state: State) -> Array:
        """(seams, 2, parts, 3) the directions of the gap's parts.

        An edge begins along a straight piece, or along an arc, which bends out of the skin's tangent plane only. At
        either end the seam is seen from there inwards.
        """
        normals, tangents = [], []
        for side in (0, 1):
            panels, corners = self.seams.panels[:, side], self.seams.corners[:, side]
            axes = np.swapaxes(self.place.axes[panels], 1, 2)
            at = state.corners.position[panels[:, None]]
            rows = np.arange(len(panels))[:, None]
            inwards = at[rows, 0, self._beside[:, side]] - at[rows, 0, corners]
            tangents.append(unit(inwards) @ axes)
            normals.append(state.normals.position[panels[:, None], corners] @ axes)
        return seam_frames(np.sum(tangents, axis=0), np.sum(normals, axis=0))
