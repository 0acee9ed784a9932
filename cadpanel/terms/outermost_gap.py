"""Gaps between the outermost corners of neighbours, and the directions of the seams there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.layout import Layout
from cadpanel.geometry.seam_frames import seam_frames
from cadpanel.geometry.vectors import unit
from cadpanel.terms.corner_gap import CornerGap
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import SeamBatch
from cadpanel.terms.state import State, slopes


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

    def seen(self, state: State, parts: Sequence[int], scale: Array) -> SeenEnds:
        """Some of the gap's parts.

        Args:
            state: where seams run.
            parts: which, see `geometry.seam_frames`.
            scale: (seams, parts) by which their lengths are multiplied.
        """
        frames = scale[:, None, :, None] * self.frames(state)[:, :, list(parts)]
        (first, second), place = self.seams.blocks, self.place
        apart = (place.origins[first] - place.origins[second])[:, None, :, None] / place.length
        return SeenEnds(
            self.seams,
            first=frames @ place.axes[first][:, None],
            second=-(frames @ place.axes[second][:, None]),
            apart=(frames @ apart)[..., 0],
        )


@dataclass(frozen=True, slots=True)
class SeenEnds:
    """The parts of gaps that are asked for, as seams run in one state.

    Attributes:
        seams: whose.
        first, second: (seams, 2, parts, 3) rows that take the parts from the corners of the first panels and of the
            second ones, in the panels' own frames.
        apart: (seams, 2, parts) what the frames' origins add.
    """

    seams: SeamBatch
    first: Array
    second: Array
    apart: Array

    def vectors(self, state: State) -> Array:
        """(seams, 2, parts)."""
        first, second = (self._taken(state.corners.position, side)[..., None] for side in (0, 1))
        return np.asarray(self.apart + (self.first @ first + self.second @ second)[..., 0])

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """The same, and how they follow the unknowns; see `HeldTerm.linear`."""
        rates = slopes(state.corners)
        return self.vectors(state), (self.first @ self._taken(rates, 0), self.second @ self._taken(rates, 1))

    def _taken(self, values: Array, side: int) -> Array:
        """(seams, 2, ...) of values (panels, corners, ...)."""
        return np.asarray(values[self.seams.panels[:, side, None], self.seams.corners[:, side]])
