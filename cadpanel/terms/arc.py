"""Gaps between the conic arcs of neighbours, between their corners.

A point on the first panel's arc is held near the second panel's arc by its distances from the two surfaces whose
intersection that arc is: the cone, and the plane that cuts it. Unlike the distance of corresponding points this leaves
the points free to pass each other along the seam.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.walk import ARC_SHARES, cut_planes
from cadpanel.geometry.cone import cone_distance_inner
from cadpanel.geometry.frames import dot
from cadpanel.solver.blocks import Normal
from cadpanel.solver.hold import Hold
from cadpanel.terms.deviation import patch_outer
from cadpanel.terms.gap import Placement, Seams
from cadpanel.terms.rows import Rows, add_rows, booked_cost
from cadpanel.terms.state import State

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class _Meeting:
    """The arcs of one curved patch of every seam's first panel, seen from the second panel.

    Attributes:
        points: (seams, shares, 3) in the second panel's own frame.
        own: indices of the points among the first panel's arc points.
        patch: (seams,) which patch of the second panel they meet.
    """

    points: Array
    own: slice
    patch: IntArray


class ArcGap:
    """Holds the conic arcs of neighbours within the tolerance of each other."""

    def __init__(self, seams: Seams, place: Placement, *, curved: tuple[int, ...], tolerance: float) -> None:
        """Hold the arcs of the patches `curved` within `tolerance`, in units of the solver's length."""
        self.seams, self.place, self.curved = seams, place, curved
        points = len(ARC_SHARES) * len(curved)
        self.hold = Hold(np.full((len(seams.panels), points), tolerance), weight=1.0, least=1e-9)

    def vectors(self, state: State) -> Array:
        """(seams, points, 2) distances from the second panel's cone and from its cut plane."""
        meetings = self._meetings(state)
        return np.concatenate([self._distances(state, meeting)[0] for meeting in meetings], axis=1)

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        residual = self.hold.roots()[..., None] * self.vectors(state)
        return booked_cost(residual, self.seams.panels[:, 0], len(self.place.origins))

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        groups, free = len(self.seams.panels), state.walked.feature.free
        if not groups:
            return []
        distances, to_first, to_second = (
            np.concatenate(parts, axis=1)
            for parts in zip(*(self._distances(state, meeting) for meeting in self._meetings(state)), strict=True)
        )
        roots = self.hold.roots()[..., None]
        jacobians = tuple(
            (roots[..., None] * part[..., free]).reshape(groups, distances[0].size, len(free))
            for part in (to_first, to_second)
        )
        panels = (self.seams.panels[:, 0], self.seams.panels[:, 1])
        return [Rows((roots * distances).reshape(groups, -1), panels, jacobians, self.seams.pair)]

    def add_to(self, normal: Normal, state: State) -> Array:
        """See `Term.add_to`."""
        return add_rows(self.rows(state), normal, len(self.place.origins))

    def _meetings(self, state: State) -> list[_Meeting]:
        first, second = self.seams.panels.T
        world = self.place.to_world(state.arcs.position[first, self.seams.ends[:, 0]], first)
        local = (world - self.place.origins[second, None] / self.place.length) @ self.place.axes[second]
        shares, meetings = len(ARC_SHARES), []
        for i, patch in enumerate(self.curved):
            own = slice(i * shares, (i + 1) * shares)
            mirrored = len(state.walked.feature.patches) - 1 - patch
            meetings.append(_Meeting(local[:, own], own, np.where(self.seams.reversed, mirrored, patch)))
        return meetings

    def _distances(self, state: State, meeting: _Meeting) -> tuple[Array, Array, Array]:
        """(seams, shares, 2) distances, and their derivatives (seams, shares, 2, N) by both panels' numbers."""
        walked, second = state.walked, self.seams.panels[:, 1]
        x = np.moveaxis(meeting.points, 2, 0)
        starts = np.array([walked.feature.patch_slice(i).start for i in range(len(walked.feature.patches))])
        start = starts[meeting.patch]
        carriers = walked.carriers
        p, t, n = (values[second, meeting.patch] for values in (carriers.p, carriers.t, carriers.n))
        radius, half_angle = walked.values[second, start], walked.values[second, start + 1]
        from_cone, inner = cone_distance_inner(x, p, t, n, radius, half_angle)
        from_cut, unit, scale = self._from_cut(state, meeting)
        distances = np.stack([from_cone, from_cut], axis=-1)
        if carriers.twist is None:
            return distances, np.empty(0), np.empty(0)
        # How the distances follow the point itself: the cone's normal, and the cut plane's.
        gradients = np.stack([-inner[..., 3:6], np.broadcast_to(unit[:, None], meeting.points.shape)], axis=2)
        by_second = np.zeros((*distances.shape, walked.values.shape[1]))
        outer = patch_outer(walked, second, meeting.patch, start)
        by_second[:, :, 0] = inner @ outer
        for end in (0, 1):
            here = self.seams.ends[:, 1] == end
            at = walked.feature.cut_slice(end).start
            by_second[here, :, 1, at] = -1.0 / scale[here, None]
            for number, axis in ((at + 1, 0), (at + 2, 2)):
                change = meeting.points[here][..., axis] / scale[here, None]
                change -= from_cut[here] * (unit[here, axis] / scale[here])[:, None]
                by_second[here, :, 1, number] = change
        return distances, gradients @ self._moved(state, meeting), by_second

    def _from_cut(self, state: State, meeting: _Meeting) -> tuple[Array, Array, Array]:
        m, s = (values[self.seams.panels[:, 1], self.seams.ends[:, 1]] for values in cut_planes(state.walked))
        scale = np.sqrt(dot(m, m))
        unit = m / scale[:, None]
        return dot(meeting.points, unit[:, None]) - (s / scale)[:, None], unit, scale

    def _moved(self, state: State, meeting: _Meeting) -> Array:
        """(seams, shares, 3, N) how the first panels' points move, in the second panels' frames."""
        if state.arcs.jacobian is None:
            raise ValueError("the state was walked without derivatives")
        first, second = self.seams.panels.T
        turn = np.swapaxes(self.place.axes[second], 1, 2) @ self.place.axes[first]
        moved: Array = turn[:, None] @ state.arcs.jacobian[first, self.seams.ends[:, 0]][:, meeting.own]
        return moved
