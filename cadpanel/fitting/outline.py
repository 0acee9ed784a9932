"""The reference's outline as the drift limits see it: where each corner belongs, and which way along and across are."""

from __future__ import annotations

from itertools import islice, pairwise

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.edge_pieces import boundary_points, edge_pieces
from cadpanel.features.layout import Layout
from cadpanel.features.panel_edges import ARC_SHARES, Edge
from cadpanel.fitting.start.begin import Start
from cadpanel.reference.edge_planes import edge_planes, turned_edges
from cadpanel.reference.free_edges import free_edges
from cadpanel.reference.level_seams import level_edges
from cadpanel.reference.model import PanelReference, Reference
from cadpanel.reference.strip import strips_of
from cadpanel.terms.outline import Level, Limited, Line, Outline, Pieces
from cadpanel.terms.state import State


def outline_of(reference: Reference, layout: Layout, begin: Start) -> Outline:
    """The outline's corners, and on the ends the points that a fold's corners start nearest to."""
    started = State(layout, layout.walk(begin.unknowns[0], derivatives=False)).corners.position
    corners = np.zeros(started.shape)
    sided = np.zeros(layout.panels, dtype=bool)
    most = started.shape[1]
    ways = _ways(reference, layout)
    along, across = _Rows(layout.panels, most, 1), _Rows(layout.panels, most, 3)
    for i, panel in enumerate(reference.panels):
        feature, axes = layout.feature_of[i], begin.axes[i]
        count = feature.corner_count
        if not feature.four_sided:
            corners[i, :count] = (panel.corners.reshape(-1, 3) - begin.origins[i]) @ axes / begin.length
            across.set(i, np.arange(count), np.broadcast_to(np.eye(3), (count, 3, 3)))
            continue
        sided[i] = True
        rulings = count // 2
        own = started[i, :count].reshape(2, rulings, 3) * begin.length @ axes.T + begin.origins[i]
        corners[i, :count] = (_on_outline(panel, own).reshape(-1, 3) - begin.origins[i]) @ axes / begin.length
        way, gauge = (vectors @ axes for vectors in ways[i])
        along.set(i, np.arange(count), gauge[:, None])
        outer = np.array([0, rulings - 1, rulings, count - 1])
        across.set(i, outer, np.eye(3) - way[outer, :, None] * gauge[outer, None, :])
    return Outline(
        corners=corners,
        along=along.limited(),
        across=across.limited(),
        sided=sided,
        pieces=_pieces(reference, layout, begin),
        level=_level(reference, layout, begin),
        line=_line(reference, layout, begin),
    )


# Where on a straight free edge, and on a straight piece of another one, it is held to the drawn one: shares of lengths.
_ON_STRAIGHT, _ON_PIECE = np.linspace(0.0, 1.0, 9), np.linspace(0.0, 1.0, 5)


def _line(reference: Reference, layout: Layout, begin: Start) -> Line:
    """Points of all free edges, and the drawn ones."""
    free = free_edges(reference)
    padded = max(group.feature.corner_count for group in layout.groups)
    edges = [layout.feature_of[i].edges[e] for i, e in zip(free.panels.tolist(), free.edges.tolist(), strict=True)]
    rows = [_held_points(edge, padded) for edge in edges]
    most = max(map(len, rows), default=1)
    # One that has fewer points than another holds its last one several times.
    points = np.array([[*row, *[row[-1]] * (most - len(row))] for row in rows]).reshape(-1, most, 3)
    straight = np.array([edge.straight for edge in edges], dtype=bool)
    drawn = (free.lines - begin.origins[free.panels][:, None]) @ begin.axes[free.panels] / begin.length
    return Line(
        panels=free.panels,
        places=points[..., :2].astype(np.intp),
        shares=points[..., 2],
        drawn=drawn,
        straight=straight,
    )


