"""Starts for samples that turn far: search the axis over the hemisphere of directions.

Seen along the true axis z a cylinder is a circle and a cone is a surface of revolution of degree two:
    A (x^2 + y^2) + B x + C y + D = 0      or      A (x^2 + y^2) + E z^2 + B x + C y + F z + D = 0.
With the mean of the squared gradient set to 1 (Taubin 1991) the smallest eigenvalue of a 3 x 3 or 5 x 5 matrix is the
mean of the squared distance to first order, so one small eigenvalue tells how good a direction is. With the samples'
mean at 0 the constraint is diagonal, and all matrices follow from the moments of the samples, taken once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.atomic.clouds import Clouds
from cadpanel.atomic.ruling import Rulings
from cadpanel.geometry.vectors import cross

_DIRECTIONS = 160
_NEIGHBOURS = 6
_MAIN = 3
_GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))
# Coefficients, as shares of the whole, below which a circle has no centre in reach or a middle no direction.
_LEAST = 1e-9
_TINY = 1e-300
# The columns of the surface of revolution that make the circle, in the order x^2 + y^2, x, y, z^2, z.
_CIRCLE = 3


def axis_starts(clouds: Clouds, *, count: int, revolved: bool) -> Rulings:
    """(n * starts) rulings, set by set; starts is `count`, for cylinders three more.

    Args:
        clouds: n sets in their main axes.
        count: starts of each set: the three main axes, those of the normals if there are any, and the best minima of
            the hemisphere.
        revolved: whether surfaces of revolution are sought (then the cone through each), or cylinders.
    """
    directions = _directions(clouds)
    frames = _frames(directions)
    matrices, scales = _matrices(clouds, frames, revolved=revolved)
    scores = np.asarray(np.linalg.eigvalsh(matrices)[:, :, 0], dtype=np.float64)
    best = _best(scores, count, named=directions.shape[1] - _DIRECTIONS)
    order = np.zeros(count, dtype=np.intp)
    if not revolved:
        # The second best circle about each main axis, too: a strip that scatters may be a tube through either.
        best = np.concatenate([best, best[:, :_MAIN]], axis=1)
        order = np.concatenate([order, np.ones(_MAIN, dtype=np.intp)])
    chosen = np.linalg.eigh(np.take_along_axis(matrices, best[:, :, None, None], axis=1))[1]
    vectors = np.take_along_axis(chosen, order[None, :, None, None], axis=-1)[..., 0]
    vectors = vectors / np.take_along_axis(scales, best[:, :, None], axis=1)
    frames = np.take_along_axis(frames, best[:, :, None, None], axis=1)
    found = _revolved(clouds, frames, vectors) if revolved else _circular(frames, vectors, scales, best)
    return Rulings(
        points=found.points.reshape(-1, 3),
        frames=found.frames.reshape(-1, 3, 3),
        curvature=found.curvature.ravel(),
        taper=found.taper.ravel(),
    )


@dataclass(frozen=True, slots=True)
class _Hemisphere:
    directions: Array
    neighbours: IntArray


@cache
def _hemisphere() -> _Hemisphere:
    """Directions on a spiral over the hemisphere, and the nearest others of each, as lines."""
    number = np.arange(_DIRECTIONS)
    z = 1.0 - (number + 0.5) / _DIRECTIONS
    radius, angle = np.sqrt(1.0 - z * z), number * _GOLDEN_ANGLE
    directions = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1)
    near = np.argsort(-np.abs(directions @ directions.T), axis=1)[:, 1 : _NEIGHBOURS + 1]
    return _Hemisphere(directions, near)


def _directions(clouds: Clouds) -> Array:
    """(n, named + hemisphere, 3): the three main axes, two from the normals if there are any, the hemisphere."""
    count = len(clouds.points)
    parts = [np.broadcast_to(np.eye(3), (count, 3, 3))]
    if clouds.normals is not None:
        # The normals of a cylinder lie in a plane through 0, those of a cone in a plane.
        weighted = clouds.normals * clouds.roots[..., None]
        second = np.swapaxes(weighted, 1, 2) @ weighted
        mean = np.einsum("nm,nmx->nx", clouds.roots, weighted)
        for moments in (second, second - mean[:, :, None] * mean[:, None, :]):
            parts.append(np.linalg.eigh(moments)[1][:, None, :, 0])
    parts.append(np.broadcast_to(_hemisphere().directions, (count, _DIRECTIONS, 3)))
    return np.concatenate(parts, axis=1)


def _frames(directions: Array) -> Array:
    """(..., 3, 3) right-handed columns x, y, z with z the direction."""
    least = np.eye(3)[np.argmin(np.abs(directions), axis=-1)]
    x = cross(least, directions)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack([x, cross(directions, x), directions], axis=-1)


def _matrices(clouds: Clouds, frames: Array, *, revolved: bool) -> tuple[Array, Array]:
    """(n, d, q, q) Taubin's matrices and (n, d, q) the scales of their coefficients, q = 5 or 3."""
    x, y, z = (clouds.points[..., i] for i in range(3))
    monomials = np.stack([x * x, y * y, z * z, x * y, x * z, y * z, x, y, z], axis=1) * clouds.roots[:, None]
    monomials -= (monomials @ clouds.roots[:, :, None]) * clouds.roots[:, None]
    moments = monomials @ np.swapaxes(monomials, 1, 2)
    ax, ay, az = (frames[..., i, 2] for i in range(3))
    along = np.stack([ax * ax, ay * ay, az * az, 2 * ax * ay, 2 * ax * az, 2 * ay * az], axis=-1)
    rows = np.zeros((*frames.shape[:2], 5, 9))
    rows[..., 0, :6] = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]) - along
    rows[..., 1, 6:], rows[..., 2, 6:] = frames[..., 0], frames[..., 1]
    rows[..., 3, :6], rows[..., 4, 6:] = along, frames[..., 2]
    # The mean square of the gradients: 4 rho^2, 1, 1, 4 z^2, 1; the squares' means are the lengths of the main axes.
    lengths = np.einsum("nmx,nm->nx", clouds.points**2, clouds.roots**2)
    along_square = np.einsum("ndx,nx->nd", frames[..., 2] ** 2, lengths)
    across_square = lengths.sum(axis=1)[:, None] - along_square
    scales = np.ones((*frames.shape[:2], 5))
    scales[..., 0] = 2.0 * np.sqrt(np.maximum(across_square, _LEAST))
    scales[..., 3] = 2.0 * np.sqrt(np.maximum(along_square, _LEAST))
    size = 5 if revolved else _CIRCLE
    rows = rows[..., :size, :] / scales[..., :size, None]
    return rows @ moments[:, None] @ np.swapaxes(rows, -1, -2), scales[..., :size]


