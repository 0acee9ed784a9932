"""Nearest points on a patch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.faces.boundary import evaluate, unit_normals
from cadpanel.brep.faces.face_patch import Patch
from cadpanel.brep.kernel.splines import spans_of
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.geometry.vectors import norm

# Least number of grid lines each way from which feet are looked for, and most steps of Newton's method from there.
GRID = 41
STEPS = 100
SMALL_STEP = 1e-12
# By how much steps are shortened where they lead away, and made longer again.
LONGER = 4.0
# The grid has this many lines a span of the surface instead, where those are more, up to a most.
SPAN_NODES = 2
MOST_GRID = 401
# Where the foot found is not on the point, so many of the nearest nodes are looked at; from those that lie more than a
# number of cells from all feet and nodes tried before, another one is looked for, so many times.
NODES = 24
APART = 3.0
LAYERS = 2
# A foot must be nearer than another one by more than this to be preferred, mm.
SAME = 1e-6
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
    on_border: BoolArray
    by_border: BoolArray

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

    def take(self, places: IntArray, others: Feet, which: BoolArray) -> None:
        """Put those of other feet at places of these."""
        for name in ("parameters", "distances", "asides", "on_border", "by_border"):
            getattr(self, name)[places] = getattr(others, name)[which]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Grid:
    """Nodes from which feet are looked for.

    Attributes:
        parameters: (n, 2) of the patch.
        tree: of their points.
        reaches: (n,) how far the next nodes lie at most, roughly, mm.
        cells: (2,) the steps of the parameters between them.
    """

    parameters: Array
    tree: cKDTree
    reaches: Array
    cells: Array

    def nearest(self, points: Array, count: int) -> tuple[Array, IntArray]:
        """The nearest nodes of each of (m, 3) points: (m, count) distances in mm, and numbers."""
        distances, nodes = self.tree.query(points, k=np.arange(1, count + 1))
        return np.asarray(distances), np.asarray(nodes, dtype=np.intp)


def _grid_over(patch: Patch) -> _Grid:
    """The closer the grid, the more spans the surface has: a wave or a fold takes a few of them."""
    surface = patch.surface
    spans = np.array(spans_of(surface))
    counts = np.clip(SPAN_NODES * spans, GRID, MOST_GRID)
    # Not on the border, where a surface may have a pole and no way to go on from there.
    along, across = ((np.arange(count) + 0.5) / count for count in counts.tolist())
    parameters = patch.at(0, np.repeat(along, len(across)), np.tile(across, len(along)))
    points, along_u, along_v = evaluate(surface, parameters)
    cells = np.ptp(patch.bounds, axis=1) / counts
    return _Grid(
        parameters=parameters,
        tree=cKDTree(points),
        reaches=norm(along_u) * cells[0] + norm(along_v) * cells[1],
        cells=cells,
    )


class Search:
    """Finds nearest points on one patch by Newton's method, all points at once.

    (The kernel's own projection fails on some surfaces without a word.)
    """

    def __init__(self, patch: Patch) -> None:
        """Search on a patch, over which a grid is laid once it is needed."""
        self.patch = patch

    @cached_property
    def _grid(self) -> _Grid:
        return _grid_over(self.patch)

    def feet(self, points: Array, start: Array | None = None) -> Feet:
        """The feet of (m, 3) points, looked for from (m, 2) `start`, or from the nearest of a grid.

        Where a patch comes near itself, the nearest of the grid may lie on the wrong layer: unless the foot is on the
        point, it is looked for from others as well.
        """
        if start is not None:
            return self._feet_from(points, start.copy())
        grid = self._grid
        found = self._feet_from(points, grid.parameters[grid.nearest(points, 1)[1][:, 0]])
        unsure = np.flatnonzero(found.distances > CLOSE)
        if not len(unsure):
            return found
        near, nodes = grid.nearest(points[unsure], NODES)
        # No foot is nearer than its node by more than about a cell.
        hopeful = near - grid.reaches[nodes] < found.distances[unsure, None]
        seen = found.parameters[unsure]
        for _ in range(LAYERS):
            away = np.abs(grid.parameters[nodes] - seen[:, None]) / grid.cells
            hopeful &= (away > APART).any(axis=2)
            rows = np.flatnonzero(hopeful.any(axis=1))
            if not len(rows):
                break
            seen[rows] = grid.parameters[nodes[rows, hopeful[rows].argmax(axis=1)]]
            others = self._feet_from(points[unsure[rows]], seen[rows].copy())
            nearer = others.distances < found.distances[unsure[rows]] - SAME
            found.take(unsure[rows[nearer]], others, nearer)
        return found

    def _feet_from(self, points: Array, uv: Array) -> Feet:
        """The feet of (m, 3) points, looked for from (m, 2) parameters, which are changed to theirs."""
        patch = self.patch
        low, high = patch.bounds[:, 0], patch.bounds[:, 1]
        values = np.stack(evaluate(patch.surface, uv), axis=1)
        parts = np.ones(len(points))
        going = np.arange(len(points))
        for _ in range(STEPS):
            at, (feet, along_u, along_v) = uv[going], np.moveaxis(values[going], 1, 0)
            away = points[going] - feet
            step = _newton(away, along_u, along_v)
            # A parameter on the border that wants to go beyond it stays there, and the other one moves alone.
            blocked = np.asarray(((at <= low) & (step < 0.0)) | ((at >= high) & (step > 0.0)))
            if blocked.any():
                step = np.where(np.any(blocked, axis=1)[:, None], _alone(away, along_u, along_v, blocked), step)
            new = np.clip(at + parts[going, None] * step, low, high)
            found = np.stack(evaluate(patch.surface, new), axis=1)
            # Where the surface bends much on the way, a whole step may lead away.
            nearer = norm(points[going] - found[:, 0]) <= norm(away)
            parts[going] = np.where(nearer, np.minimum(LONGER * parts[going], 1.0), parts[going] / LONGER)
            uv[going[nearer]], values[going[nearer]] = new[nearer], found[nearer]
            going = going[np.abs(new - at).max(axis=1) > SMALL_STEP * np.ptp(patch.bounds)]
            if not len(going):
                break
        feet, along_u, along_v = np.moveaxis(values, 1, 0)
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


def _alone(away: Array, along_u: Array, along_v: Array, blocked: BoolArray) -> Array:
    """The step in the parameter that is not blocked."""
    steps = [
        np.sum(away * along, axis=1) / np.maximum(np.sum(along * along, axis=1), np.finfo(float).tiny)
        for along in (along_u, along_v)
    ]
    return np.where(blocked, 0.0, np.stack(steps, axis=1))
