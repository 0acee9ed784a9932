"""Edges of fitted panels as curves, one batch for many panels; millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.panel_edges import Edge, chain_edges, polygon_edges
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.shape import AnyShape, ConePatch, PanelShape
from cadpanel.geometry.vectors import unit


def alike(shapes: Sequence[AnyShape]) -> list[IntArray]:
    """Indices (n,) of panels that have the same edges: chains of like patches, polygons of equally many corners."""
    groups: dict[tuple[Edge, ...], list[int]] = {}
    for i, shape in enumerate(shapes):
        groups.setdefault(edges_of(shape), []).append(i)
    return [np.array(members, dtype=np.intp) for members in groups.values()]


def edges_of(shape: AnyShape) -> tuple[Edge, ...]:
    """The boundary of a panel, edge by edge, in the order of its reference's edges."""
    if isinstance(shape, PanelShape):
        return chain_edges(curved(shape))
    return polygon_edges(len(shape.outline))


def curved(shape: AnyShape) -> tuple[bool, ...]:
    """For each patch whether it is a cone or cylinder."""
    return tuple(isinstance(patch, ConePatch) for patch in shape.patches)


def round_numbers(shapes: Sequence[AnyShape]) -> tuple[Array, Array, Array]:
    """(n, k) radii in mm, half angles and sweeps of n panels of k patches each; 0 for planes."""
    numbers = np.zeros((3, len(shapes), len(shapes[0].patches)))
    for i, shape in enumerate(shapes):
        for k, patch in enumerate(shape.patches):
            if isinstance(patch, ConePatch):
                numbers[:, i, k] = patch.radius, patch.half_angle, patch.sweep
    return numbers[0], numbers[1], numbers[2]


def edge_curves(shapes: Sequence[AnyShape], edges: Sequence[int], centre: Array) -> EndCurves:
    """One edge of each of s panels as curves of equally many pieces, mm from `centre` (3,).

    Args:
        shapes: s panels.
        edges: which edge of each; where they are not segments, ends of chains of like patches.
        centre: a point among the panels: map-grid coordinates would cost digits in the gaps.
    """
    found = [edges_of(shape)[edge] for shape, edge in zip(shapes, edges, strict=True)]
    if found[0].straight:
        return _segments(shapes, found, centre)
    chains = [shape for shape in shapes if isinstance(shape, PanelShape)]
    radius, half_angle, sweep = round_numbers(chains)
    return EndCurves(
        corners=np.array([shape.corners()[end] for shape, end in zip(chains, edges, strict=True)]) - centre,
        p=np.array([shape.points for shape in chains]) - centre,
        t=np.array([shape.directions for shape in chains]),
        n=np.array([shape.normals for shape in chains]),
        radius=radius,
        half_angle=half_angle,
        sweep=sweep,
        cut_point=np.array([shape.cut_points[end] for shape, end in zip(chains, edges, strict=True)]) - centre,
        cut_normal=np.array([shape.cut_normals[end] for shape, end in zip(chains, edges, strict=True)]),
    )


def _segments(shapes: Sequence[AnyShape], edges: Sequence[Edge], centre: Array) -> EndCurves:
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


def corners_along(shape: AnyShape, edge: Edge) -> Array:
    """(m, 3) the corners along an edge, mm."""
    corners: Array = shape.corners().reshape(-1, 3)[list(edge.corners)]
    return corners


def _normal_at(shape: AnyShape, edge: Edge) -> Array:
    """(3,) the skin's normal along a straight edge: that of its ruling; a chain's last ruling is its side 1."""
    if isinstance(shape, PanelShape):
        return np.asarray(shape.normals[-1 if edge.name == "side 1" else 0])
    return shape.normal
