"""Whether a surface can be spanned between two rails: ends, lengths, crossings, corners. Refusals name the place."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import LoftError
from cadpanel.geometry.vectors import norm
from cadpanel.lofting.rail import Rail
from cadpanel.lofting.warp import warp

LONGEST = 20.0
"""How many times as long as the other a rail may be."""
# Rails that come nearer to each other than this part of their size meet.
_APART = 1e-6
_PLACES, _STEPS = 257, 30
# A ruling whose tangent planes turn by less, radians, has one.
_SAME_PLANE = 1e-7
# One way of joining ends is shorter than the other by more than this share.
_SHORTER = 1e-9


def size_of(a: Rail, b: Rail) -> float:
    """The diagonal of a box about both, mm."""
    points = np.concatenate([rail.at(np.linspace(0.0, 1.0, _PLACES)).point for rail in (a, b)])
    return float(norm(np.ptp(points, axis=0)))


def same_way(a: Rail, b: Rail) -> Rail:
    """The second rail, turned round where its ends lie nearer to those of the first one that way."""
    (a0, a1), (b0, b1) = (rail.at(np.array([0.0, 1.0])).point for rail in (a, b))
    straight, crossed = norm(a0 - b0) + norm(a1 - b1), norm(a0 - b1) + norm(a1 - b0)
    return b.reversed() if crossed < straight * (1.0 - _SHORTER) else b


def check_rails(a: Rail, b: Rail, size: float) -> None:
    """Refuse rails between which nothing can be spanned.

    Raises:
        LoftError: one is much longer than the other, one closes, they meet, or lie on one line.
    """
    short, long = sorted((a, b), key=lambda rail: rail.length)
    if long.length > LONGEST * short.length:
        raise LoftError(
            f"rail '{long.name}' is {long.length / short.length:.0f} times as long as '{short.name}' "
            f"({long.length:.6g} and {short.length:.6g} mm), and {LONGEST:.0f} times is the most: cut it into parts, "
            "or name other curves"
        )
    for rail in (a, b):
        ends = rail.at(np.array([0.0, 1.0])).point
        if norm(ends[1] - ends[0]) <= _APART * size:
            raise LoftError(f"rail '{rail.name}' closes at {at(ends[0])}: cut both rails there, and loft the parts")
    least, places = _nearest(a, b)
    if least <= _APART * size:
        where = a.at(places[:1]).point[0]
        raise LoftError(
            f"the rails '{a.name}' and '{b.name}' meet at {at(where)}: trim them there, or loft the parts on both sides"
        )
    points = np.concatenate([rail.at(np.linspace(0.0, 1.0, _PLACES)).point for rail in (a, b)])
    if np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[1] <= _APART * size:
        raise LoftError(f"the rails '{a.name}' and '{b.name}' lie on one line, and span nothing: move one of them")


def _nearest(a: Rail, b: Rail) -> tuple[float, Array]:
    """The least distance between two rails, mm, and the shares (2,) at which they have it.

    From the nearest places of a grid by Newton's steps on the square of the distance, each shortened until it helps.
    """
    shares = np.linspace(0.0, 1.0, _PLACES)
    points = [rail.at(shares).point for rail in (a, b)]
    apart = norm(points[0][:, None] - points[1][None])
    i, j = np.unravel_index(int(apart.argmin()), apart.shape)
    places, least = np.array([shares[i], shares[j]]), float(apart[i, j])
    for _ in range(_STEPS):
        one, other = a.at(places[:1]), b.at(places[1:])
        jacobian = np.stack([one.first[0], -other.first[0]], axis=-1)
        step = np.linalg.lstsq(jacobian, one.point[0] - other.point[0], rcond=1e-12)[0]
        for share in (1.0, 0.5, 0.25, 0.125):
            trial = np.clip(places - share * step, 0.0, 1.0)
            distance = float(norm(a.at(trial[:1]).point[0] - b.at(trial[1:]).point[0]))
            if distance < least:
                break
        else:
            break
        places, least = trial, distance
    return least, places


def cut_at_corners(a: Rail, b: Rail) -> list[tuple[Rail, Rail]]:
    """Both rails cut at their corners, the first corner of one with the first of the other, and so on.

    Where lines, arcs and splines meet smoothly on both, at the ends of one ruling, they are cut as well.

    Raises:
        LoftError: one of them has more corners.
    """
    corners = a.corners(), b.corners()
    if len(corners[0]) == len(corners[1]):
        pairs = zip(a.cut(corners[0]), b.cut(corners[1]), strict=True)
        return [part for pair in pairs for part in _cut_at_joints(*pair)]
    more, fewer = (0, 1) if len(corners[0]) > len(corners[1]) else (1, 0)
    rails = (a, b)
    theirs = np.array([0.0, 1.0, *(rails[fewer].share_of_corner(corner) for corner in corners[fewer])])
    odd = max(corners[more], key=lambda corner: np.abs(theirs - rails[more].share_of_corner(corner)).min())
    where = rails[more].at(np.array([rails[more].share_of_corner(odd)])).point[0]
    raise LoftError(
        f"rail '{rails[more].name}' has {_count(len(corners[more]))} and '{rails[fewer].name}' "
        f"{_count(len(corners[fewer]))}; that at {at(where)} has none to go with it: round it, or cut the other rail "
        "opposite of it and loft the parts"
    )


def _cut_at_joints(a: Rail, b: Rail) -> list[tuple[Rail, Rail]]:
    """Both rails cut where their stretches meet, as lines and arcs do, if rulings without warp join these places.

    Each part may then be a plane, a cylinder or a cone of its own; else a ruling from such a place ends elsewhere.
    """
    joints = a.joints, b.joints
    if len(joints[0]) != len(joints[1]) or not len(joints[0]):
        return [(a, b)]
    if warp(a.at(joints[0]), b.at(joints[1])).max() > _SAME_PLANE:
        return [(a, b)]
    every = range(1, len(a.stretches))
    return list(zip(a.cut(every), b.cut(every), strict=True))


def _count(corners: int) -> str:
    return {0: "no corner", 1: "1 corner"}.get(corners, f"{corners} corners")


def at(point: Array) -> str:
    """A place as messages tell it."""
    x, y, z = (np.round(point, 1) + 0.0).tolist()
    return f"({x:.1f}, {y:.1f}, {z:.1f}) mm"
