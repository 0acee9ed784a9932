"""Seams that are drawn level: rings that close in one plane, and those that were cut level.

People see at once whether the rings of a column lie in planes. A ring is a row of seams that goes on straight from
panel to panel, across corners at which four panels meet, until it comes back to where it began.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.reference.model import Reference

# A ring lies in a plane that none of its drawn points leaves by more than this share of its size; one whose points lie
# nearer to a line than that tells no plane.
_FLAT, _WIDE = 2e-4, 1e-2
_UP = np.array([0.0, 0.0, 1.0])
# The edges of a panel with four sides, end 0, end 1, side 0, side 1: both ends of each are ends of another one.
_BESIDE_FOUR = np.array([[[2, 0], [3, 0]], [[2, 1], [3, 1]], [[0, 0], [1, 0]], [[0, 1], [1, 1]]])


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelEdges:
    """Edges of panels on level seams, panel by panel.

    Attributes:
        panels, edges: (e,) which edges.
        points, normals: (e, 3) the plane that each is drawn in, mm.
    """

    panels: IntArray
    edges: IntArray
    points: Array
    normals: Array


def level_edges(reference: Reference) -> LevelEdges:
    """The edges on rings that are drawn in one plane; where the reference was cut level, those at all cuts besides."""
    found: dict[tuple[int, int], tuple[Array, Array]] = {}
    if reference.settings.seams == "level":
        for seam in reference.seams:
            for panel, edge in zip(seam.panels, seam.edges, strict=True):
                if reference.panels[panel].four_sided and edge < 2:
                    drawn = reference.panels[panel].edges[edge]
                    middle = 0.5 * (drawn.min(axis=0) + drawn.max(axis=0))
                    found[panel, edge] = middle, _UP
    for ring in rings(reference):
        plane = _plane(np.concatenate([reference.panels[panel].edges[edge] for panel, edge in ring]))
        if plane is not None:
            found |= dict.fromkeys(ring, plane)
    order = sorted(found)
    where = np.array(order, dtype=np.intp).reshape(-1, 2)
    planes = np.array([found[one] for one in order]).reshape(-1, 2, 3)
    return LevelEdges(panels=where[:, 0], edges=where[:, 1], points=planes[:, 0], normals=planes[:, 1])


def rings(reference: Reference) -> list[list[tuple[int, int]]]:
    """The edges (panel, edge) on each row of seams that closes to a ring, those of both panels of every seam."""
    darts = _Darts.of(reference)
    count = len(darts.beside)
    # Round a corner: to the other edge of the panel, across it, to the edge beside that, which goes on from the seam.
    on = _then(darts.beside, _then(darts.across, darts.beside))
    # From the panel on the other side of the seam it goes on in the same seam.
    goes_on = (_then(on, darts.across) >= 0) & (_then(on, darts.across) == _then(darts.across, on))
    rows = np.flatnonzero(darts.across >= 0)
    pairs = [(rows, rows ^ 1), (rows, darts.across[rows]), (np.flatnonzero(goes_on), on[goes_on])]
    first, second = (np.concatenate(part) for part in zip(*pairs, strict=True))
    links = coo_array((np.ones(len(first), dtype=bool), (first, second)), shape=(count, count))
    components, label = connected_components(links, directed=False)
    open_ = np.zeros(components, dtype=bool)
    open_[label[~goes_on]] = True
    closed = np.flatnonzero(~open_[label])
    closed = closed[closed % 2 == 0]  # one end of every edge
    found: dict[int, list[tuple[int, int]]] = {}
    for dart, row in zip((closed // 2).tolist(), label[closed].tolist(), strict=True):
        found.setdefault(row, []).append((dart // darts.most, dart % darts.most))
    return list(found.values())


@dataclass(frozen=True, slots=True, kw_only=True)
class _Darts:
    """Both ends of all edges of all panels: end e of edge k of panel p is number 2 (most p + k) + e.

    Attributes:
        most: edges of a panel at most.
        beside: of each the end of another edge of its panel at the same corner; -1 where there is none.
        across: of each the end of the other panel's edge that it meets there; -1 where the edge lies on no seam.
    """

    most: int
    beside: IntArray
    across: IntArray

    @staticmethod
    def of(reference: Reference) -> _Darts:
        panels, seams = reference.panels, reference.seams
        most = max(len(panel.edges) for panel in panels)
        beside = np.full((len(panels), most, 2), -1, dtype=np.intp)
        for place, panel in enumerate(panels):
            own = _BESIDE_FOUR if panel.four_sided else _beside_polygon(len(panel.edges))
            beside[place, : len(own)] = 2 * (most * place + own[..., 0]) + own[..., 1]
        across = np.full(2 * most * len(panels), -1, dtype=np.intp)
        met = np.array([(*seam.panels, *seam.edges, seam.reversed) for seam in seams], dtype=np.intp).reshape(-1, 5)
        first, second = (2 * (most * met[:, side] + met[:, 2 + side]) for side in (0, 1))
        for end in (0, 1):
            other = second + (end ^ met[:, 4])
            across[first + end], across[other] = other, first + end
        # Of an edge that lies on several seams it is not known which goes on.
        edges, times = np.unique(np.concatenate([first, second]), return_counts=True)
        several: BoolArray = np.isin(across - across % 2, edges[times > 1]) | np.isin(
            np.arange(len(across)) // 2 * 2, edges[times > 1]
        )
        across[several] = -1
        return _Darts(most=most, beside=beside.reshape(-1), across=across)


def _beside_polygon(corners: int) -> IntArray:
    """(corners, 2, 2) the edge and its end that lie at both ends of each edge of a polygon."""
    own = np.arange(corners)
    before = np.stack([(own - 1) % corners, np.ones_like(own)], axis=1)
    after = np.stack([(own + 1) % corners, np.zeros_like(own)], axis=1)
    return np.stack([before, after], axis=1)


def _then(first: IntArray, second: IntArray) -> IntArray:
    """One step after another, -1 where one of them leads nowhere."""
    return np.where(first >= 0, second[first], -1)


def _plane(points: Array) -> tuple[Array, Array] | None:
    """The middle and the unit normal of the plane that points (m, 3) lie in; None where they lie in none."""
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    _, sizes, ways = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    normal = ways[2]
    heights = (points - middle) @ normal
    if sizes[1] < _WIDE * sizes[0] or np.ptp(heights) > _FLAT * float(np.linalg.norm(np.ptp(points, axis=0))):
        return None
    return middle + 0.5 * (heights.min() + heights.max()) * normal, normal
