"""Walk a batch of panels of one feature: rulings, corners and their exact derivatives.

Everything here is in each panel's local frame (axes b, t, n of its reference, origin in its middle) and in units of the
solver's length. A cut plane is t + skew b + tilt n = position in that frame, so it does not move with the chain; where
cuts are "square" it is so in the frame of the anchor ruling, and moves with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.patches import Frames
from cadpanel.geometry.frames import cayley, cayley_rates, cross, dot, point_velocity

if TYPE_CHECKING:  # a feature walks, so the walk cannot import it
    from cadpanel.features.feature import Feature
    from cadpanel.features.polygon import Polygon

Array = NDArray[np.float64]

# Panels differentiated together: what is needed on the way stays in the processor's cache and off the system's memory.
_CHUNK = 256


@dataclass(frozen=True, slots=True)
class Rulings:
    """n x R ruling frames and their twists.

    Attributes:
        p, b, t, n: (panels, R, 3) each.
        twist: (panels, R, 6, N) for the N numbers of the feature, or None where no derivatives were asked for.
    """

    p: Array
    b: Array
    t: Array
    n: Array
    twist: Array | None


@dataclass(frozen=True, slots=True)
class Walk:
    """A batch of panels, walked.

    Attributes:
        feature: the feature of all these panels.
        values: (panels, N) all numbers, the fixed ones included.
        anchor: the ruling in the middle of the anchor patch (R = 1).
        edges: the k + 1 rulings that bound the patches, from side 0 to side 1.
        carriers: per patch the ruling that its radius is measured at (R = k).
        arcs: rulings inside the curved patches at ARC_SHARES of their sweep, patch by patch.
    """

    feature: Feature | Polygon
    values: Array
    anchor: Rulings
    edges: Rulings
    carriers: Rulings
    arcs: Rulings


class _Step:
    """A frame batch underway, with its accumulated twist."""

    def __init__(self, frames: Frames, twist: Array | None) -> None:
        self.frames = frames
        self.twist = twist

    def carry(self, feature: Feature, patch: int, values: Array, way: float) -> _Step:
        numbers = feature.patch_slice(patch)
        frames, own = feature.patches[patch].carry(self.frames, values[:, numbers], way)
        if self.twist is None:
            return _Step(frames, None)
        # The patch's numbers may already act on the frame that is carried on (the anchor's radius, say): they add.
        twist = self.twist.copy()
        twist[:, :, numbers] += own
        return _Step(frames, twist)


def walk(feature: Feature, values: Array, *, derivatives: bool) -> Walk:
    """Walk all panels from the middle of their anchor patch to both sides.

    Args:
        feature: the feature of all panels.
        values: (panels, N) all numbers of the feature.
        derivatives: whether twists are wanted.
    """
    start = _anchor(feature, values, derivatives)
    last = len(feature.patches) - 1
    edges: dict[int, _Step] = {}
    arcs: list[_Step] = []
    for side in (-1, 1):
        step = start.carry(feature, feature.anchor, values, 0.5 * side)
        edges[feature.anchor + (side > 0)] = step
        patch = feature.anchor + side
        while 0 <= patch <= last:
            step = step.carry(feature, patch, values, float(side))
            edges[patch + (side > 0)] = step
            patch += side
    carriers = [start if i == feature.anchor else edges[i if i > feature.anchor else i + 1] for i in range(last + 1)]
    for i, patch_spec in enumerate(feature.patches):
        if patch_spec.kind != "plane":
            arcs += [_inside(feature, i, carriers[i], values, share) for share in ARC_SHARES]
    return Walk(
        feature,
        values,
        _stack([start], start),
        _stack([edges[i] for i in range(last + 2)], start),
        _stack(carriers, start),
        _stack(arcs, start),
    )


def _inside(feature: Feature, patch: int, carrier: _Step, values: Array, share: float) -> _Step:
    if patch == feature.anchor:
        return carrier.carry(feature, patch, values, share - 0.5)
    return carrier.carry(feature, patch, values, share if patch > feature.anchor else share - 1.0)


def _anchor(feature: Feature, values: Array, derivatives: bool) -> _Step:
    panels = len(values)
    shift, turn = values[:, :2], values[:, 2:5]
    rotation = cayley(turn)
    p = np.stack([shift[:, 0], np.zeros(panels), shift[:, 1]], axis=-1)
    frames = Frames(p, rotation[:, :, 0], rotation[:, :, 1], rotation[:, :, 2])
    if not derivatives:
        return _Step(frames, None)
    twist = np.zeros((panels, 6, len(feature.numbers)))
    twist[:, 3, 0] = 1.0
    twist[:, 5, 1] = 1.0
    rates = cayley_rates(turn)
    twist[:, :3, 2:5] = rates
    for j in range(3):
        twist[:, 3:, 2 + j] = cross(p, rates[:, :, j])
    return _Step(frames, twist)


def _stack(steps: list[_Step], like: _Step) -> Rulings:
    if not steps:
        return _none(like)
    p, b, t, n = (np.stack([getattr(step.frames, axis) for step in steps], axis=1) for axis in "pbtn")
    twists = [step.twist for step in steps if step.twist is not None]
    return Rulings(p, b, t, n, np.stack(twists, axis=1) if twists else None)


def _none(like: _Step) -> Rulings:
    """No rulings at all, for as many panels."""
    panels = len(like.frames.p)
    empty = np.zeros((panels, 0, 3))
    twist = None if like.twist is None else np.zeros((panels, 0, *like.twist.shape[1:]))
    return Rulings(empty, empty, empty, empty, twist)


@dataclass(frozen=True, slots=True)
class Points:
    """Points of the panels that follow the numbers.

    Attributes:
        position: (panels, R, 3).
        jacobian: (panels, R, 3, N) or None without derivatives.
    """

    position: Array
    jacobian: Array | None


def cut_planes(walked: Walk) -> tuple[Array, Array]:
    """The cut planes m . x = s: m (panels, 2, 3), not of unit length, and s (panels, 2)."""
    feature, values = walked.feature, walked.values
    cuts = np.stack([values[:, feature.cut_slice(end)] for end in (0, 1)], axis=1)
    m = np.stack([cuts[..., 1], np.ones_like(cuts[..., 0]), cuts[..., 2]], axis=-1)
    if not _carried(feature):
        return m, cuts[..., 0]
    anchor = walked.anchor
    m = m @ np.stack([anchor.b[:, 0], anchor.t[:, 0], anchor.n[:, 0]], axis=1)
    return m, cuts[..., 0] + dot(m, anchor.p)


def cut_plane_rates(walked: Walk) -> tuple[Array, Array]:
    """How `cut_planes` follow the numbers: dm (panels, 2, 3, N) and ds (panels, 2, N)."""
    feature, anchor = walked.feature, walked.anchor
    panels, count = walked.values.shape
    dm, ds = np.zeros((panels, 2, 3, count)), np.zeros((panels, 2, count))
    for end in (0, 1):
        at = feature.cut_slice(end).start
        ds[:, end, at] = 1.0
        if not _carried(feature):
            dm[:, end, 0, at + 1] = dm[:, end, 2, at + 2] = 1.0
            continue
        for number, axis in ((at + 1, anchor.b), (at + 2, anchor.n)):
            dm[:, end, :, number] = axis[:, 0]
            ds[:, end, number] = dot(axis[:, 0], anchor.p[:, 0])
    if _carried(feature):
        if anchor.twist is None:
            raise ValueError("the panels were walked without derivatives")
        m, _ = cut_planes(walked)
        turned = cross(np.swapaxes(anchor.twist[:, :, :3], 2, 3), m[:, :, None])
        dm += np.swapaxes(turned, 2, 3)
        # The plane's point p moves along: d(m . p) = dm . p + m . v(p).
        ds += dot(turned, anchor.p[:, :, None]) + np.einsum(
            "pex,pxj->pej", m, point_velocity(anchor.twist[:, 0], anchor.p[:, 0])
        )
    return dm, ds


def _carried(feature: Feature | Polygon) -> bool:
    return feature.cuts == "square"


def end_points(walked: Walk, rulings: Rulings) -> Points:
    """Where R rulings pierce the two cut planes, (panels, 2 R, 3): first all of end 0, then all of end 1.

    With the plane m . x = s, the point is c = p + t (s - m . p) / (m . t). A point that is carried with the ruling has
    the velocity V; sliding along t to stay in the plane adds t (ds - dm . c - m . V) / (m . t). Derivatives are exact.
    """
    m, s = cut_planes(walked)
    panels, count = rulings.p.shape[:2]
    rate = dot(m[:, :, None], rulings.t[:, None])
    slide = (s[..., None] - dot(m[:, :, None], rulings.p[:, None])) / rate
    position = rulings.p[:, None] + slide[..., None] * rulings.t[:, None]
    if rulings.twist is None:
        return Points(position.reshape(panels, 2 * count, 3), None)
    moved = np.empty((panels, 2, count, 3, walked.values.shape[1]))
    rates = cut_plane_rates(walked) if _carried(walked.feature) else None
    for start in range(0, panels, _CHUNK):
        part = slice(start, start + _CHUNK)
        moved[part] = _moved(walked, rulings, part, m[part], position[part], rate[part])
        if rates is not None:
            dm, ds = rates[0][part], rates[1][part]
            along = (ds[:, :, None] - position[part] @ dm) / rate[part][..., None]
            moved[part] += rulings.t[part, None, :, :, None] * along[..., None, :]
    return Points(position.reshape(panels, 2 * count, 3), moved.reshape(panels, 2 * count, 3, moved.shape[-1]))


def _moved(walked: Walk, rulings: Rulings, part: slice, m: Array, position: Array, rate: Array) -> Array:
    """Derivatives (n, 2, R, 3, N) of the points (n, 2, R, 3) of some panels, but for cuts that move with the anchor."""
    if rulings.twist is None:
        raise ValueError("the panels were walked without derivatives")
    moved = point_velocity(rulings.twist[part, None], position)
    along = -(m[:, :, None, None] @ moved)[..., 0, :]
    if not _carried(walked.feature):
        for end in (0, 1):
            at = walked.feature.cut_slice(end).start
            along[:, end, :, at] += 1.0
            along[:, end, :, at + 1] -= position[:, end, :, 0]
            along[:, end, :, at + 2] -= position[:, end, :, 2]
    along /= rate[..., None]
    moved += rulings.t[part, None, :, :, None] * along[..., None, :]
    return moved
