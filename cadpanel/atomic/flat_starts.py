"""Starts for gentle samples: scan the ruling's direction in the plane of the samples.

Over that plane a gentle cylinder or cone has the height c + slopes - k u^2 / (P + sqrt(P^2 + l^2 u^2)), P = 1 + l v
(see `ruling`, for small k and w). For each direction of the ruling and each taper of a grid that is linear in all other
numbers, and least squares tell by how much the curvature lowers the sum of squares. All samples and all digits take
part, so that a panel of a millionth of the radius still tells its direction, and near-flat samples offer all their
minima, also those with an axis across.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.atomic.clouds import Clouds
from cadpanel.atomic.ruling import Rulings

_DIRECTIONS = 24
# Half the samples' extent along the ruling over the distance of the apex: 0 is the cylinder, beyond 1 the apex lies
# among the samples.
_TAPERS = (-2.0, -1.2, -0.85, -0.45, 0.0, 0.45, 0.85, 1.2, 2.0)
# More than any gain.
_NO_PEAK = 1e3
# What a unit vector keeps after the plane is taken out of it, if that is only rounding.
_LEAST_REST = 1e-24
# What is left of P + S behind the apex, where it is a small difference and a start need not be exact.
_LEAST_REACH = 1e-6
# An extent along the ruling below this share of the samples' has no place for tapers.
_LEAST_EXTENT = 1e-12


def flat_starts(clouds: Clouds, *, count: int, tapered: bool) -> Rulings:
    """(n * count) rulings, set by set, the most promising first.

    Args:
        clouds: n sets in their main axes.
        count: starts of each set.
        tapered: whether the cone is sought; otherwise all tapers are 0.
    """
    angle: Array = np.linspace(0.0, np.pi, _DIRECTIONS, endpoint=False)
    cosine, sine = np.cos(angle)[None, :, None], np.sin(angle)[None, :, None]
    x, y = clouds.points[:, None, :, 0], clouds.points[:, None, :, 1]
    # b = (cos, sin, 0) and t = (-sin, cos, 0) make b = t x n with n the third axis.
    u, v = cosine * x + sine * y, cosine * y - sine * x
    reach = np.max(np.abs(v) * (clouds.roots > 0.0)[:, None], axis=2)
    share = np.array(_TAPERS if tapered else (0.0,))
    tapers = share[None, :, None] / np.maximum(reach, _LEAST_EXTENT)[:, None]
    before_apex = 1.0 + tapers[..., None] * v[:, None]
    across = u[:, None] ** 2
    root = np.sqrt(before_apex**2 + tapers[..., None] ** 2 * across)
    shapes = across / np.maximum(before_apex + root, _LEAST_REACH) * clouds.roots[:, None, None]
    base = _plane_basis(clouds)
    shapes = _taken_out(base, shapes.reshape(len(base), -1, base.shape[1])).reshape(shapes.shape)
    rest = _taken_out(base, (clouds.points[..., 2] * clouds.roots)[:, None])[:, 0]
    square = np.einsum("nldm,nldm->nld", shapes, shapes)
    product = np.einsum("nldm,nm->nld", shapes, rest)
    slope: Array = product / np.maximum(square, _LEAST_REST)
    gain: Array = np.where(square > _LEAST_REST, product * slope, -1.0)
    return _rulings(_best_maxima(gain, count), angle, slope, tapers)


def _rulings(best: IntArray, angle: Array, slope: Array, tapers: Array) -> Rulings:
    sets, count = best.shape
    direction = best % len(angle)
    cosine, sine = np.cos(angle[direction]), np.sin(angle[direction])
    frames = np.zeros((sets, count, 3, 3))
    frames[..., 0, 0], frames[..., 1, 0] = cosine, sine
    frames[..., 0, 1], frames[..., 1, 1] = -sine, cosine
    frames[..., 2, 2] = 1.0
    curvature = -np.take_along_axis(slope.reshape(sets, -1), best, axis=1)
    taper = np.take_along_axis(tapers.reshape(sets, -1), best, axis=1)
    return Rulings(
        points=np.zeros((sets * count, 3)),
        frames=frames.reshape(-1, 3, 3),
        curvature=curvature.ravel(),
        taper=taper.ravel(),
    )


def _plane_basis(clouds: Clouds) -> Array:
    """(n, m, 3) orthonormal columns that span the weighted planes over the first two axes."""
    columns = np.stack([np.ones_like(clouds.roots), clouds.points[..., 0], clouds.points[..., 1]], axis=-1)
    basis: Array = np.linalg.qr(columns * clouds.roots[..., None])[0]
    return basis


def _taken_out(basis: Array, rows: Array) -> Array:
    """What is left of rows (n, a, m) when their parts along the basis (n, m, 3) are taken out."""
    for _ in range(2):  # once more for the digits that the first time costs
        rows = rows - (rows @ basis) @ np.swapaxes(basis, 1, 2)
    return rows


def _best_maxima(gain: Array, count: int) -> IntArray:
    """(n, count) flat indices of the largest maxima over tapers and directions, then of the largest others.

    Half a turn carries a taper to its negative: beyond the two ends of the scan the neighbours are taken from there.
    """
    mirrored = gain[:, ::-1]
    ring = np.concatenate([mirrored[..., -1:], gain, mirrored[..., :1]], axis=-1)
    edged = np.pad(ring, ((0, 0), (1, 1), (0, 0)), constant_values=-np.inf)
    # Along both: a slope between two directions or two tapers is no peak.
    here = edged[:, 1:-1, 1:-1]
    peak = (here >= edged[:, 1:-1, :-2]) & (here >= edged[:, 1:-1, 2:])
    peak &= (here >= edged[:, :-2, 1:-1]) & (here >= edged[:, 2:, 1:-1])
    score = np.where(peak, gain, gain - _NO_PEAK).reshape(len(gain), -1)
    best: IntArray = np.argsort(-score, axis=1, kind="stable")[:, :count]
    return best
