"""Walk a batch of panels of one feature: rulings, corners and their exact derivatives.

Everything here is in each panel's local frame (axes b, t, n of its reference, origin in its middle) and in units of the
solver's length. A cut plane is t + skew b + tilt n = position in that frame, so it does not move with the chain; where
cuts are "square" it is so in the frame of the anchor ruling, and moves with it.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.carrying import Frames, carry
from cadpanel.features.cut_planes import carried, cut_plane_rates, cut_planes
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.patches import Dimensions
from cadpanel.features.rulings import PanelFeature, Points, Rulings, Walk
from cadpanel.geometry.frames import cayley, cayley_rates, point_velocity
from cadpanel.geometry.vectors import beside, cross, dot

# Panels differentiated together: what is needed on the way stays in the processor's cache and off the system's memory.
_CHUNK = 256


class _Step:
    """A frame batch underway, with its accumulated twist."""

    def __init__(self, frames: Frames, twist: Array | None) -> None:
        self.frames = frames
        self.twist = twist

    def carry(self, feature: PanelFeature, patch: int, dimensions: Dimensions, way: float) -> _Step:
        frames, own = carry(feature.patches[patch].kind, self.frames, dimensions.values, way)
        if self.twist is None:
            return _Step(frames, None)
        # The patch's numbers may already act on the frame that is carried on (the anchor's radius, say): they add.
        twist = self.twist.copy()
        twist[:, :, feature.patch_slice(patch)] += own if dimensions.rates is None else own @ dimensions.rates
        return _Step(frames, twist)


def walk(feature: PanelFeature, values: Array, *, derivatives: bool) -> Walk:
    """Walk all panels from the middle of their anchor patch to both sides.

    Args:
        feature: the feature of all panels.
        values: (panels, N) all numbers of the feature.
        derivatives: whether twists are wanted.
    """
    dimensions = tuple(patch.dimensions(values[:, feature.patch_slice(i)]) for i, patch in enumerate(feature.patches))
    start = _anchor(feature, values, derivatives)
    last = len(feature.patches) - 1
    edges: dict[int, _Step] = {}
    for side in (-1, 1):
        step = start.carry(feature, feature.anchor, dimensions[feature.anchor], 0.5 * side)
        edges[feature.anchor + (side > 0)] = step
        patch = feature.anchor + side
        while 0 <= patch <= last:
            step = step.carry(feature, patch, dimensions[patch], float(side))
            edges[patch + (side > 0)] = step
            patch += side
    carriers = [start if i == feature.anchor else edges[i if i > feature.anchor else i + 1] for i in range(last + 1)]
    return Walk(
        feature,
        values,
        dimensions,
        _stack([start]),
        _stack([edges[i] for i in range(last + 2)]),
        _stack(carriers),
    )


def arc_rulings(walked: Walk) -> Rulings:
    """The rulings inside the curved patches at ARC_SHARES of their sweep, patch by patch.

    All of a patch in one go; only seams ask for them, and half of the time of a walk would go by here.
    """
    parts = [_inside(walked, i) for i, curved in enumerate(walked.feature.curved) if curved]
    if not parts:
        return _none(walked)
    p, b, t, n = (np.concatenate([getattr(part, axis) for part in parts], axis=1) for axis in "pbtn")
    twists = [part.twist for part in parts if part.twist is not None]
    return Rulings(p, b, t, n, np.concatenate(twists, axis=1) if twists else None)


def _inside(walked: Walk, patch: int) -> Rulings:
    """Those of one patch, carried on from the ruling that its radius is measured at."""
    feature, carriers, panels, count = walked.feature, walked.carriers, len(walked.values), len(ARC_SHARES)
    from_first = {feature.anchor: -0.5}.get(patch, 0.0 if patch > feature.anchor else -1.0)
    shares = np.tile(np.array(ARC_SHARES) + from_first, panels)

    def repeated(one: Array) -> Array:
        return np.repeat(one, count, axis=0)

    frames = Frames(*(repeated(getattr(carriers, axis)[:, patch]) for axis in "pbtn"))
    dimensions, own = walked.dimensions[patch], feature.patch_slice(patch)
    frames, moves = carry(feature.patches[patch].kind, frames, repeated(dimensions.values), shares)
    p, b, t, n = (getattr(frames, axis).reshape(panels, count, 3) for axis in "pbtn")
    if carriers.twist is None:
        return Rulings(p, b, t, n, None)
    moves = moves.reshape(panels, count, 6, -1)
    twist = np.repeat(carriers.twist[:, patch, None], count, axis=1)
    twist[..., own] += moves if dimensions.rates is None else moves @ dimensions.rates[:, None]
    return Rulings(p, b, t, n, twist)


def _anchor(feature: PanelFeature, values: Array, derivatives: bool) -> _Step:
    panels = len(values)
    shift, turn = values[:, :2], values[:, 2:5]
    rotation = cayley(turn)
    p = beside([shift[:, 0], np.zeros(panels), shift[:, 1]])
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


def _stack(steps: list[_Step]) -> Rulings:
    p, b, t, n = (beside([getattr(step.frames, axis) for step in steps]) for axis in "pbtn")
    twists = [step.twist for step in steps if step.twist is not None]
    return Rulings(p, b, t, n, beside(twists) if twists else None)


def _none(like: Walk) -> Rulings:
    """No rulings at all, for as many panels."""
    empty = np.zeros((len(like.values), 0, 3))
    twist = None if like.edges.twist is None else like.edges.twist[:, :0]
    return Rulings(empty, empty, empty, empty, twist)


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
    rates = cut_plane_rates(walked) if carried(walked.feature) else None
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
    if not carried(walked.feature):
        for end, (place, skew, tilt) in enumerate(walked.feature.cut_numbers.tolist()):
            along[:, end, :, place] += 1.0
            along[:, end, :, skew] -= position[:, end, :, 0]
            along[:, end, :, tilt] -= position[:, end, :, 2]
    along /= rate[..., None]
    moved += rulings.t[part, None, :, :, None] * along[..., None, :]
    return moved
