"""Walk a batch of panels of one feature: rulings, corners and their exact derivatives.

Everything here is in each panel's local frame (axes b, t, n of its reference, origin in its middle) and in units of the
solver's length. A cut plane is t + skew b + tilt n = position in that frame, so it does not move with the chain; where
cuts are "square" it is so in the frame of the anchor ruling, and moves with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.carrying import POINT, carry, moves_over
from cadpanel.features.cut_planes import carried, cut_plane_rates, cut_planes
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.patches import Dimensions
from cadpanel.features.rulings import PanelFeature, Points, Rulings, Walk, once
from cadpanel.features.ways import plan_of
from cadpanel.geometry.frames import cayley, cayley_rates, skew, velocity_of
from cadpanel.geometry.vectors import beside

# Panels differentiated together: what is needed on the way stays in the processor's cache and off the system's memory.
_CHUNK = 256


def walk(feature: PanelFeature, values: Array, *, derivatives: bool) -> Walk:
    """Walk all panels from the middle of their anchor patch to both sides.

    Args:
        feature: the feature of all panels.
        values: (panels, N) all numbers of the feature.
        derivatives: whether twists are wanted.
    """
    plan, count = plan_of(feature.anchor, feature.curved), len(feature.patches)
    dimensions = tuple(patch.dimensions(values[:, feature.patch_slice(i)]) for i, patch in enumerate(feature.patches))
    moves = [
        moves_over(
            ways.kind, beside([dimensions[i].values for i in ways.patches]), ways.shares, derivatives=derivatives
        )
        for ways in plan.kinds
    ]
    frames = np.empty((len(values), count + 2, 4, 3))
    frames[:, -1] = _anchor(values)
    for kind, place, start, end in plan.order:
        frames[:, end] = carry(moves[kind].frames[:, place], frames[:, start])
    twist = None
    if derivatives:
        twist = np.repeat(_anchor_twist(values, len(feature.numbers))[:, None], count + 2, axis=1)
        for ways, made in zip(plan.kinds, moves, strict=True):
            own = made.twists(frames[:, ways.starts])
            # The patch's numbers may already act on the frame that is carried on (the anchor's radius, say): they add.
            for place, patch in enumerate(ways.patches):
                by_numbers = _by_numbers(own[:, place], dimensions[patch])
                twist[:, ways.beyond[place], :, feature.patch_slice(patch)] += by_numbers[:, None]
    rulings = Rulings(frames, twist)
    anchor, edges = rulings.at(slice(-1, None)), rulings.at(slice(-1))
    return Walk(feature, values, dimensions, anchor, edges, rulings.at(plan.carriers))


def _by_numbers(twist: Array, dimensions: Dimensions) -> Array:
    """Twists (n, 6, numbers) for a patch's own numbers, of those (n, 6, d) for its dimensions."""
    return twist if dimensions.rates is None else twist @ dimensions.rates


def _anchor(values: Array) -> Array:
    """(panels, 4, 3) the frames in the middle of the anchor patch."""
    frames = np.zeros((len(values), 4, 3))
    frames[:, :POINT] = np.swapaxes(cayley(values[:, 2:5]), 1, 2)
    frames[:, POINT, ::2] = values[:, :2]
    return frames


def _anchor_twist(values: Array, count: int) -> Array:
    """(panels, 6, N) how the frames in the middle of the anchor patch follow their numbers."""
    twist = np.zeros((len(values), 6, count))
    twist[:, 3, 0] = twist[:, 5, 1] = 1.0
    rates, p = cayley_rates(values[:, 2:5]), np.zeros((len(values), 3))
    p[:, ::2] = values[:, :2]
    twist[:, :3, 2:5], twist[:, 3:, 2:5] = rates, skew(p) @ rates
    return twist


@dataclass(frozen=True, slots=True)
class _Arcs:
    """Where the curved patches of a chain are.

    Attributes:
        patches: which they are.
        carriers: the same for arrays; where they follow each other nothing has to be copied.
        ways: (curved, shares) over which share of each patch its arc points lie, see `ways.Ways`.
    """

    patches: tuple[int, ...]
    carriers: IntArray | slice
    ways: Array


