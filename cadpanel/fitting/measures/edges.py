"""Edges of fitted panels as curves, one batch for many panels; millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.panel_edges import Edge, chain_edges, polygon_edges
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import unit


def alike(shapes: Sequence[Panel]) -> list[IntArray]:
    """Indices (n,) of panels that have the same edges: chains of like patches, polygons of equally many corners."""
    groups: dict[tuple[Edge, ...], list[int]] = {}
    for i, shape in enumerate(shapes):
        groups.setdefault(edges_of(shape), []).append(i)
    return [np.array(members, dtype=np.intp) for members in groups.values()]


def edges_of(shape: Panel) -> tuple[Edge, ...]:
    """The boundary of a panel, edge by edge, in the order of its reference's edges."""
    return chain_edges(curved(shape)) if shape.four_sided else polygon_edges(shape.corners().shape[1])


def curved(shape: Panel) -> tuple[bool, ...]:
    """For each patch whether it is a cone or cylinder."""
    return tuple(isinstance(patch, ConePatch) for patch in shape.patches)


def round_numbers(shapes: Sequence[Panel]) -> tuple[Array, Array, Array]:
    """(n, k) radii in mm, half angles and sweeps of n panels of k patches each; 0 for planes."""
    numbers = np.zeros((3, len(shapes), len(shapes[0].patches)))
    for i, shape in enumerate(shapes):
        for k, patch in enumerate(shape.patches):
            if isinstance(patch, ConePatch):
                numbers[:, i, k] = patch.radius, patch.half_angle, patch.sweep
    return numbers[0], numbers[1], numbers[2]


def edge_curves(shapes: Sequence[Panel], edges: Sequence[int], centre: Array) -> EndCurves:
    """One edge of each of s panels as curves of equally many pieces, mm from `centre` (3,).

    Args:
        shapes: s panels.
        edges: which edge of each; where they are not segments, ends of chains of like patches.
        centre: a point among the panels: map-grid coordinates would cost digits in the gaps.
    """
    found = [edges_of(shape)[edge] for shape, edge in zip(shapes, edges, strict=True)]
    if found[0].straight:
        return _segments(shapes, found, centre)
    radius, half_angle, sweep = round_numbers(shapes)
    p, t, n = (np.array(axis) for axis in zip(*(shape.rulings() for shape in shapes), strict=True))
    cuts = [[which[end] for which in shape.cuts()] for shape, end in zip(shapes, edges, strict=True)]
    cut_point, cut_normal = (np.array(which) for which in zip(*cuts, strict=True))
    return EndCurves(
        corners=np.array([shape.corners()[end] for shape, end in zip(shapes, edges, strict=True)]) - centre,
        p=p - centre,
        t=t,
        n=n,
        radius=radius,
        half_angle=half_angle,
        sweep=sweep,
        cut_point=cut_point - centre,
        cut_normal=cut_normal,
    )


def _segments(shapes: Sequence[Panel], edges: Sequence[Edge], centre: Array) -> EndCurves:
    at = np.array([corners_along(shape, edge)[[0, -1]] for shape, edge in zip(shapes, edges, strict=True)]) - centre
    normals = np.array([_normal_at(shape, edge) for shape, edge in zip(shapes, edges, strict=True)])
    along = unit(at[:, 1] - at[:, 0])
    flat = np.zeros((len(shapes), 1))
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


def corners_along(shape: Panel, edge: Edge) -> Array:
    """(m, 3) the corners along an edge, mm."""
    corners: Array = shape.corners().reshape(-1, 3)[list(edge.corners)]
    return corners


def _normal_at(shape: Panel, edge: Edge) -> Array:
    """(3,) the skin's normal along a straight edge: that of its ruling; a chain's last ruling is its side 1."""
    normal: Array = shape.rulings()[2][-1 if edge.name == "side 1" else 0]
    return normal
