"""Nearest points on a patch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cadpanel.brep.boundary import evaluate, unit_normals
from cadpanel.brep.patch import Patch
from cadpanel.brep.smooth import CLOSE
from cadpanel.reference.polyline import norm

Array = NDArray[np.float64]

# Grid lines each way from which the nearest point of a patch is looked for, and steps of Newton's method from there.
GRID = 41
STEPS = 20
SMALL_STEP = 1e-12
# A foot this close to the border of the parameter range lies on it, as a part of the range.
ON_BORDER = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Feet:
    """Nearest points on a patch.

    Attributes:
        parameters: (m, 2) of the patch.
        distances: (m,) from the points to them, mm.
        asides: (m,) how far the points lie beside the patch: their distances along its tangent planes, mm. More than
            rounding only where the foot is on the border.
        on_border: (m,) whether each foot is on the border of the parameter range.
        by_border: (m,) whether it is there, or inside by no more than what cuts may be off.
    """

    parameters: Array
    distances: Array
    asides: Array
    on_border: NDArray[np.bool_]
    by_border: NDArray[np.bool_]

    def part(self, start: int, stop: int) -> Feet:
        """Those from `start` up to `stop`."""
        own = slice(start, stop)
        return Feet(
            parameters=self.parameters[own],
            distances=self.distances[own],
            asides=self.asides[own],
            on_border=self.on_border[own],
            by_border=self.by_border[own],
        )


class Search:
    """Finds nearest points on one patch by Newton's method, all points at once.

    (The kernel's own projection fails on some surfaces without a word.)
    """

    def __init__(self, patch: Patch) -> None:
        """Lay a grid over the patch."""
        self.patch = patch
        # Not on the border, where a surface may have a pole and no way to go on from there.
        parts = (np.arange(GRID) + 0.5) / GRID
        self._parameters = patch.at(0, np.repeat(parts, GRID), np.tile(parts, GRID))
        self._tree = cKDTree(patch.points(self._parameters))

    def feet(self, points: Array, start: Array | None = None) -> Feet:
        """The feet of (m, 3) points, looked for from (m, 2) `start`, or from the nearest of a grid."""
        patch = self.patch
        uv = self._parameters[self._tree.query(points)[1]] if start is None else start.copy()
        low, high = patch.bounds[:, 0], patch.bounds[:, 1]
        for _ in range(STEPS):
            feet, along_u, along_v = evaluate(patch.surface, uv)
            step = _newton(points - feet, along_u, along_v)
            # A parameter on the border that wants to go beyond it stays there, and the other one moves alone.
            blocked = np.asarray(((uv <= low) & (step < 0.0)) | ((uv >= high) & (step > 0.0)))
            step = np.where(np.any(blocked, axis=1)[:, None], _alone(points - feet, along_u, along_v, blocked), step)
            new = np.clip(uv + step, low, high)
            moved = np.abs(new - uv).max(initial=0.0)
            uv = new
            if moved <= SMALL_STEP * np.ptp(patch.bounds):
                break
        feet, along_u, along_v = evaluate(patch.surface, uv)
        gaps = np.minimum(uv - low, high - uv)
        on_border = np.asarray(np.any(gaps <= ON_BORDER * (high - low), axis=1), dtype=np.bool_)
        close = gaps * np.stack([norm(along_u), norm(along_v)], axis=1) <= CLOSE
        away = points - feet
        normals = unit_normals(along_u, along_v)[0]
        beside = away - np.sum(away * normals, axis=1)[:, None] * normals
        return Feet(
            parameters=uv,
            distances=norm(away),
            asides=norm(beside),
            on_border=on_border,
            by_border=on_border | close.any(axis=1),
        )


def _newton(away: Array, along_u: Array, along_v: Array) -> Array:
    """The step in both parameters that brings the feet nearest, as if the surface were flat: (m, 2)."""
    e, f, g = (np.sum(a * b, axis=1) for a, b in ((along_u, along_u), (along_u, along_v), (along_v, along_v)))
    p, q = np.sum(away * along_u, axis=1), np.sum(away * along_v, axis=1)
    determinant = np.maximum(e * g - f * f, np.finfo(float).tiny)
    return np.stack([(g * p - f * q) / determinant, (e * q - f * p) / determinant], axis=1)


def _alone(away: Array, along_u: Array, along_v: Array, blocked: NDArray[np.bool_]) -> Array:
    """The step in the parameter that is not blocked."""
    steps = [
        np.sum(away * along, axis=1) / np.maximum(np.sum(along * along, axis=1), np.finfo(float).tiny)
        for along in (along_u, along_v)
    ]
    return np.where(blocked, 0.0, np.stack(steps, axis=1))
