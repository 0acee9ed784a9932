"""Gaps between the conic arcs of neighbours, between their corners.

A point on one panel's arc is held near the other panel's arc by its distances from the two surfaces whose intersection
that arc is: the cone, and the plane that cuts it. Unlike the distance of corresponding points this leaves the points
free to pass each other along the seam. Either panel's points are held to the other's arc: the order of the two must not
matter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.walk import ARC_SHARES, cut_planes
from cadpanel.geometry.cone import cone_distance, cone_distance_inner
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
    """One curved patch of one panel of every seam, seen from the other panel, which it is held to.

    Attributes:
        mover: 0 where the points are those of the seams' first panels, 1 where they are the second panels'.
        points: (seams, shares, 3) in the other panel's own frame.
        own: indices of the points among the mover's arc points.
        patch: (seams,) which patch of the other panel they meet.
    """

    mover: int
    points: Array
    own: slice
    patch: IntArray


class ArcGap:
    """Holds the conic arcs of neighbours within the tolerance of each other."""

    def __init__(self, seams: Seams, place: Placement, *, curved: tuple[int, ...], tolerance: float) -> None:
        """Hold the arcs of the patches `curved` within `tolerance`, in units of the solver's length."""
        self.seams, self.place, self.curved = seams, place, curved
        points = 2 * len(ARC_SHARES) * len(curved)
        self.hold = Hold(np.full((len(seams.panels), points), tolerance), weight=1.0, least=1e-9)

    def vectors(self, state: State) -> Array:
        """(seams, points, 2) distances from the other panel's cone and from its cut plane."""
        distances = []
        for meeting in self._meetings(state):
            from_cone = cone_distance(np.moveaxis(meeting.points, 2, 0), *self._cone(state, meeting))
            distances.append(np.stack([from_cone, self._from_cut(state, meeting)[0]], axis=-1))
        return np.concatenate(distances, axis=1)

    def cost(self, state: State) -> Array:
        """See `Term.cost`."""
        residual = self.hold.roots()[..., None] * self.vectors(state)
        return booked_cost(residual, tuple(self.seams.panels.T), len(self.place.origins))

    def rows(self, state: State) -> list[Rows]:
        """See `Term.rows`."""
        groups, free = len(self.seams.panels), state.walked.feature.free
        if not groups:
            return []
        distances, to_first, to_second = (
            np.concatenate(parts, axis=1)
            for parts in zip(*(self._linearized(state, meeting) for meeting in self._meetings(state)), strict=True)
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
        shares, meetings = len(ARC_SHARES), []
        for mover in (0, 1):
            own, other = self.seams.panels[:, mover], self.seams.panels[:, 1 - mover]
            world = self.place.to_world(state.arcs.position[own, self.seams.ends[:, mover]], own)
            local = (world - self.place.origins[other, None] / self.place.length) @ self.place.axes[other]
            for i, patch in enumerate(self.curved):
                part = slice(i * shares, (i + 1) * shares)
                mirrored = len(state.walked.feature.patches) - 1 - patch
                meetings.append(_Meeting(mover, local[:, part], part, np.where(self.seams.reversed, mirrored, patch)))
        return meetings

    def _cone(self, state: State, meeting: _Meeting) -> tuple[Array, Array, Array, Array, Array]:
        """Ruling (p, t, n), radius and half angle of the cones that the points are held to."""
        walked, other = state.walked, self.seams.panels[:, 1 - meeting.mover]
        p, t, n = (getattr(walked.carriers, axis)[other, meeting.patch] for axis in "ptn")
        start = self._starts(state)[meeting.patch]
        return p, t, n, walked.values[other, start], walked.values[other, start + 1]

    def _starts(self, state: State) -> IntArray:
        """(patches,) where the numbers of each patch begin."""
        feature = state.walked.feature
        return np.array([feature.patch_slice(i).start for i in range(len(feature.patches))])

    def _from_cut(self, state: State, meeting: _Meeting) -> tuple[Array, Array, Array]:
        other = 1 - meeting.mover
        m, s = (values[self.seams.panels[:, other], self.seams.ends[:, other]] for values in cut_planes(state.walked))
        scale = np.sqrt(dot(m, m))
        unit = m / scale[:, None]
        return dot(meeting.points, unit[:, None]) - (s / scale)[:, None], unit, scale

    def _linearized(self, state: State, meeting: _Meeting) -> tuple[Array, Array, Array]:
        """(seams, shares, 2) distances, and their derivatives (seams, shares, 2, N) by both panels' numbers."""
        walked, other = state.walked, self.seams.panels[:, 1 - meeting.mover]
        from_cone, inner = cone_distance_inner(np.moveaxis(meeting.points, 2, 0), *self._cone(state, meeting))
        from_cut, unit, scale = self._from_cut(state, meeting)
        distances = np.stack([from_cone, from_cut], axis=-1)
        # How the distances follow the point itself: the cone's normal, and the cut plane's.
        gradients = np.stack([-inner[..., 3:6], np.broadcast_to(unit[:, None], meeting.points.shape)], axis=2)
        by_mover = gradients @ self._moved(state, meeting)
        by_other = np.zeros((*distances.shape, walked.values.shape[1]))
        by_other[:, :, 0] = inner @ patch_outer(walked, other, meeting.patch, self._starts(state)[meeting.patch])
        for end in (0, 1):
            here = self.seams.ends[:, 1 - meeting.mover] == end
            at = walked.feature.cut_slice(end).start
            by_other[here, :, 1, at] = -1.0 / scale[here, None]
            for number, axis in ((at + 1, 0), (at + 2, 2)):
                change = meeting.points[here][..., axis] / scale[here, None]
                change -= from_cut[here] * (unit[here, axis] / scale[here])[:, None]
                by_other[here, :, 1, number] = change
        return (distances, by_mover, by_other) if meeting.mover == 0 else (distances, by_other, by_mover)

    def _moved(self, state: State, meeting: _Meeting) -> Array:
        """(seams, shares, 3, N) how the points move, in the other panels' frames."""
        if state.arcs.jacobian is None:
            raise ValueError("the state was walked without derivatives")
        own, other = self.seams.panels[:, meeting.mover], self.seams.panels[:, 1 - meeting.mover]
        turn = np.swapaxes(self.place.axes[other], 1, 2) @ self.place.axes[own]
        moved: Array = turn[:, None] @ state.arcs.jacobian[own, self.seams.ends[:, meeting.mover]][:, meeting.own]
        return moved