@lru_cache
def _arcs_of(anchor: int, curved: tuple[bool, ...]) -> _Arcs:
    patches = tuple(i for i, bent in enumerate(curved) if bent)
    # Their shares begin at a patch's first ruling, ways at the one that its radius is measured at.
    begin = np.array([-0.5 if i == anchor else -1.0 if i < anchor else 0.0 for i in patches])
    carriers: IntArray | slice = np.array(patches, dtype=np.intp)
    if patches and patches[-1] - patches[0] == len(patches) - 1:
        carriers = slice(patches[0], patches[-1] + 1)
    return _Arcs(patches, carriers, begin[:, None] + np.array(ARC_SHARES))


@once
def arc_rulings(walked: Walk) -> Rulings:
    """The rulings inside the curved patches at ARC_SHARES of their sweep, patch by patch.

    All of them in one go; only seams ask for them.
    """
    feature = walked.feature
    arcs = _arcs_of(feature.anchor, feature.curved)
    if not arcs.patches:
        return walked.edges.at(slice(0))
    sizes = beside([walked.dimensions[i].values for i in arcs.patches])
    carriers = walked.carriers.at(arcs.carriers)
    starts = carriers.frames[:, :, None]
    moves = moves_over(
        "cone", sizes[:, :, None] + np.zeros((len(ARC_SHARES), 1)), arcs.ways, derivatives=carriers.twist is not None
    )
    frames = carry(moves.frames, starts).reshape(len(starts), -1, 4, 3)
    if carriers.twist is None:
        return Rulings(frames, None)
    own, twist = moves.twists(starts), np.repeat(carriers.twist[:, :, None], len(ARC_SHARES), axis=2)
    for place, patch in enumerate(arcs.patches):
        rates = walked.dimensions[patch].rates
        turned = own[:, place] if rates is None else own[:, place] @ rates[:, None]
        twist[:, place, :, :, feature.patch_slice(patch)] += turned
    return Rulings(frames, twist.reshape(*frames.shape[:2], *twist.shape[3:]))


def end_points(walked: Walk, rulings: Rulings) -> Points:
    """Where R rulings pierce the two cut planes, (panels, 2 R, 3): first all of end 0, then all of end 1.

    With the plane m . x = s, the point is c = p + t (s - m . p) / (m . t). A point that is carried with the ruling has
    the velocity V; sliding along t to stay in the plane adds t (ds - dm . c - m . V) / (m . t). Derivatives are exact.
    """
    m, s = cut_planes(walked)
    panels, count = rulings.frames.shape[:2]
    rate = m @ np.swapaxes(rulings.t, 1, 2)
    slide = (s[..., None] - m @ np.swapaxes(rulings.p, 1, 2)) / rate
    position = rulings.p[:, None] + slide[..., None] * rulings.t[:, None]
    if rulings.twist is None:
        return Points(position.reshape(panels, 2 * count, 3), None)
    rates = cut_plane_rates(walked) if carried(walked.feature) else None
    slopes = []
    for start in range(0, panels, _CHUNK):
        part = slice(start, start + _CHUNK)
        slopes.append(_moved(walked, rulings, part, m[part], position[part], rate[part]))
        if rates is not None:
            dm, ds = rates[0][part], rates[1][part]
            along = (ds[:, :, None] - position[part] @ dm) / rate[part][..., None]
            slopes[-1] += rulings.t[part, None, :, :, None] * along[..., None, :]
    moved = slopes[0] if len(slopes) == 1 else np.concatenate(slopes)
    return Points(position.reshape(panels, 2 * count, 3), moved.reshape(panels, 2 * count, 3, moved.shape[-1]))


def _moved(walked: Walk, rulings: Rulings, part: slice, m: Array, position: Array, rate: Array) -> Array:
    """Derivatives (n, 2, R, 3, N) of the points (n, 2, R, 3) of some panels, but for cuts that move with the anchor."""
    if rulings.twist is None:
        raise ValueError("the panels were walked without derivatives")
    # What is slid along t is taken off the few numbers that a velocity is made of, not off those for every unknown.
    velocity = velocity_of(position)
    slid = rulings.t[part, None] / rate[..., None]
    velocity -= slid[..., None] * (m[:, :, None, None] @ velocity)
    moved = velocity @ rulings.twist[part, None]
    if not carried(walked.feature):
        for end, (place, skew, tilt) in enumerate(walked.feature.cut_numbers.tolist()):
            own = slid[:, end]
            moved[:, end, :, :, place] += own
            moved[:, end, :, :, skew] -= own * position[:, end, :, :1]
            moved[:, end, :, :, tilt] -= own * position[:, end, :, 2:]
    return moved