def _held_points(edge: Edge, padded: int) -> list[tuple[float, float, float]]:
    """Between which two points of the boundary each point of an edge lies, and how far on the way."""
    if edge.straight:
        return [(float(edge.corners[0]), float(edge.corners[-1]), share) for share in _ON_STRAIGHT.tolist()]
    found: list[tuple[float, float, float]] = []
    arcs = iter(edge.arcs)
    for (first, second), curved in zip(pairwise(edge.corners), edge.curved, strict=True):
        if curved:
            found += [(padded + arc, padded + arc, 0.0) for arc in islice(arcs, len(ARC_SHARES))]
            found += [(first, first, 0.0), (second, second, 0.0)]
        else:
            found += [(first, second, share) for share in _ON_PIECE.tolist()]
    return found


def _pieces(reference: Reference, layout: Layout, begin: Start) -> Pieces:
    """The pieces of all edges that may not turn."""
    planes, lengths = edge_planes(reference.panels)
    limited = turned_edges(reference)
    own = [edge_pieces(feature.edges) for feature in layout.feature_of]
    most = max(len(pieces.edge) for pieces in own)
    points, normals, sizes = np.zeros((layout.panels, most, 2), dtype=np.intp), *np.zeros((2, layout.panels, most, 3))
    for i, pieces in enumerate(own):
        held = limited[i, pieces.edge]
        count = int(held.sum())
        points[i, :count] = pieces.points[held]
        normals[i, :count] = planes[i, pieces.edge[held]] @ begin.axes[i]
        sizes[i, :count, 0] = lengths[i, pieces.edge[held]] / begin.length
    used = normals.any(axis=(0, 2))
    return Pieces(points=points[:, used], planes=normals[:, used], lengths=sizes[:, used, 0])


def _level(reference: Reference, layout: Layout, begin: Start) -> Level:
    """Corners and arc points of all edges on level seams."""
    drawn = level_edges(reference)
    edges = [layout.feature_of[i].edges[e] for i, e in zip(drawn.panels.tolist(), drawn.edges.tolist(), strict=True)]
    rows = [boundary_points(edge) for edge in edges]
    own = np.repeat(np.arange(len(rows)), [len(row) for row in rows])
    panels = drawn.panels[own]
    offsets = np.einsum("gx,gx->g", drawn.points[own] - begin.origins[panels], drawn.normals[own]) / begin.length
    return Level(
        panels=panels,
        points=np.array([point for row in rows for point in row], dtype=np.intp),
        normals=np.einsum("gx,gxa->ga", drawn.normals[own], begin.axes[panels]),
        offsets=offsets,
    )


def _ways(reference: Reference, layout: Layout) -> dict[int, tuple[Array, Array]]:
    """For each panel with four sides the directions (corners, 3) along the strip, and the gauges (corners, 3)."""
    members: dict[int, list[int]] = {}
    for i, feature in enumerate(layout.feature_of):
        if feature.four_sided:
            members.setdefault(feature.corner_count, []).append(i)
    ways: dict[int, tuple[Array, Array]] = {}
    for count, own in members.items():
        strips = strips_of([reference.panels[i] for i in own], count // 2)
        flat = (vectors.reshape(len(own), count, 3) for vectors in (strips.direction, strips.gauge))
        ways |= zip(own, zip(*flat, strict=True), strict=True)
    return ways


class _Rows:
    """Rows of all panels under construction, filled up with zeros."""

    def __init__(self, panels: int, most: int, size: int) -> None:
        self._corners = np.zeros((panels, most), dtype=np.intp)
        self._part = np.zeros((panels, most, size, 3))
        self._used = 0

    def set(self, panel: int, corners: IntArray, part: Array) -> None:
        self._corners[panel, : len(corners)] = corners
        self._part[panel, : len(corners)] = part
        self._used = max(self._used, len(corners))

    def limited(self) -> Limited:
        return Limited(corners=self._corners[:, : self._used], part=self._part[:, : self._used])


def _on_outline(panel: PanelReference, started: Array) -> Array:
    """(2, k + 1, 3) the outline's corners, and on its ends the points nearest to inner corners (2, k + 1, 3), mm."""
    corners = np.empty_like(started)
    for end, line in enumerate(panel.ends):
        nearest = np.argmin(np.linalg.norm(line[None] - started[end, 1:-1, None], axis=-1), axis=1)
        corners[end] = line[[0, *nearest, -1]]
    return corners
