"""How far the walls of a sheet stand off square: the bevel of its cut edges."""

from __future__ import annotations

import math

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.end_leans import leans
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.plane_sides import end_spans, side_curves
from cadpanel.geometry.shape import edge_corners
from cadpanel.geometry.vectors import cross, unit


def edge_bevels(shape: Panel, other: Panel) -> dict[str, tuple[float, float]]:
    """Least and largest angle between wall and sheet normal along each edge, radians; one where it is straight.

    Args:
        shape: the sheet's skin, with the normals.
        other: its other face.
    """
    straight = ["side 0", "side 1"] if shape.four_sided else [f"edge {i}" for i in range(shape.corners().shape[1])]
    if shape.square:
        return dict.fromkeys([*(["end 0", "end 1"] if shape.four_sided else []), *straight], (0.0, 0.0))
    ends = {f"end {end}": tuple(bevels) for end, bevels in enumerate(end_bevels(shape).tolist())}
    return {**ends, **{edge: _bevels(shape, other, edge) for edge in straight}}


def _bevels(shape: Panel, other: Panel, edge: str) -> tuple[float, float]:
    """Of an edge that is straight, or in which a plane cuts the side of a cone: there it grows or falls all along."""
    curve = side_curves(shape)[int(edge[-1])] if edge.startswith("side") else None
    if curve is None:
        return 2 * (_straight_bevel(shape, other, edge),)
    found = np.arcsin(np.clip(curve.frame.normals(curve.corners) @ shape.edge(edge).outward, -1.0, 1.0))
    return float(found.min()), float(found.max())


def _straight_bevel(shape: Panel, other: Panel, edge: str) -> float:
    """The bevel of the wall between an edge and the same one on the other face; signs as those of ends."""
    own = shape.edge(edge)
    away = edge_corners(other.corners(), edge)[0] - own.corners[0]
    wall = unit(cross(own.corners[-1] - own.corners[0], away))
    turned_away = math.copysign(1.0, float(wall @ own.outward)) * wall
    assert own.normal is not None  # straight edges have one
    return math.asin(float(np.clip(own.normal @ turned_away, -1.0, 1.0)))


def end_bevels(shape: Panel) -> Array:
    """(2, 2) least and largest angle between wall and sheet normal along end 0 and end 1, radians; (0, 2) of no ends.

    It is measured square to the edge: the wall lies in the cut plane with unit normal m, turned away from the panel,
    and the bevel is asin(n . m) with n the sheet's outward normal. Positive: the outer face is the shorter one.
    """
    _, normals = shape.cuts()
    turned_away = [normal * way for normal, way in zip(normals, (-1.0, 1.0), strict=False)]
    spans = end_spans(shape) if isinstance(shape, Chain) else [None] * len(normals)
    found = [leans(shape.rulings(), shape.patches, *of) for of in zip(turned_away, spans, strict=True)]
    extremes = np.array([[min(lean), max(lean)] for lean in found]).reshape(-1, 2)
    return np.asarray(np.arcsin(np.clip(extremes, -1.0, 1.0)))
