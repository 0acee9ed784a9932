"""Fitted panels as arrays, those with like edges together, and all their edges as curves; millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.panel_edges import Edge, chain_edges, polygon_edges
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import unit

Pieces = tuple[bool, ...]
"""For each piece of a curve whether it is an arc."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Alike:
    """m panels that have the same edges: chains of like patches, polygons of equally many corners.

    Attributes:
        members: (m,) which panels.
        edges: their boundary, edge by edge, in the order of their references' edges.
        four_sided: whether they have ends and sides.
        corners: (m, 2, k + 1, 3) of chains, (m, 1, c, 3) of polygons.
        p, t, n: (m, k + 1, 3) the rulings of k patches; (m, 1, 3) of polygons.
        cut_points, cut_normals: (m, 2, 3) the cut planes; (m, 0, 3) of polygons.
        radius, half_angle, sweep: (m, k); 0 for planes.
    """

    members: IntArray
    edges: tuple[Edge, ...]
    four_sided: bool
    corners: Array
    p: Array
    t: Array
    n: Array
    cut_points: Array
    cut_normals: Array
    radius: Array
    half_angle: Array
    sweep: Array

    def curves(self, edge: int, centre: Array) -> EndCurves:
        """One edge of each of the panels, seen from `centre` (3,): map-grid coordinates would cost digits in gaps."""
        if self.edges[edge].straight:
            return self._segments(self.edges[edge], centre)
        return EndCurves(
            corners=self.corners[:, edge] - centre,
            p=self.p - centre,
            t=self.t,
            n=self.n,
            radius=self.radius,
            half_angle=self.half_angle,
            sweep=self.sweep,
            cut_point=self.cut_points[:, edge] - centre,
            cut_normal=self.cut_normals[:, edge],
        )

    def _segments(self, edge: Edge, centre: Array) -> EndCurves:
        at = self.corners.reshape(len(self.members), -1, 3)[:, [edge.corners[0], edge.corners[-1]]] - centre
        # The skin's normal along a straight edge is that of its ruling; a chain's last ruling is its side 1.
        normals = self.n[:, -1 if edge.name == "side 1" else 0]
        along = unit(at[:, 1] - at[:, 0])
        flat = np.zeros((len(at), 1))
        return EndCurves(
            corners=at,
            p=at,
            t=np.stack([along, along], axis=1),
            n=np.stack([normals, normals], axis=1),
            radius=flat,
            half_angle=flat,
            sweep=flat,
            cut_point=at[:, 0],
            cut_normal=along,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelEdges:
    """All edges of fitted panels.

    Attributes:
        groups: the panels, those with like edges together.
        centre: (3,) a point among the panels, from where the curves are seen.
        pieces: of the curves of each batch.
        curves: the batches.
        batch, row: (panels, most edges) where the curve of each edge stands; where a panel has fewer edges, `batch` is
            that after the last.
    """

    groups: tuple[Alike, ...]
    centre: Array
    pieces: tuple[Pieces, ...]
    curves: tuple[EndCurves, ...]
    batch: IntArray
    row: IntArray

    @staticmethod
    def of(shapes: Sequence[Panel]) -> PanelEdges:
        """The edges of panels."""
        groups = alike(shapes)
        centre = sum((group.corners.mean(axis=(1, 2)).sum(axis=0) for group in groups), np.zeros(3)) / len(shapes)
        most = max(len(group.edges) for group in groups)
        batch, row = np.full((2, len(shapes), most), -1, dtype=np.intp)
        places: dict[Pieces, int] = {}
        parts: list[list[EndCurves]] = []
        for group in groups:
            for place, edge in enumerate(group.edges):
                at = places.setdefault(edge.curved, len(places))
                if at == len(parts):
                    parts.append([])
                batch[group.members, place] = at
                row[group.members, place] = sum(len(part.corners) for part in parts[at]) + np.arange(len(group.members))
                parts[at].append(group.curves(place, centre))
        batch[batch < 0] = len(parts)
        return PanelEdges(
            groups=groups,
            centre=centre,
            pieces=tuple(places),
            curves=tuple(_in_one(part) for part in parts),
            batch=batch,
            row=row,
        )


def _in_one(batches: Sequence[EndCurves]) -> EndCurves:
    return EndCurves(*(np.concatenate([getattr(batch, f.name) for batch in batches]) for f in fields(EndCurves)))


def alike(shapes: Sequence[Panel]) -> tuple[Alike, ...]:
    """Panels as arrays, those with like edges together."""
    groups: dict[tuple[Pieces, int], list[int]] = {}
    corners = [shape.corners() for shape in shapes]
    for i, shape in enumerate(shapes):
        groups.setdefault((curved(shape), 0 if shape.four_sided else corners[i].shape[1]), []).append(i)
    return tuple(
        _group(shapes, corners, members, chain_edges(kinds) if count == 0 else polygon_edges(count))
        for (kinds, count), members in groups.items()
    )


def _group(shapes: Sequence[Panel], corners: Sequence[Array], members: Sequence[int], edges: tuple[Edge, ...]) -> Alike:
    own = [shapes[i] for i in members]
    p, t, n = (np.array(axis) for axis in zip(*(shape.rulings() for shape in own), strict=True))
    cut_points, cut_normals = (np.array(which) for which in zip(*(shape.cuts() for shape in own), strict=True))
    radius, half_angle, sweep = round_numbers(own)
    return Alike(
        members=np.array(members, dtype=np.intp),
        edges=edges,
        four_sided=own[0].four_sided,
        corners=np.array([corners[i] for i in members]),
        p=p,
        t=t,
        n=n,
        cut_points=cut_points,
        cut_normals=cut_normals,
        radius=radius,
        half_angle=half_angle,
        sweep=sweep,
    )


def curved(shape: Panel) -> Pieces:
    """For each patch whether it is a cone or cylinder."""
    return tuple(isinstance(patch, ConePatch) for patch in shape.patches)


def round_numbers(shapes: Sequence[Panel]) -> tuple[Array, Array, Array]:
    """(n, k) radii in mm, half angles and sweeps of n panels of k patches each; 0 for planes."""
    numbers = np.array(
        [
            [(p.radius, p.half_angle, p.sweep) if isinstance(p, ConePatch) else (0.0, 0.0, 0.0) for p in shape.patches]
            for shape in shapes
        ]
    )
    return numbers[..., 0], numbers[..., 1], numbers[..., 2]
