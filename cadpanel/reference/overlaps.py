"""Panels that cover each other, found by outlines: where two sheets overlap, one's outline runs over the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.errors import OverlapError
from cadpanel.geometry.polyline import distances_to_curves
from cadpanel.geometry.vectors import cross, norm, unit
from cadpanel.reference.oriented_panel import Sheet

# So many points of a panel's outline, of 64 a side, lie on a panel that it covers, or one of them by so many tolerances
# inside: less may be a corner's overrun.
COVERING = 3
DEEP = 10.0
# What lies on a panel has its normal there, or leans against it by no more than this, degrees: a fin stands on it.
ALIGNED = 20.0
# An overlap of no more than so many tolerances may be how the file was drawn, and a larger tolerance may help.
NARROW = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Loop:
    """A panel's outline as one closed line.

    Attributes:
        points: (l, 3) mm; side after side, each with as many.
        normals: (l, 3) of the panel there.
        steps: (l, 3) from each point to the next, mm.
        inwards: (l, 3) from the line between each point and the next into the panel, square to it, of length 1.
        sides: how many there are.
    """

    points: Array
    normals: Array
    steps: Array
    inwards: Array
    sides: int

    def contains(self, points: Array) -> BoolArray:
        """Tell for (m, 3) points beside the outline whether they lie on the panel's side of where they are nearest.

        Where that is a point between two lines, both count alike: the sum of their ways inwards tells both at corners
        that stand out and at such that stand back, if only no other point of the outline is nearer.
        """
        middle = self.points.mean(axis=0)
        placed, own = points - middle, self.points - middle
        squares = np.einsum("ld,ld->l", own, own) - 2.0 * placed @ own.T
        # The points of a side are evenly spaced: of its lines one that ends in the nearest of them is the nearest.
        each = squares.reshape(len(points), self.sides, -1)
        nearest = each.argmin(axis=-1) + np.arange(self.sides) * each.shape[-1]
        lines = np.concatenate([nearest - 1, nearest], axis=1) % len(own)
        offsets = placed[:, None] - own[lines]
        lengths = np.einsum("ld,ld->l", self.steps, self.steps)[lines]
        parts = np.clip(np.einsum("mkd,mkd->mk", offsets, self.steps[lines]) / lengths, 0.0, 1.0)
        away = offsets - parts[..., None] * self.steps[lines]
        best = (np.arange(len(points)), np.einsum("mkd,mkd->mk", away, away).argmin(axis=1))
        line, part = lines[best], parts[best]
        beside = np.where(part <= 0.0, line - 1, np.where(part >= 1.0, line + 1, line)) % len(own)
        ways = self.inwards[line] + self.inwards[beside]
        return np.asarray(np.einsum("md,md->m", away[best], ways) > 0.0)


def refuse_overlaps(sheets: Sequence[Sheet], source: str, tolerance: float) -> None:
    """Refuse two panels that cover each other over a part of their area, however they meet otherwise.

    Where two panels overlap by more than the tolerance, the outline of one of them runs over the other by more than
    that. Panels that coincide all round are not told: see `refuse_duplicates`.

    Args:
        sheets: the panels.
        source: the file's name, for the message.
        tolerance: how closely they lie on each other, and how far inside the outline of the other, mm.

    Raises:
        OverlapError: naming both.
    """
    if len(sheets) < 2:
        return
    loops = [_loop(one) for one in sheets]
    points = np.concatenate([loop.points for loop in loops])
    normals = np.concatenate([loop.normals for loop in loops])
    owner = np.repeat(np.arange(len(loops)), [len(loop.points) for loop in loops])
    tree = cKDTree(points)
    for index, (one, loop) in enumerate(zip(sheets, loops, strict=True)):
        near = _beside(index, one, loop, tree, owner, tolerance)
        if not len(near):
            continue
        depths = _depths(one, loop, points[near], normals[near], tolerance)
        for other in np.unique(owner[near]).tolist():
            own = depths[owner[near] == other]
            if np.count_nonzero(own > tolerance) >= COVERING or own.max() > DEEP * tolerance:
                raise _said(sheets[other].name, one.name, source, float(own.max()), tolerance)


def _said(name: str, covered: str, source: str, depth: float, tolerance: float) -> OverlapError:
    wider = f", or give a seam tolerance of more than {depth:.3g} mm" if depth <= NARROW * tolerance else ""
    fault = f"a part of it covers panel '{covered}' to within {tolerance:g} mm, up to {depth:.4g} mm inside its outline"
    return OverlapError(name, source, fault, f"trim or delete one of the two{wider}")


def _loop(sheet: Sheet) -> _Loop:
    points, normals = (
        np.concatenate([array[:-1] for array in arrays])
        for arrays in ([side.points for side in sheet.sides], [side.normals for side in sheet.sides])
    )
    steps = np.roll(points, -1, axis=0) - points
    inwards = unit(cross(normals + np.roll(normals, -1, axis=0), steps))
    return _Loop(points=points, normals=normals, steps=steps, inwards=inwards, sides=len(sheet.sides))


def _beside(index: int, sheet: Sheet, loop: _Loop, tree: cKDTree, owner: IntArray, tolerance: float) -> IntArray:
    """The points of other panels' outlines that lie in the box about a panel that stands along its own axes."""
    own = np.concatenate([loop.points, sheet.points])
    middle = own.mean(axis=0)
    _, axes = np.linalg.eigh((own - middle).T @ (own - middle))
    placed = (own - middle) @ axes
    low, high = placed.min(axis=0), placed.max(axis=0)
    reach = float(norm(0.5 * (high - low))) + tolerance
    near = np.array(tree.query_ball_point(middle + axes @ (0.5 * (low + high)), reach), dtype=np.intp)
    near = near[owner[near] != index]
    there = (np.asarray(tree.data)[near] - middle) @ axes
    # Across the panel, which comes first, the box has the tolerance to spare; along it, what lies on its border is out.
    margin = tolerance * np.array([1.0, -0.5, -0.5])
    inside = np.asarray((there >= low - margin) & (there <= high + margin)).all(axis=1)
    return np.asarray(near[inside], dtype=np.intp)


def _depths(sheet: Sheet, loop: _Loop, points: Array, normals: Array, tolerance: float) -> Array:
    """How far (m,) points inside a panel's outline lie from it, mm; 0 for those outside, or off the panel."""
    depths = np.zeros(len(points))
    # Most are points of edges that the two have in common.
    apart = np.flatnonzero(np.asarray(cKDTree(loop.points).query(points)[0]) > tolerance)
    if not len(apart):
        return depths
    left = apart[loop.contains(points[apart])]
    if not len(left):
        return depths
    cloud, turned = np.concatenate([loop.points, sheet.points]), np.concatenate([loop.normals, sheet.normals])
    _, below = cKDTree(cloud).query(points[left])
    agree = np.einsum("md,md->m", normals[left], turned[below])
    # The mean of both normals is square to the chord on any surface of even curvature, where one alone would not be.
    mean = unit(turned[below] + np.sign(agree)[:, None] * normals[left])
    height = np.abs(np.einsum("md,md->m", points[left] - cloud[below], mean))
    left = left[(np.abs(agree) >= np.cos(np.radians(ALIGNED))) & (height <= tolerance)]
    if len(left):
        sides = np.array([side.points for side in sheet.sides])
        depths[left] = distances_to_curves(np.broadcast_to(points[left], (len(sides), len(left), 3)), sides).min(axis=0)
    return depths
