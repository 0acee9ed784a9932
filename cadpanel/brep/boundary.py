"""From a face's edges to polylines of exact surface points with the face's exact normals there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Line
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Face

Array = NDArray[np.float64]

# Points an edge at first. Each further pass may double their segments, so the number stays odd (and at most 257).
FEWEST_POINTS = 33
PASSES = 4
# Another pass doubles an edge's segments where it turns by more than this between two of them, degrees.
LARGEST_TURN = 5.0
# Points are spread anew where the longest segment is longer than the shortest by more than this factor.
SPACING_RATIO = 1.5
# |Su x Sv| below this part of |Su| |Sv|, or of its mean over the face, is no direction to trust.
DEGENERATE = 1e-7
# How far a point with a degenerate normal is moved towards the middle of the face, as a part of the way.
NUDGE = 1e-4


@dataclass(frozen=True, slots=True)
class Edge:
    """One boundary edge of a face: (q, 3) points in mm, the face's (q, 3) unit normals, and (q, 2) parameters."""

    points: Array
    normals: Array
    parameters: Array


def evaluate(surface: BRepAdaptor_Surface, parameters: Array) -> tuple[Array, Array, Array]:
    """Return the points and the two first derivatives, each (m, 3) in mm, at the (m, 2) parameters."""
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    rows = []
    for u, v in parameters.tolist():
        surface.D1(u, v, point, along_u, along_v)
        rows.append(point.Coord() + along_u.Coord() + along_v.Coord())
    values = np.array(rows, dtype=np.float64).reshape(-1, 3, 3)
    return values[:, 0], values[:, 1], values[:, 2]


def unit_normals(along_u: Array, along_v: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return (m, 3) unit normals along Su x Sv and, (m,), whether each is well defined; the others are zero."""
    normals = np.cross(along_u, along_v)
    sizes = np.linalg.norm(normals, axis=1)
    lengths_u, lengths_v = np.linalg.norm(along_u, axis=1), np.linalg.norm(along_v, axis=1)
    scale = np.maximum(lengths_u * lengths_v, lengths_u.mean() * lengths_v.mean())
    defined = sizes > DEGENERATE * scale
    return np.where(defined[:, None], normals, 0.0) / np.where(defined, sizes, 1.0)[:, None], defined


def sample_edges(face: TopoDS_Face, surface: BRepAdaptor_Surface, middle: Array, side: float) -> tuple[Edge, ...]:
    """Return the face's boundary edges; the closing edges of a closed surface are none.

    Args:
        face: the face.
        surface: the face's surface.
        middle: (2,) parameters of a point inside, towards which degenerate normals are looked for.
        side: -1 where the face is reversed against its surface, else 1.
    """
    edges = []
    explorer = TopExp_Explorer(face, TopAbs_EDGE)
    while explorer.More():
        edge = TopoDS.Edge_s(explorer.Current())
        if not (BRep_Tool.Degenerated_s(edge) or BRep_Tool.IsClosed_s(edge, face)):
            edges.append(_sample_edge(BRepAdaptor_Curve2d(edge, face), surface, middle, side))
        explorer.Next()
    return tuple(edges)


def _sample_edge(curve: BRepAdaptor_Curve2d, surface: BRepAdaptor_Surface, middle: Array, side: float) -> Edge:
    """Sample one edge at even spacing, the finer the more it turns."""
    positions = np.linspace(curve.FirstParameter(), curve.LastParameter(), FEWEST_POINTS)
    for _ in range(PASSES):
        parameters = _curve_values(curve, positions)
        points, along_u, along_v = evaluate(surface, parameters)
        segments = np.diff(points, axis=0)
        lengths = np.linalg.norm(segments, axis=1)
        too_coarse = _largest_turn(segments, lengths) > LARGEST_TURN
        if not too_coarse and lengths.max() <= SPACING_RATIO * lengths.min():
            break
        distances = np.concatenate([[0.0], np.cumsum(lengths)])
        count = 2 * len(positions) - 1 if too_coarse else len(positions)
        positions = np.interp(np.linspace(0.0, distances[-1], count), distances, positions)
    normals, defined = unit_normals(along_u, along_v)
    if not defined.all():
        normals[~defined] = _nudged_normals(surface, parameters[~defined], middle)
    return Edge(points, side * normals, parameters)


def _curve_values(curve: BRepAdaptor_Curve2d, positions: Array) -> Array:
    """Return the (q, 2) surface parameters at the (q,) positions of an edge's curve in the parameter plane."""
    if curve.GetType() == GeomAbs_Line:
        line = curve.Line()
        origin, direction = np.array(line.Location().Coord()), np.array(line.Direction().Coord())
        straight: Array = origin + positions[:, None] * direction
        return straight
    return np.array([curve.Value(position).Coord() for position in positions.tolist()], dtype=np.float64)


def _largest_turn(segments: Array, lengths: Array) -> float:
    """Return the largest angle between two consecutive segments, degrees; segments without length do not turn."""
    products = lengths[1:] * lengths[:-1]
    cosines = np.einsum("ij,ij->i", segments[1:], segments[:-1]) / np.where(products > 0.0, products, 1.0)
    return float(np.degrees(np.arccos(np.clip(np.where(products > 0.0, cosines, 1.0), -1.0, 1.0))).max())


def _nudged_normals(surface: BRepAdaptor_Surface, parameters: Array, middle: Array) -> Array:
    """Return the (m, 3) unit normals a little towards the middle of the face, where they are defined again."""
    _, along_u, along_v = evaluate(surface, parameters + NUDGE * (middle - parameters))
    normals = np.cross(along_u, along_v)
    sizes = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.where(sizes > 0.0, sizes, 1.0)
