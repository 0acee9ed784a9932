"""How far outlines are from each other: the reference's from the skin's surface, and the two boundaries both ways."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.deviation import deviations
from cadpanel.fitting.measures.edges import alike, edge_curves, edges_of
from cadpanel.geometry.end_curves import closest
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import PanelReference, Reference


def outline_distances(shapes: Sequence[Panel], reference: Reference) -> Array:
    """(panels, q) distance of the reference's outline to the skin's patches, mm."""
    lines = _outlines(reference)
    return np.abs(deviations(shapes, lines.reshape(len(lines), -1, 3)))


def overhang(shapes: Sequence[Panel], reference: Reference) -> Array:
    """(panels,) how far the skin's and the reference's boundaries reach beyond each other, mm.

    Inside both outlines the two surfaces are apart by the deviation; what the Hausdorff distance adds happens at the
    boundaries: each point of one to the nearest of the other.
    """
    lines = _outlines(reference)
    centre = lines.mean(axis=(0, 1, 2))
    result = np.zeros(len(shapes))
    for members in alike(shapes):
        group = [shapes[i] for i in members]
        for place in range(len(edges_of(group[0]))):
            curves = edge_curves(group, [place] * len(group), centre)
            stations = curves.stations()
            points, _ = curves.follow(np.broadcast_to(stations, (len(group), len(stations))))
            line = lines[members, place] - centre
            there, back = polyline_distance(points, line).max(axis=1), closest(curves, line)[0].max(axis=1)
            result[members] = np.maximum(result[members], np.maximum(there, back))
    return result


def _outlines(reference: Reference) -> Array:
    """(panels, edges, q, 3) points along every edge of every outline, mm; short outlines repeat their first edge."""
    count = max(len(line) for panel in reference.panels for line in panel.edges)
    most = max(len(panel.edges) for panel in reference.panels)
    return np.array([_filled(panel, most, count) for panel in reference.panels])


def _filled(panel: PanelReference, edges: int, count: int) -> list[Array]:
    lines = [_resample(line, count) for line in panel.edges]
    return lines + [lines[0]] * (edges - len(lines))


def _resample(line: Array, count: int) -> Array:
    # Repeating points is enough to bring all polylines to one length.
    return line[np.round(np.linspace(0, len(line) - 1, count)).astype(np.intp)]


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
