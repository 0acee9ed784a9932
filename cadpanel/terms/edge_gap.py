"""Gaps between edges that are not alike: the curved end of one panel against a straight edge, or another chain's end.

Only their outermost corners correspond. In between, points of either edge are held to the other: to a straight edge by
their vector from its line; to an end by their distances from the skin and from the plane that cuts it, each point to
the patch that its foot falls on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.layout import Layout
from cadpanel.geometry.seam_frames import seam_frames, tangents_at
from cadpanel.geometry.vectors import dot
from cadpanel.solver.hold import Hold
from cadpanel.terms.placement import Carrying, Placement
from cadpanel.terms.seams import Movers, SeamBatch, movers
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm


@dataclass(frozen=True, slots=True)
class _Held:
    """Vectors that are held, and how they follow the unknowns of the panel that moves and of the other one.

    Attributes:
        vectors: (s, q, 3).
        by_mover, by_other: (s, q, 3, size), None without derivatives.
    """

    vectors: Array
    by_mover: Array | None
    by_other: Array | None

    def cut(self, seams: slice, points: int) -> _Held:
        """Some seams, and so many of their points."""
        by_mover, by_other = (None if part is None else part[seams, :points] for part in (self.by_mover, self.by_other))
        return _Held(self.vectors[seams, :points], by_mover, by_other)


@dataclass(frozen=True, slots=True)
class _Side:
    """The points of one panel of every seam, and what of the other panel they are held to.

    Attributes:
        own, other: (s,) the panel that the points belong to, and the other one.
        end: (s,) the other panel's edge.
        corners: (s, m) its corners that meet others; of a straight one where it begins and ends.
        straight: whether it is straight.
        places: see `terms.seams.Movers`.
        share: (q,) see there; None where every point is the first of both.
        carrying: from the points' panel to the other one.
    """

    own: IntArray
    other: IntArray
    end: IntArray
    corners: IntArray
    straight: bool
    places: IntArray
    share: Array | None
    carrying: Carrying

    def taken(self, values: Array) -> Array:
        """(s, q, ...) of values (panels, boundary points, ...), at the points that are held."""
        own = self.own[:, None]
        if self.share is None:
            return np.asarray(values[own, self.places[..., 0]])
        share = self.share.reshape(-1, *(1,) * (values.ndim - 2))
        first, second = (values[own, self.places[..., end]] for end in (0, 1))
        return np.asarray((1.0 - share) * first + share * second)

    def with_other(self, second: _Side) -> _Side:
        """These seams, and after them those of another side that is held to curved edges as well.

        The side with fewer points has its last one more than once.
        """
        most = max(self.places.shape[1], second.places.shape[1])
        filled = [one.places[:, np.minimum(np.arange(most), one.places.shape[1] - 1)] for one in (self, second)]
        return _Side(
            own=np.concatenate([self.own, second.own]),
            other=np.concatenate([self.other, second.other]),
            end=np.concatenate([self.end, second.end]),
            corners=np.concatenate([self.corners, second.corners]),
            straight=False,
            places=np.concatenate(filled),
            share=None,
            carrying=self.carrying.after(second.carrying),
        )


class MixedGap(HeldTerm):
    """Holds edges that are not alike within the tolerance of each other.

    Attributes:
        parts: how many parts its vectors have: width and step.
    """

    parts = 2

    def __init__(self, seams: SeamBatch, place: Placement, layout: Layout, *, tolerance: float) -> None:
        """Hold the edges of a batch within `tolerance`, in units of the solver's length."""
        self.seams, self.place = seams, place
        self.blocks, self.pair, self.panels = seams.blocks, seams.pair, len(place.origins)
        self._movers: tuple[Movers, Movers] = (movers(layout, seams, 0), movers(layout, seams, 1))
        first, second = self._side(0), self._side(1)
        self._sides = (first, second)
        self._both_curved = None if first.straight or second.straight else first.with_other(second)
        points = sum(one.places.shape[1] for one in self._movers)
        self.hold = Hold(np.full((len(seams.panels), points), tolerance), weight=1.0, gives_way=True)

    def vectors(self, state: State) -> Array:
        """(seams, points, 3) from the other panel's edge."""
        return np.concatenate([held.vectors for held in self._both(state, derivatives=False)], axis=1)

    def frames(self, state: State) -> Array:
        """(seams, points, parts, 3) directions of the gap's parts, in the frame of the panel that is measured to."""
        found = []
        for side in (0, 1):
            points = self._movers[side].places.shape[1]
            frames = np.tile([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], (len(self.seams.panels), points, 1, 1))
            if self.seams.straight(1 - side):
                other, corners = self.seams.panels[:, 1 - side, None], self.seams.corners[:, 1 - side]
                tangents = tangents_at(state.corners.position[other, corners])
                of_ends = seam_frames(tangents, state.normals.position[other, corners])
                frames[:] = of_ends[:, :1, : self.parts]
            found.append(frames)
        return np.concatenate(found, axis=1)

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        first, second = self._both(state, derivatives=True)
        jacobians = []
        for parts in ((first.by_mover, second.by_other), (first.by_other, second.by_mover)):
            jacobians.append(np.concatenate([part for part in parts if part is not None], axis=1))
        return np.concatenate([first.vectors, second.vectors], axis=1), tuple(jacobians)

    def _side(self, side: int) -> _Side:
        moving, seams = self._movers[side], self.seams
        return _Side(
            own=seams.panels[:, side],
            other=seams.panels[:, 1 - side],
            end=seams.edges[:, 1 - side],
            corners=seams.corners[:, 1 - side],
            straight=seams.straight(1 - side),
            places=moving.places,
            share=moving.share if moving.share.any() else None,
            carrying=self.place.carrying(seams.panels[:, side], seams.panels[:, 1 - side]),
        )

    def _both(self, state: State, *, derivatives: bool) -> tuple[_Held, _Held]:
        """What the points of the first panels, and of the second, are held by."""
        first, second = self._sides
        if self._both_curved is None:
            return (
                self._held(state, first, derivatives=derivatives),
                self._held(state, second, derivatives=derivatives),
            )
        # Both at once: the arrays are small, and most of the time goes to calls.
        held = self._held(state, self._both_curved, derivatives=derivatives)
        seams = len(first.own)
        return held.cut(slice(seams), first.places.shape[1]), held.cut(slice(seams, None), second.places.shape[1])

    def _held(self, state: State, side: _Side, *, derivatives: bool) -> _Held:
        points = side.carrying.points(side.taken(state.boundary.position))
        moved = side.taken(slopes(state.boundary)) if derivatives else None
        return _from_line(state, side, points, moved) if side.straight else _from_end(state, side, points, moved)


