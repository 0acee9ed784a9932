"""Gaps between the conic arcs of neighbours whose ends are alike, between their corners.

A point on one panel's arc is held near the other panel's arc by its distances d1, d2 from the two surfaces whose
intersection that arc is: the cone, and the plane that cuts it. Unlike the distance of corresponding points this leaves
the points free to pass each other along the seam. Either panel's points are held to the other's arc: the order of the
two must not matter.

Where cone and plane meet at a slant a point may be near both and far from their intersection. With c and s the cosine
and sine between their normals its distance from there is that of (d1, (d2 - c d1) / s), to first order: the coordinates
of a point of the plane spanned by two unit vectors, from its products with them. `straighten` measures so. The angle is
that of one state and does not follow the unknowns: it hardly changes while a gap is closed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.layout import Layout
from cadpanel.geometry.vectors import dot
from cadpanel.solver.hold import Hold
from cadpanel.terms.placement import Carrying, Placement
from cadpanel.terms.seams import SeamBatch, arc_patches, arc_places
from cadpanel.terms.state import State, slopes
from cadpanel.terms.term import HeldTerm

# Where the surfaces nearly touch they meet in no arc at all: no smaller sine is taken for their angle.
_LEAST_SINE = 0.1


@dataclass(frozen=True, slots=True)
class _Points:
    """The arc points of the first panel of every seam, then of the second one, and what of the other they are held to.

    Attributes:
        own, other: (2 seams,) the panel that the points belong to, and the other one.
        places: (2 seams, q) the points among the panel's arc points.
        patch: (2 seams, q) the other panel's patches that they meet.
        end: (2 seams,) the other panel's end.
        carrying: from the points' panel to the other one.
    """

    own: IntArray
    other: IntArray
    places: IntArray
    patch: IntArray
    end: IntArray
    carrying: Carrying


class ArcGap(HeldTerm):
    """Holds the conic arcs of neighbours within the tolerance of each other."""

    def __init__(self, seams: SeamBatch, place: Placement, layout: Layout, *, tolerance: float) -> None:
        """Hold the arcs of a batch of curved edges that are alike within `tolerance`, in the solver's length."""
        self.seams, self.place = seams, place
        self.blocks, self.pair, self.panels = seams.blocks, seams.pair, len(place.origins)
        own, other = (np.concatenate([seams.panels[:, side] for side in sides]) for sides in ((0, 1), (1, 0)))
        self._points = _Points(
            own=own,
            other=other,
            places=np.concatenate([arc_places(layout, seams, side) for side in (0, 1)]),
            patch=np.concatenate([self._patches(side) for side in (0, 1)]),
            end=np.concatenate([seams.edges[:, 1 - side] for side in (0, 1)]),
            carrying=place.carrying(own, other),
        )
        self._metric: Array | None = None
        points = 2 * self._points.places.shape[1]
        self.hold = Hold(np.full((len(seams.panels), points), tolerance), weight=1.0, gives_way=True)

    def _patches(self, side: int) -> IntArray:
        seams = self.seams
        patch = np.tile(arc_patches(seams.curved[side]), (len(seams.panels), 1))
        return np.where(seams.reversed[:, None], len(seams.curved[side]) - 1 - patch, patch)

    def vectors(self, state: State) -> Array:
        """(seams, points, 2) distances from the other panel's cone and cut plane, or from where these two meet."""
        return self._told(np.concatenate(_halves(self._distances(state)[0]), axis=1))

    def straighten(self, state: State) -> None:
        """From now on measure from where cone and cut plane meet, by the angles that they have in this state."""
        of, (_, _, inner) = self._points, self._distances(state)
        cosine = np.concatenate(_halves(dot(-inner[..., 3:6], state.cuts.m[of.other, of.end][:, None])), axis=1)
        sine = np.sqrt(np.maximum(1.0 - cosine**2, _LEAST_SINE**2))
        self._metric = np.zeros((*cosine.shape, 2, 2))
        self._metric[..., 0, 0] = 1.0
        self._metric[..., 1, 0], self._metric[..., 1, 1] = -cosine / sine, 1.0 / sine

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        distances, by_own, by_other = (_halves(part) for part in self._linearized(state))
        told = (distances, (by_own[0], by_other[1]), (by_other[0], by_own[1]))
        vectors, to_first, to_second = (self._told(np.concatenate(parts, axis=1)) for parts in told)
        return vectors, (to_first, to_second)

    def _told(self, distances: Array) -> Array:
        """Distances (seams, q, 2), or their derivatives (seams, q, 2, unknowns), as they are measured."""
        if self._metric is None:
            return distances
        if distances.ndim == self._metric.ndim:
            return self._metric @ distances
        return (self._metric @ distances[..., None])[..., 0]

    def _distances(self, state: State) -> tuple[Array, Array, Array]:
        """Distances (2 seams, q, 2), the points (2 seams, q, 3) in the other panels' frames, the cones' inner rates."""
        of = self._points
        points = of.carrying.points(state.arcs.position[of.own[:, None], of.places])
        from_cone, inner = state.surfaces.distance_inner(points, of.other, of.patch, cones=True)
        m, s = state.cuts.m[of.other, of.end], state.cuts.s[of.other, of.end]
        from_cut = dot(points, m[:, None]) - s[:, None]
        return np.stack([from_cone, from_cut], axis=-1), points, inner

    def _linearized(self, state: State) -> tuple[Array, Array, Array]:
        """Distances, and their derivatives (2 seams, q, 2, size) by the points' panels and by the other panels."""
        of, (distances, points, inner) = self._points, self._distances(state)
        outer, dm, ds = state.surfaces.outer, state.cuts.dm, state.cuts.ds
        if outer is None or dm is None or ds is None:
            raise ValueError("the state was walked without derivatives")
        m = state.cuts.m[of.other, of.end]
        # How the distances follow the point itself: the cone's normal, and the cut plane's.
        gradients = np.stack([-inner[..., 3:6], np.broadcast_to(m[:, None], points.shape)], axis=2)
        by_own = of.carrying.slopes(gradients, slopes(state.arcs)[of.own[:, None], of.places])
        places = state.surfaces.places(of.other, of.patch)
        by_cone = (inner[..., None, :] @ np.take(outer.reshape(-1, *outer.shape[2:]), places, axis=0))[..., 0, :]
        by_cut = points @ dm[of.other, of.end] - ds[of.other, of.end][:, None]
        return distances, by_own, np.stack([by_cone, by_cut], axis=2)


def _halves(values: Array) -> tuple[Array, Array]:
    """What belongs to the first panels' points (seams, ...), and to the second ones', of (2 seams, ...)."""
    seams = len(values) // 2
    return values[:seams], values[seams:]
