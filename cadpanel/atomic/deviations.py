"""Covariance of fitted surfaces and what follows from it for half angle and axis."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.atomic.clouds import Clouds
from cadpanel.atomic.ruling import CURVATURE, SHIFT, TAPER, TURN_B, TURN_N, TURN_T, Rulings, distance_rows

# Reciprocal condition of the scaled normal matrix below which the samples do not determine all unknowns.
_UNDETERMINED = 1e-13
_TINY = 1e-300


def covariances(clouds: Clouds, rulings: Rulings, unknowns: tuple[int, ...]) -> Array:
    """(n, k, k) sigma^2 (J^T W J)^-1 in mm and radians; infinite where it does not exist.

    Args:
        clouds: n sets of samples.
        rulings: the fits, in the clouds' units and axes.
        unknowns: what was free.
    """
    distance, rows = distance_rows(rulings, rulings.local(clouds.points), unknowns)
    rows = rows * clouds.roots[:, None]
    matrix = rows @ np.swapaxes(rows, 1, 2)
    scale = 1.0 / np.sqrt(np.maximum(np.einsum("nii->ni", matrix), _TINY))
    scaled = matrix * scale[:, :, None] * scale[:, None, :]
    values, vectors = np.linalg.eigh(scaled)
    spare = clouds.counts - len(unknowns)
    known = (values[:, 0] > _UNDETERMINED) & (spare > 0)
    values = np.where(known[:, None], values, 1.0)
    inverse = (vectors / values[:, None, :]) @ np.swapaxes(vectors, 1, 2)
    square = np.sum((clouds.roots * distance) ** 2, axis=1)
    variance = square / np.maximum(spare, 1)
    # Turns have no unit; a shift is a length, curvature and taper are inverse lengths.
    powers = np.array([{SHIFT: 1.0, CURVATURE: -1.0, TAPER: -1.0}.get(unknown, 0.0) for unknown in unknowns])
    units = np.where(known[:, None], scale, 1.0) * clouds.sizes[:, None] ** powers
    covariance = variance[:, None, None] * inverse * units[:, :, None] * units[:, None, :]
    return np.where(known[:, None, None], covariance, np.inf)


def angle_variance(covariance: Array, curvature: float, taper: float) -> float:
    """Variance of the half angle of a cone, radians squared."""
    if not np.all(np.isfinite(covariance)):
        return float("inf")
    gradient = _angle_gradient(curvature, taper)
    return float(gradient @ covariance @ gradient)


def axis_covariance(covariance: Array, curvature: float, taper: float) -> Array:
    """(3, 3) covariance of a cone's axis cos(g) t - sin(g) n along b, t, n, radians squared."""
    if not np.all(np.isfinite(covariance)):
        return np.full((3, 3), np.inf)
    root = np.hypot(curvature, taper)
    cosine, sine = abs(curvature) / root, np.copysign(taper / root, curvature * taper)
    jacobian = np.zeros((3, 6))
    # omega x a, and the derivative of a by g.
    jacobian[1, TURN_B], jacobian[2, TURN_B] = sine, cosine
    jacobian[0, TURN_T] = -sine
    jacobian[0, TURN_N] = -cosine
    jacobian += np.outer([0.0, -sine, -cosine], _angle_gradient(curvature, taper))
    product: Array = jacobian @ covariance @ jacobian.T
    return product


def _angle_gradient(curvature: float, taper: float) -> Array:
    """Derivative (6,) of the signed half angle atan(taper / curvature)."""
    gradient = np.zeros(6)
    square = curvature**2 + taper**2
    gradient[CURVATURE], gradient[TAPER] = -taper / square, curvature / square
    return gradient