def _from_line(state: State, side: _Side, points: Array, moved: Array | None) -> _Held:
    """From the line through two corners: r = x - c - s e with s = (x - c) . e / e . e and e between the corners."""
    other, corners = side.other[:, None], side.corners
    at = state.corners.position[other, corners]
    e = (at[:, 1] - at[:, 0])[:, None]
    square = dot(e, e)
    s = (dot(points - at[:, :1], e) / square)[..., None]
    r = points - at[:, :1] - s * e
    if moved is None:
        return _Held(r, None, None)
    rates = slopes(state.corners)[other, corners]
    de = (rates[:, 1] - rates[:, 0])[:, None]
    # r stays square to e: what lies along e of its change makes up for the turning of e.
    by_other = -(rates[:, :1] + s[..., None] * de)
    away = (e[..., None, :] @ by_other)[..., 0, :]
    turned = (r[..., None, :] @ de)[..., 0, :]
    by_other -= e[..., None] * ((away + turned) / square[..., None])[..., None, :]
    across = np.eye(3) - e[..., :, None] * e[..., None, :] / square[..., None, None]
    return _Held(r, side.carrying.slopes(across, moved), by_other)


def _from_end(state: State, side: _Side, points: Array, moved: Array | None) -> _Held:
    """From the skin, and from the cut plane; the third number is 0."""
    other, end = side.other, side.end
    surfaces, cuts = state.surfaces, state.cuts
    patch = surfaces.assign(points, other)
    m = cuts.m[other, end]
    vectors = np.zeros(points.shape)
    vectors[..., 1] = dot(points, m[:, None]) - cuts.s[other, end][:, None]
    if moved is None:
        vectors[..., 0] = surfaces.distance(points, other, patch)
        return _Held(vectors, None, None)
    vectors[..., 0], inner = surfaces.distance_inner(points, other, patch)
    if surfaces.outer is None or cuts.dm is None or cuts.ds is None:
        raise ValueError("the state was walked without derivatives")
    gradients = np.zeros((*points.shape[:2], 3, 3))
    gradients[:, :, 0] = -inner[..., 3:6]
    gradients[:, :, 1] = m[:, None]
    by_other = np.zeros((*points.shape[:2], 3, surfaces.outer.shape[-1]))
    by_other[:, :, 0] = (inner[..., None, :] @ surfaces.outer[other[:, None], patch])[..., 0, :]
    by_other[:, :, 1] = points @ cuts.dm[other, end] - cuts.ds[other, end][:, None]
    return _Held(vectors, side.carrying.slopes(gradients, moved), by_other)
