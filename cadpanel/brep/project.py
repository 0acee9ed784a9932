"""Curves near a surface, brought onto its faces as curves of their parameter planes.

Every point goes to its nearest point on the surface by Newton's method, all points at once. (The kernel's own
projection of curves fails on some surfaces without a word.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepLib import BRepLib
from OCP.TopoDS import TopoDS_Edge
from scipy.interpolate import make_interp_spline
from scipy.spatial import cKDTree

from cadpanel.brep.boundary import evaluate
from cadpanel.brep.connect import Surface
from cadpanel.brep.patch import Patch, geometry
from cadpanel.brep.slices import DEGREE, spline_curve
from cadpanel.reference.polyline import norm

Array = NDArray[np.float64]

# Grid lines each way from which the nearest point of a patch is looked for, and steps of Newton's method from there.
GRID = 41
STEPS = 20
SMALL_STEP = 1e-12
# A foot this close to the border of the parameter range lies on it, as a part of the range.
ON_BORDER = 1e-9
# Numbers of points that are tried in turn until the curve through them is as close as CLOSE, mm, between them.
COUNTS = (9, 17, 33, 65, 129)
CLOSE = 1e-3
FEWEST_POINTS = 4
# A jump of more than this part of the parameter range goes over the seam of a closed surface.
JUMP = 0.5
# Halvings by which the place is found where a curve leaves a face.
HALVINGS = 40
# A stretch along a border shorter than this many tolerances is where a curve crosses it.
LONG_STRETCH = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Feet:
    """Nearest points on a patch: (m, 2) parameters, (m,) distances in mm, and (m,) whether each is on the border."""

    parameters: Array
    distances: Array
    on_border: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class Landing:
    """What a set of curves leaves on a surface.

    Attributes:
        edges: for each curve its edges on the faces, none where it does not pass over the surface.
        offset: how far the farthest point of a curve lies off the surface, mm.
    """

    edges: tuple[tuple[TopoDS_Edge, ...], ...]
    offset: float


def land(surface: Surface, curves: Sequence[Array], reach: float, tolerance: float) -> Landing:
    """Bring curves onto a surface.

    Args:
        surface: onto which.
        curves: (q, 3) points along each, close enough that straight lines between them follow it, mm.
        reach: how far off the surface a curve may lie, mm; what is farther away does not pass over it.
        tolerance: a curve that ends this close to the border of a face, or runs along it, reaches it, mm.
    """
    if not curves:
        return Landing(edges=(), offset=0.0)
    edges: list[list[TopoDS_Edge]] = [[] for _ in curves]
    offset = 0.0
    sizes = [len(curve) for curve in curves]
    starts = np.concatenate([[0], np.cumsum(sizes)]).tolist()
    points = np.concatenate(curves)
    for face in surface.faces:
        search = _Search(face.patch)
        feet = search.feet(points)
        for index, curve in enumerate(curves):
            own = slice(starts[index], starts[index + 1])
            found = Feet(parameters=feet.parameters[own], distances=feet.distances[own], on_border=feet.on_border[own])
            for line, off in _stretches(search, curve, found, reach, tolerance):
                edges[index].append(_edge(face.patch, line))
                offset = max(offset, off)
    return Landing(edges=tuple(tuple(parts) for parts in edges), offset=offset)


class _Search:
    """Finds nearest points on one patch."""

    def __init__(self, patch: Patch) -> None:
        self.patch = patch
        parts = np.linspace(0.0, 1.0, GRID)
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
        margin = ON_BORDER * (high - low)
        on_border = np.asarray(np.any((uv <= low + margin) | (uv >= high - margin), axis=1), dtype=np.bool_)
        return Feet(
            parameters=uv,
            distances=norm(points - patch.points(uv)),
            on_border=on_border,
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


def _stretches(search: _Search, curve: Array, feet: Feet, reach: float, tolerance: float) -> list[tuple[Array, float]]:
    """The stretches of a curve over a patch: (k, 2) parameters along each, and its largest offset, mm."""
    found = []
    inside = (feet.distances <= reach) & ~feet.on_border
    for first, last in _runs(inside, feet.parameters, search.patch):
        line = feet.parameters[first : last + 1]
        before = _end(search, curve, feet, first, -1, tolerance)
        after = _end(search, curve, feet, last, 1, tolerance)
        found.append((np.concatenate([before, line, after]), float(feet.distances[first : last + 1].max())))
    beside = (feet.distances <= tolerance) & feet.on_border
    for first, last in _runs(beside, feet.parameters, search.patch):
        line = feet.parameters[first : last + 1]
        if norm(np.diff(search.patch.points(line), axis=0)).sum() > LONG_STRETCH * tolerance:
            found.append((line, float(feet.distances[first : last + 1].max())))
    return found


def _runs(chosen: NDArray[np.bool_], parameters: Array, patch: Patch) -> list[tuple[int, int]]:
    """First and last index of each run of chosen points, parted where the parameters jump over a seam."""
    places = np.flatnonzero(chosen)
    if not len(places):
        return []
    jumps = (np.abs(np.diff(parameters[places], axis=0)) > JUMP * np.ptp(patch.bounds, axis=1)).any(axis=1)
    breaks = np.flatnonzero((np.diff(places) > 1) | jumps)
    firsts = np.concatenate([[0], breaks + 1])
    lasts = np.concatenate([breaks, [len(places) - 1]])
    return list(zip(places[firsts].tolist(), places[lasts].tolist(), strict=True))


def _end(search: _Search, curve: Array, feet: Feet, place: int, side: int, tolerance: float) -> Array:
    """What to add to a stretch at one end, so that it reaches the border where the curve does: (0 or 1, 2)."""
    bounds = search.patch.bounds
    other = place + side
    if 0 <= other < len(curve):
        inner, outer, start = curve[place], curve[other], feet.parameters[place : place + 1]
        for _ in range(HALVINGS):
            middle = 0.5 * (inner + outer)
            foot = search.feet(middle[None], start)
            if foot.on_border[0]:
                outer = middle
            else:
                inner, start = middle, foot.parameters
        end = search.feet(outer[None], start).parameters[0]
        if np.abs(end - feet.parameters[place]).max() > JUMP * np.ptp(bounds, axis=1).max():
            end = _clamped(feet.parameters[place], bounds)
        return np.asarray(end[None], dtype=np.float64)
    # The curve's own end: a border within the tolerance was meant.
    here = feet.parameters[place]
    _, along_u, along_v = evaluate(search.patch.surface, here[None])
    speeds = np.array([np.linalg.norm(along_u), np.linalg.norm(along_v)])
    gaps = np.abs(here[:, None] - bounds) * speeds[:, None]
    axis, border = np.unravel_index(int(gaps.argmin()), gaps.shape)
    if gaps[axis, border] > tolerance:
        return np.zeros((0, 2))
    reached = here.copy()
    reached[axis] = bounds[axis, border]
    return np.asarray(reached[None], dtype=np.float64)


def _clamped(parameters: Array, bounds: Array) -> Array:
    """The parameters moved to the nearest border of the range."""
    parts = np.abs(parameters[:, None] - bounds) / np.ptp(bounds, axis=1)[:, None]
    axis, border = np.unravel_index(int(parts.argmin()), parts.shape)
    moved = parameters.copy()
    moved[axis] = bounds[axis, border]
    return moved


def _edge(patch: Patch, line: Array) -> TopoDS_Edge:
    """The edge on a patch through (k, 2) parameters, with no more poles than it needs."""
    points = patch.points(line)
    reached = np.concatenate([[0.0], np.cumsum(norm(np.diff(points, axis=0)))])
    keep = np.concatenate([[True], np.diff(reached) > 1e-9 * reached[-1]])
    line, points, reached = line[keep], points[keep], reached[keep] / reached[-1]
    degree = min(DEGREE, len(line) - 1)
    whole = make_interp_spline(reached, line, k=degree)
    for count in COUNTS:
        places = np.linspace(0.0, 1.0, count)
        spline = make_interp_spline(places, whole(places), k=degree)
        if norm(patch.points(np.asarray(spline(reached))) - points).max() <= CLOSE:
            break
    edge = BRepBuilderAPI_MakeEdge(spline_curve(spline), geometry(patch)).Edge()
    BRepLib.BuildCurves3d_s(edge)
    return edge
