"""Seams as the terms see them: batches that are alike, with the places of the points that meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.layout import Layout
from cadpanel.features.panel_edges import ARC_SHARES, Edge

# Where on a straight edge points are held to a curved one, as shares of its length.
_STRAIGHT_SHARES = (1 / 4, 1 / 2, 3 / 4)


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamBatch:
    """Seams of one kind, each with the lower panel first.

    Attributes:
        index: (s,) their places among all seams.
        panels: (s, 2).
        edges: (s, 2) which edge of each panel; an end's number is that of its cut plane.
        pair: (s,) which pair of coupled blocks.
        reversed: (s,) whether the second edge runs against the first.
        corners: (s, 2, m) corners that meet, by their places among the panels' corners, in the order of the first edge.
        curved: for each of the two edges which of its pieces are arcs, in the edge's own direction.
        alike: whether both edges have the same pieces; then all their corners meet, else only the outermost.
    """

    index: IntArray
    panels: IntArray
    edges: IntArray
    pair: IntArray
    reversed: BoolArray
    corners: IntArray
    curved: tuple[tuple[bool, ...], tuple[bool, ...]]
    alike: bool

    @property
    def blocks(self) -> tuple[IntArray, IntArray]:
        """(s,) the lower and the higher panels."""
        return self.panels[:, 0], self.panels[:, 1]

    def straight(self, side: int) -> bool:
        """Whether the edges of the first (0) or second (1) panels are segments."""
        return self.curved[side] == (False,)


@dataclass(frozen=True, slots=True, kw_only=True)
class Movers:
    """Points of one panel of each seam of a batch that are held to the other panel's edge.

    A point lies between two points of the panel's boundary (its corners, then its arc points).

    Attributes:
        places: (s, q, 2) which two.
        share: (q,) how far on the way from the first to the second.
    """

    places: IntArray
    share: Array


def batches(
    layout: Layout, panels: IntArray, edges: IntArray, backwards: BoolArray, pair: IntArray
) -> tuple[SeamBatch, ...]:
    """Group seams that are alike.

    Args:
        layout: the panels' features.
        panels: (seams, 2), the lower first.
        edges: (seams, 2).
        backwards: (seams,) whether the second edge runs against the first.
        pair: (seams,).
    """
    kinds: dict[tuple[tuple[bool, ...], tuple[bool, ...], bool], list[int]] = {}
    features = layout.feature_of
    for seam in range(len(panels)):
        one, other = (features[p].edges[e].curved for p, e in zip(panels[seam], edges[seam], strict=True))
        turned = other[::-1] if backwards[seam] else other
        kinds.setdefault((one, other, turned == one), []).append(seam)
    found = []
    for (one, other, alike), members in kinds.items():
        index = np.array(members, dtype=np.intp)
        corners = []
        for seam in members:
            first, second = (list(features[p].edges[e].corners) for p, e in zip(panels[seam], edges[seam], strict=True))
            second = second[::-1] if backwards[seam] else second
            corners.append((first, second) if alike else ([first[0], first[-1]], [second[0], second[-1]]))
        found.append(
            SeamBatch(
                index=index,
                panels=panels[index],
                edges=edges[index],
                pair=pair[index],
                reversed=backwards[index],
                corners=np.array(corners, dtype=np.intp),
                curved=(one, other),
                alike=alike,
            )
        )
    return tuple(found)


def ends_of(parts: Sequence[SeamBatch]) -> tuple[SeamBatch, ...]:
    """Batches in one, of which the outermost corners meet; none where there are none.

    With several features in one fit nearly every seam is of a kind of its own, and what looks at the ends of edges
    alone need not know of that.
    """
    if not parts:
        return ()
    corners = np.concatenate([one.corners[:, :, [0, -1]] for one in parts])
    names = ("index", "panels", "edges", "pair", "reversed")
    index, panels, edges, pair, backwards = (np.concatenate([getattr(one, name) for one in parts]) for name in names)
    whole = SeamBatch(
        index=index,
        panels=panels,
        edges=edges,
        pair=pair,
        reversed=backwards,
        corners=corners,
        curved=parts[0].curved,
        alike=False,
    )
    return (whole,)


def arc_places(layout: Layout, batch: SeamBatch, side: int) -> IntArray:
    """(s, q) the arc points of the batch's edges on one side, by their places among the panels' arc points."""
    features = layout.feature_of
    rows = [features[p].edges[e].arcs for p, e in zip(batch.panels[:, side], batch.edges[:, side], strict=True)]
    return np.array(rows, dtype=np.intp).reshape(len(rows), -1)


def movers(layout: Layout, batch: SeamBatch, side: int) -> Movers:
    """Inner corners and arc points of the edges on one side, or points on the segment where they are straight."""
    features = layout.feature_of
    corner_count = max(group.feature.corner_count for group in layout.groups)
    rows = []
    for p, e in zip(batch.panels[:, side], batch.edges[:, side], strict=True):
        rows.append(_places(features[p].edges[e], corner_count))
    share = np.array(_STRAIGHT_SHARES if batch.straight(side) else [0.0] * len(rows[0]))
    return Movers(places=np.array(rows, dtype=np.intp), share=share)


def _places(edge: Edge, corner_count: int) -> list[tuple[int, int]]:
    if edge.straight:
        first, last = edge.corners
        return [(first, last)] * len(_STRAIGHT_SHARES)
    return [(c, c) for c in edge.corners[1:-1]] + [(corner_count + a, corner_count + a) for a in edge.arcs]


def arc_patches(curved: Sequence[bool]) -> IntArray:
    """(q,) the piece that each arc point of an edge lies on."""
    return np.array([i for i, arc in enumerate(curved) if arc for _ in ARC_SHARES], dtype=np.intp)
