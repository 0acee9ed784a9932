"""From a face's edges to polylines of exact surface points with the face's exact normals there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Line
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Face

from cadpanel.reference.polyline import cross, norm, unit

Array = NDArray[np.float64]

# Points an edge at first. Each further pass may double their segments, so the number stays odd (and at most 257).
FEWEST_POINTS = 33
PASSES = 4
EVEN_PARTS = np.linspace(0.0, 1.0, FEWEST_POINTS)
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


class _Samples(NamedTuple):
    """Points and normals of an edge as in `Edge`, and (q,) whether the surface defines each normal."""

    points: Array
    normals: Array
    defined: NDArray[np.bool_]
    parameters: Array


def evaluate(surface: BRepAdaptor_Surface, parameters: Array) -> tuple[Array, Array, Array]:
    """Return the points and the two first derivatives, each (..., 3) in mm, at the (..., 2) parameters."""
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    numbers: list[float] = []
    for u, v in parameters.reshape(-1, 2).tolist():
        surface.D1(u, v, point, along_u, along_v)
        numbers += point.Coord()
        numbers += along_u.Coord()
        numbers += along_v.Coord()
    values = np.array(numbers, dtype=np.float64).reshape(*parameters.shape[:-1], 3, 3)
    return values[..., 0, :], values[..., 1, :], values[..., 2, :]


def unit_normals(along_u: Array, along_v: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return the normals of a face from its derivatives, each (..., 3).

    Returns:
        (..., 3) unit normals along Su x Sv, (...,) the length |Su x Sv|, and (...,) whether each normal is well
        defined; those that are not are zero.
    """
    normals = cross(along_u, along_v)
    sizes = norm(normals)
    lengths_u, lengths_v = norm(along_u), norm(along_v)
    scale = np.maximum(lengths_u * lengths_v, lengths_u.sum() * lengths_v.sum() / sizes.size**2)
    defined = sizes > DEGENERATE * scale
    return normals * np.divide(1.0, sizes, out=np.zeros_like(sizes), where=defined)[..., None], sizes, defined


def sample_edges(face: TopoDS_Face, surface: BRepAdaptor_Surface, middle: Array, side: float) -> tuple[Edge, ...]:
    """Return the face's boundary edges; the closing edges of a closed surface are none.

    Args:
        face: the face.
        surface: the face's surface.
        middle: (2,) parameters of a point inside, towards which degenerate normals are looked for.
        side: -1 where the face is reversed against its surface, else 1.
    """
    curves = []
    explorer = TopExp_Explorer(face, TopAbs_EDGE)
    while explorer.More():
        edge = TopoDS.Edge_s(explorer.Current())
        if not (BRep_Tool.Degenerated_s(edge) or BRep_Tool.IsClosed_s(edge, face)):
            curves.append(BRepAdaptor_Curve2d(edge, face))
        explorer.Next()
    if not curves:
        return ()
    positions = np.array([_even_positions(curve) for curve in curves])
    parameters = np.array([_curve_values(curve, places) for curve, places in zip(curves, positions, strict=True)])
    points, along_u, along_v = evaluate(surface, parameters)
    normals, _, defined = unit_normals(along_u, along_v)
    faulty = np.logical_or(*_faults(points))
    edges = []
    for index, curve in enumerate(curves):
        samples = _Samples(points[index], normals[index], defined[index], parameters[index])
        edges.append(_edge(_refined(curve, surface) if faulty[index] else samples, surface, middle, side))
    return tuple(edges)


def _edge(samples: _Samples, surface: BRepAdaptor_Surface, middle: Array, side: float) -> Edge:
    """Make an edge of its samples, with the normals that the surface does not define taken from next to them."""
    normals = samples.normals
    if not samples.defined.all():
        _, along_u, along_v = evaluate(surface, samples.parameters + NUDGE * (middle - samples.parameters))
        normals = np.where(samples.defined[:, None], normals, unit(cross(along_u, along_v)))
    return Edge(samples.points, side * normals, samples.parameters)


def _refined(curve: BRepAdaptor_Curve2d, surface: BRepAdaptor_Surface) -> _Samples:
    """Sample one edge anew at even spacing, the finer the more it turns."""
    positions = _even_positions(curve)
    for _ in range(PASSES):
        parameters = _curve_values(curve, positions)
        points, along_u, along_v = evaluate(surface, parameters)
        coarse, uneven = _faults(points)
        if not (coarse or uneven):
            break
        distances = np.concatenate([[0.0], np.cumsum(norm(np.diff(points, axis=0)))])
        count = 2 * len(positions) - 1 if coarse else len(positions)
        positions = np.interp(np.linspace(0.0, distances[-1], count), distances, positions)
    normals, _, defined = unit_normals(along_u, along_v)
    return _Samples(points, normals, defined, parameters)


def _faults(points: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Tell for (..., q, 3) polylines whether each turns too much between two segments, and is unevenly spaced."""
    segments = np.diff(points, axis=-2)
    lengths = norm(segments)
    products = lengths[..., 1:] * lengths[..., :-1]
    # A segment without length turns nowhere, and 0 < 0 below says so.
    cosines = np.einsum("...d,...d->...", segments[..., 1:, :], segments[..., :-1, :])
    coarse = (cosines < np.cos(np.radians(LARGEST_TURN)) * products).any(axis=-1)
    return coarse, lengths.max(axis=-1) > SPACING_RATIO * lengths.min(axis=-1)


def _even_positions(curve: BRepAdaptor_Curve2d) -> Array:
    """Return positions along a curve, evenly spaced in its own parameter."""
    first, last = curve.FirstParameter(), curve.LastParameter()
    return np.asarray(first + EVEN_PARTS * (last - first))


def _curve_values(curve: BRepAdaptor_Curve2d, positions: Array) -> Array:
    """Return the (q, 2) surface parameters at the (q,) positions of an edge's curve in the parameter plane."""
    if curve.GetType() == GeomAbs_Line:
        line = curve.Line()
        origin, direction = np.array(line.Location().Coord()), np.array(line.Direction().Coord())
        straight: Array = origin + positions[:, None] * direction
        return straight
    return np.array([curve.Value(position).Coord() for position in positions.tolist()], dtype=np.float64)
