"""How far the boundaries of skin and reference reach beyond each other; millimetres.

Only the farthest place of a panel counts. So every place of either boundary is first given a distance that its own
cannot exceed, to a point of the other boundary that is likely to be the closest; only places whose bound is above what
was found elsewhere on the panel are then looked at closely.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.geometry.closest_points import Stations, closest_points, distances_near, stations
from cadpanel.geometry.conic_chains import followed
from cadpanel.geometry.end_curves import EndCurves, as_chains
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import dot, norm
from cadpanel.reference.model import Reference

# Panels that are measured together: enough to make the cost of a call small, few enough to stay in the cache.
_TOGETHER = 128
# Steps along an outline towards the closest point; each goes as far as the chord that was reached tells.
_STEPS = 2
# Bounds within this share of what was found are no larger.
_SAME = 1e-12


def overhang(edges: PanelEdges, reference: Reference) -> Array:
    """(panels,) how far the skin's and the reference's boundaries reach beyond each other, mm.

    Inside both outlines the two surfaces are apart by the deviation; what the Hausdorff distance adds happens at the
    boundaries: each point of one to the nearest of the other.
    """
    result = np.zeros(len(reference.panels))
    for start in range(0, len(result), _TOGETHER):
        panels = np.arange(start, min(start + _TOGETHER, len(result)))
        _measure(list(_pairs(edges, reference, panels)), result)
    return result


def _measure(pairs: Sequence[_Pair], result: Array) -> None:
    """Raise the result (panels,) to what the pairs of edges show."""
    top = np.zeros(len(result))
    for pair in pairs:
        np.maximum.at(top, pair.panels, pair.bounds.max(axis=1))
    # What is farthest at first sight mostly is, and rules out most of the rest.
    for pair in pairs:
        places = pair.bounds.argmax(axis=1)
        likely = np.flatnonzero(pair.bounds[np.arange(len(places)), places] == top[pair.panels])
        _look(pair, likely, places[likely], result)
    for pair in pairs:
        rows, places = np.nonzero(pair.bounds > (1.0 + _SAME) * result[pair.panels][:, None])
        _look(pair, rows, places, result)


def _look(pair: _Pair, rows: IntArray, places: IntArray, result: Array) -> None:
    if len(rows):
        pair.bounds[rows, places] = pair.distances(rows, places)
        np.maximum.at(result, pair.panels[rows], pair.bounds[rows, places])


@dataclass(frozen=True, slots=True)
class _Pair:
    """m edges of skins and the outlines that they belong to, each pair seen from a corner of its own.

    Attributes:
        panels: (m,) whose.
        curves: the skins' edges.
        points: (m, s, 3) on them.
        lines: (m, q, 3) points of the outlines.
        bounds: (m, s + q) what the distance from each of the points and from each of the outlines' is at most.
    """

    panels: IntArray
    curves: Stations
    points: Array
    lines: Array
    bounds: Array

    @staticmethod
    def of(panels: IntArray, curves: EndCurves, lines: Array) -> _Pair:
        """Edges and their outlines (m, q, 3), both in the same coordinates."""
        origin = curves.corners[:, 0]
        chains, lines = as_chains(curves, origin), lines - origin[:, None]
        u = curves.stations()
        piece, w = _split(np.broadcast_to(u, (len(lines), len(u))), chains.pieces)
        at = np.moveaxis(followed(np.take(chains.curves, piece.ravel(), axis=1), w.ravel()), 0, 1)
        points = np.ascontiguousarray(at).reshape(len(lines), len(u), 3)
        along, length = arc_length(points), arc_length(lines)
        shares = along / np.maximum(along[:, -1:], np.finfo(float).tiny)
        there = _near_lines(points, shares, lines, length)
        near = _interpolated(length / np.maximum(length[:, -1:], np.finfo(float).tiny), shares, u)
        column, w = _split(near, chains.pieces)
        flat = np.moveaxis(lines, 2, 0).reshape(3, -1)
        back = distances_near(chains, column.ravel(), w.ravel(), flat).reshape(column.shape)
        return _Pair(panels, stations(chains), points, lines, np.concatenate([there, back], axis=1))

    def distances(self, rows: IntArray, places: IntArray) -> Array:
        """(k,) the distances themselves at places (k,) of rows (k,)."""
        found = np.empty(len(rows))
        count = self.points.shape[1]
        there = places < count
        at = rows[there]
        found[there] = polyline_distance(self.points[at, places[there]][:, None], self.lines[at])[:, 0]
        at = rows[~there]
        found[~there] = closest_points(self.curves, at, self.lines[at, places[~there] - count].T)[2]
        return found


def _pairs(edges: PanelEdges, reference: Reference, panels: IntArray) -> Iterator[_Pair]:
    """The edges of some panels with their outlines, those together that are curves and polylines of a kind."""
    batch, row = edges.batch[panels], edges.row[panels]
    counts = np.zeros(batch.shape, dtype=np.intp)
    for i, panel in enumerate(panels):
        lines = reference.panels[panel].edges
        counts[i, : len(lines)] = [len(line) for line in lines]
    for kind, curves in enumerate(edges.curves):
        for count in np.unique(counts[batch == kind]).tolist():
            which, on = np.nonzero((batch == kind) & (counts == count))
            found = [reference.panels[i].edges[k] for i, k in zip(panels[which].tolist(), on.tolist(), strict=True)]
            yield _Pair.of(panels[which], curves.take(row[which, on]), np.array(found) - edges.centre)


def _split(u: Array, pieces: int) -> tuple[IntArray, Array]:
    """Columns and shares of the places u (m, s) of m chains."""
    piece = np.clip(np.floor(u).astype(np.intp), 0, pieces - 1)
    return piece + pieces * np.arange(len(u))[:, None], u - piece


def _interpolated(at: Array, shares: Array, values: Array) -> Array:
    """(m, q) the values (s,), known at rising shares (m, s) from 0 to 1, at shares (m, q)."""
    row = np.arange(len(at))[:, None]
    # All rows in one call: each on a stretch of its own.
    known = np.broadcast_to(values, shares.shape).ravel()
    return np.interp((at + 2 * row).ravel(), (shares + 2 * row).ravel(), known).reshape(at.shape)


def _near_lines(points: Array, shares: Array, lines: Array, length: Array) -> Array:
    """(m, s) distances of points (m, s, 3) to chords of lines (m, q, 3) near shares (m, s) of their lengths (m, q)."""
    rows, last = np.arange(len(lines))[:, None], lines.shape[1] - 2
    whole = np.maximum(length[:, -1:], np.finfo(float).tiny)
    steps = np.diff(lines, axis=1)
    sizes = np.maximum(np.diff(length, axis=1), np.finfo(float).tiny)
    ends = (length / whole + 2 * rows).ravel()
    at, least = shares, np.full(points.shape[:2], np.inf)
    for _ in range(_STEPS):
        found = np.searchsorted(ends, (at + 2 * rows).ravel(), side="right").reshape(at.shape) - 1 - rows * (last + 2)
        chord = np.clip(found, 0, last)
        away, step, size = points - lines[rows, chord], steps[rows, chord], sizes[rows, chord]
        along = dot(away, step) / size**2
        least = np.minimum(least, norm(away - np.clip(along, 0.0, 1.0)[..., None] * step))
        at = np.clip((length[rows, chord] + along * size) / whole, 0.0, 1.0)
    return least


def polyline_distance(points: Array, line: Array) -> Array:
    """(panels, q) distance of points (panels, q, 3) to outlines (panels, r, 3): to their chords, or to the curve.

    Half-way between two points of an arc its chord is off by the sagitta, which would be told as a distance; where the
    cubic through the four nearest points comes closer, that counts.
    """
    start, step = line[:, None, :-1], (line[:, 1:] - line[:, :-1])[:, None]
    square = np.maximum(np.sum(step**2, axis=-1), np.finfo(float).tiny)
    share = np.clip(np.sum((points[:, :, None] - start) * step, axis=-1) / square, 0.0, 1.0)
    foot = start + share[..., None] * step
    chords = np.sum((points[:, :, None] - foot) ** 2, axis=-1)
    nearest = chords.argmin(axis=2)
    rows = np.arange(len(line))[:, None]
    first = np.clip(nearest - 1, 0, line.shape[1] - 4)
    at = np.take_along_axis(share, nearest[..., None], axis=2)[..., 0] + nearest - first
    basis = [-(at - 1) * (at - 2) * (at - 3) / 6, at * (at - 2) * (at - 3) / 2]
    basis += [-at * (at - 1) * (at - 3) / 2, at * (at - 1) * (at - 2) / 6]
    curve = sum((weight[..., None] * line[rows, first + k] for k, weight in enumerate(basis)), np.zeros(points.shape))
    closer = np.minimum(chords.min(axis=2), np.sum((points - curve) ** 2, axis=-1))
    return np.asarray(np.sqrt(closer))
