"""Gaps between edges that are not alike: the curved end of one panel against a straight edge, or another chain's end.

Only their outermost corners correspond. In between, points of either edge are held to the other: to a straight edge by
their vector from its line; to an end by their distances from the skin and from the plane that cuts it, each point to
the patch that its foot falls on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.layout import Layout
from cadpanel.geometry.seam_frames import STEP, WIDTH, seam_frames, tangents_at
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
class _View:
    """In what order, and how long, the numbers of vectors stand for one side of all seams.

    Attributes:
        skin, cut: which number is the distance from an end's skin, and which one that from its cut plane; None if it is
            not asked for.
        scale: (s, 1, count) of an end's, count being how many numbers there are.
        frames: (s, q, count, 3) the directions in which vectors from a line are told, None for all three as they are.
    """

    skin: int | None
    cut: int | None
    scale: Array
    frames: Array | None

    @property
    def count(self) -> int:
        """How many numbers there are."""
        return int(self.scale.shape[2])


_PLAIN = _View(skin=0, cut=1, scale=np.ones((1, 1, 3)), frames=None)


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
            places = own * values.shape[1] + self.places[..., 0]
            taken: Array = np.take(values.reshape(-1, *values.shape[2:]), places, axis=0)
            return taken
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

    def vectors(self, state: State, seen: SeenParts | None = None) -> Array:
        """(seams, points, 3) from the other panel's edge, or (seams, points, parts) the parts that are seen of them."""
        return np.concatenate([held.vectors for held in self._both(state, seen, derivatives=False)], axis=1)

    def seen(self, state: State, parts: Sequence[int], scale: Array) -> SeenParts:
        """Some of the gap's parts, in the frames of the panels that are measured to.

        Args:
            state: where seams run.
            parts: which, see `geometry.seam_frames`.
            scale: (seams, parts) by which their lengths are multiplied.
        """
        step, width = (parts.index(part) if part in parts else None for part in (STEP, WIDTH))
        sides = []
        for side in (0, 1):
            frames = None
            if self.seams.straight(1 - side):
                other, corners = self.seams.panels[:, 1 - side, None], self.seams.corners[:, 1 - side]
                tangents = tangents_at(state.corners.position[other, corners])
                of_ends = seam_frames(tangents, state.normals.position[other, corners])
                frames = scale[:, None, :, None] * of_ends[:, :1, list(parts)]
            sides.append(_View(skin=step, cut=width, scale=scale[:, None], frames=frames))
        both = _View(skin=step, cut=width, scale=np.concatenate([scale, scale])[:, None], frames=None)
        return SeenParts(self, (sides[0], sides[1]), both)

    def linear(self, state: State, seen: SeenParts | None = None) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`; of the vectors, or of the parts that are seen of them."""
        first, second = self._both(state, seen, derivatives=True)
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

    def _both(self, state: State, seen: SeenParts | None, *, derivatives: bool) -> tuple[_Held, _Held]:
        """What the points of the first panels, and of the second, are held by."""
        first, second = self._sides
        of_first, of_second = (_PLAIN, _PLAIN) if seen is None else seen.sides
        if self._both_curved is None:
            return (
                self._held(state, first, of_first, derivatives=derivatives),
                self._held(state, second, of_second, derivatives=derivatives),
            )
        # Both at once: the arrays are small, and most of the time goes to calls.
        view = _PLAIN if seen is None else seen.both
        held = self._held(state, self._both_curved, view, derivatives=derivatives)
        seams = len(first.own)
        return held.cut(slice(seams), first.places.shape[1]), held.cut(slice(seams, None), second.places.shape[1])

    def _held(self, state: State, side: _Side, view: _View, *, derivatives: bool) -> _Held:
        points = side.carrying.points(side.taken(state.boundary.position))
        moved = side.taken(slopes(state.boundary)) if derivatives else None
        from_edge = _from_line if side.straight else _from_end
        return from_edge(state, side, view, points, moved)


@dataclass(frozen=True, slots=True)
class SeenParts:
    """The parts of a gap that are asked for, as seams run in one state.

    Attributes:
        gap: whose.
        sides: in which order they are told of the points of the first panels, and of the second ones.
        both: of both together, where both edges are curved.
    """

    gap: MixedGap
    sides: tuple[_View, _View]
    both: _View

    def vectors(self, state: State) -> Array:
        """(seams, points, parts)."""
        return self.gap.vectors(state, self)

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """The same, and how they follow the unknowns; see `HeldTerm.linear`."""
        return self.gap.linear(state, self)


def _from_line(state: State, side: _Side, view: _View, points: Array, moved: Array | None) -> _Held:
    """From the line through two corners: r = x - c - s e with s = (x - c) . e / e . e and e between the corners."""
    other, corners = side.other[:, None], side.corners
    at = state.corners.position[other, corners]
    e = (at[:, 1] - at[:, 0])[:, None]
    square = dot(e, e)
    s = (dot(points - at[:, :1], e) / square)[..., None]
    r = points - at[:, :1] - s * e
    vectors = r if view.frames is None else (view.frames @ r[..., None])[..., 0]
    if moved is None:
        return _Held(vectors, None, None)
    rates = slopes(state.corners)[other, corners]
    de = (rates[:, 1] - rates[:, 0])[:, None]
    # r stays square to e: what lies along e of its change makes up for the turning of e.
    by_other = -(rates[:, :1] + s[..., None] * de)
    away = (e[..., None, :] @ by_other)[..., 0, :]
    turned = (r[..., None, :] @ de)[..., 0, :]
    by_other -= e[..., None] * ((away + turned) / square[..., None])[..., None, :]
    across = np.eye(3) - e[..., :, None] * e[..., None, :] / square[..., None, None]
    if view.frames is not None:
        across, by_other = view.frames @ across, view.frames @ by_other
    return _Held(vectors, side.carrying.slopes(across, moved), by_other)


def _from_end(state: State, side: _Side, view: _View, points: Array, moved: Array | None) -> _Held:
    """From the skin, and from the cut plane; a third number is 0."""
    other, end, scale = side.other, side.end, view.scale
    surfaces, cuts = state.surfaces, state.cuts
    shape, inner, m = points.shape[:2], np.zeros(0), cuts.m[other, end][:, None]
    patch = surfaces.assign(points, other) if view.skin is not None else None
    vectors = np.zeros((*shape, view.count))
    if view.cut is not None:
        vectors[..., view.cut] = (dot(points, m) - cuts.s[other, end][:, None]) * scale[..., view.cut]
    if view.skin is not None and patch is not None:
        if moved is None:
            distance = surfaces.distance(points, other, patch)
        else:
            distance, inner = surfaces.distance_inner(points, other, patch)
        vectors[..., view.skin] = distance * scale[..., view.skin]
    if moved is None:
        return _Held(vectors, None, None)
    if surfaces.outer is None or cuts.dm is None or cuts.ds is None:
        raise ValueError("the state was walked without derivatives")
    size = surfaces.outer.shape[-1]
    gradients, by_other = np.zeros((*shape, view.count, 3)), np.zeros((*shape, view.count, size))
    if view.cut is not None:
        longer = scale[..., view.cut, None]
        gradients[:, :, view.cut] = longer * m
        by_cut = (longer * points) @ cuts.dm[other, end]
        np.subtract(by_cut, longer * cuts.ds[other, end][:, None], out=by_other[:, :, view.cut])
    if view.skin is not None and patch is not None:
        scaled = scale[..., view.skin, None] * inner
        np.negative(scaled[..., 3:6], out=gradients[:, :, view.skin])
        outer = np.take(surfaces.outer.reshape(-1, *surfaces.outer.shape[2:]), surfaces.places(other, patch), axis=0)
        np.matmul(scaled[..., None, :], outer, out=by_other[:, :, view.skin, None])
    return _Held(vectors, side.carrying.slopes(gradients, moved), by_other)