def _best(scores: Array, count: int, *, named: int) -> IntArray:
    """(n, count) directions: those that have a name, and the best minima over the hemisphere."""
    grid = scores[:, named:]
    neighbours = grid[:, _hemisphere().neighbours]
    low = np.all(grid[:, :, None] <= neighbours, axis=2)
    # What is no minimum comes after all minima, best first.
    order = np.argsort(np.where(low, grid, grid + 1e3), axis=1, kind="stable") + named
    always = np.broadcast_to(np.arange(named), (len(scores), named))
    return np.concatenate([always, order], axis=1)[:, :count]


def _circular(frames: Array, vectors: Array, scales: Array, best: IntArray) -> Rulings:
    """Cylinders through the circles A (x^2 + y^2 - mean) + B x + C y = 0, told nearest to the samples' mean."""
    mean_square = 0.25 * np.take_along_axis(scales[..., 0], best, axis=1) ** 2
    bend, slope = vectors[..., 0], vectors[..., 1:3]
    steepness = np.linalg.norm(slope, axis=-1)
    middle = steepness < _LEAST * np.abs(bend)
    outward = np.where(middle[..., None], np.array([1.0, 0.0]), slope / np.maximum(steepness, _TINY)[..., None])
    steepness = np.where(middle, 0.0, steepness)
    root = np.sqrt(4.0 * bend**2 * mean_square + steepness**2)
    position = 2.0 * bend * mean_square / np.maximum(steepness + root, _TINY)
    n = _combined(frames, outward)
    t = frames[..., 2]
    return Rulings(
        points=position[..., None] * n,
        frames=np.stack([cross(t, n), t, n], axis=-1),
        curvature=2.0 * bend / np.maximum(root, _TINY),
        taper=np.zeros_like(bend),
    )


def _revolved(clouds: Clouds, frames: Array, vectors: Array) -> Rulings:
    """Cones about the axes of the surfaces of revolution: a line through distance over height."""
    bend = vectors[..., 0]
    bend = np.where(np.abs(bend) < _LEAST, _LEAST, bend)
    centre = -vectors[..., 1:3] / (2.0 * bend[..., None])
    q = clouds.points[:, None] @ frames
    share = clouds.roots[:, None] ** 2
    radial = q[..., :2] - centre[:, :, None]
    rho = np.linalg.norm(radial, axis=-1)
    mean = np.sum(share * rho, axis=-1)
    z = q[..., 2]
    rise = np.sum(share * z * rho, axis=-1) / np.maximum(np.sum(share * z * z, axis=-1), _LEAST)
    toward = np.einsum("ndm,ndmx->ndx", np.broadcast_to(share, rho.shape), radial)
    length = np.linalg.norm(toward, axis=-1)
    outward = np.where(
        (length > _LEAST * mean)[..., None], toward / np.maximum(length, _TINY)[..., None], np.array([1.0, 0.0])
    )
    cosine = 1.0 / np.sqrt(1.0 + rise * rise)
    radius = np.maximum(mean, _LEAST)
    e, a = _combined(frames, outward), frames[..., 2]
    t = cosine[..., None] * a + (rise * cosine)[..., None] * e
    n = cosine[..., None] * e - (rise * cosine)[..., None] * a
    return Rulings(
        points=_combined(frames, centre) + radius[..., None] * e,
        frames=np.stack([cross(t, n), t, n], axis=-1),
        curvature=cosine / radius,
        taper=rise * cosine / radius,
    )


def _combined(frames: Array, xy: Array) -> Array:
    combined: Array = frames[..., 0] * xy[..., :1] + frames[..., 1] * xy[..., 1:2]
    return combined
