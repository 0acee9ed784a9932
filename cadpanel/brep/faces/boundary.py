"""From a face's edges to polylines of exact surface points with the face's exact normals there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_BSplineCurve, GeomAbs_Line
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.faces.surface_batch import SurfaceBatch, kernel_values
from cadpanel.brep.kernel.shapes import edges_of
from cadpanel.geometry.vectors import cross, norm, unit

# Points an edge at first, and at most. Each further pass may double their segments, so the number stays odd.
FEWEST_POINTS = 33
MOST_POINTS = 257
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
    """One boundary edge of a face.

    Attributes:
        points: (q, 3) mm.
        normals: (q, 3) unit normals of the face there.
        parameters: (q, 2) of its surface.
        left: 1 where the face lies to the left of the edge as its normals have it, -1 where to the right.
    """

    points: Array
    normals: Array
    parameters: Array
    left: float

    def inwards(self, place: int) -> Array:
        """(3,) the unit direction from a point that is none of its ends into the face, square to the edge."""
        along = self.points[place + 1] - self.points[place - 1]
        return unit(self.left * cross(self.normals[place], along))


class _Samples(NamedTuple):
    """Points and normals of an edge as in `Edge`, and (q,) whether the surface defines each normal."""

    points: Array
    normals: Array
    defined: BoolArray
    parameters: Array


def evaluate(surface: BRepAdaptor_Surface, parameters: Array) -> tuple[Array, Array, Array]:
    """Return the points and the two first derivatives, each (..., 3) in mm, at (..., 2) parameters of one surface."""
    values = kernel_values(surface, parameters.reshape(-1, 2)).reshape(*parameters.shape[:-1], 3, 3)
    return values[..., 0, :], values[..., 1, :], values[..., 2, :]


def unit_normals(along_u: Array, along_v: Array, faces: IntArray | int = 0) -> tuple[Array, Array, BoolArray]:
    """Return the normals of faces from their derivatives.

    Args:
        along_u: (..., 3) first derivatives by u.
        along_v: (..., 3) first derivatives by v.
        faces: (...) the face of each point, where there are several; no direction is trusted where it is small
            against its mean over the face.

    Returns:
        (..., 3) unit normals along Su x Sv, (...,) the length |Su x Sv|, and (...,) whether each normal is well
        defined; those that are not are zero.
    """
    normals = cross(along_u, along_v)
    sizes = norm(normals)
    lengths_u, lengths_v = norm(along_u), norm(along_v)
    owners = np.broadcast_to(faces, sizes.shape).ravel()
    counts = np.maximum(np.bincount(owners), 1)
    mean_u, mean_v = (np.bincount(owners, lengths.ravel()) / counts for lengths in (lengths_u, lengths_v))
    scale = np.maximum(lengths_u * lengths_v, (mean_u * mean_v)[owners].reshape(sizes.shape))
    defined = sizes > DEGENERATE * scale
    return normals * np.divide(1.0, sizes, out=np.zeros_like(sizes), where=defined)[..., None], sizes, defined


def sample_edges(faces: Sequence[TopoDS_Face], surfaces: SurfaceBatch, bounds: Array, sides: Array) -> list[list[Edge]]:
    """Return the boundary edges of each face; the closing edges of closed surfaces are none.

    Args:
        faces: F faces.
        surfaces: their surfaces.
        bounds: (F, 2, 2) least and largest parameter of each face, by u and v; degenerate normals are looked for
            towards the middle.
        sides: (F,) -1 where a face is reversed against its surface, else 1.
    """
    found = [(index, *curve) for index, face in enumerate(faces) for curve in _curves(face)]
    edges: list[list[Edge]] = [[] for _ in faces]
    if not found:
        return edges
    owners, curves = np.array([index for index, _, _ in found]), [curve for _, curve, _ in found]
    parameters = _curve_values(curves, np.array([_even_positions(curve) for curve in curves]))
    points, along_u, along_v = surfaces.evaluate(owners[:, None], parameters)
    normals, _, defined = unit_normals(along_u, along_v, owners[:, None])
    middles = bounds.mean(axis=2)
    whole, (coarse, uneven) = np.asarray(defined.all(axis=1)), _faults(points)
    # Points that are fewer than the curve's spans may all lie where it crosses its own middle.
    faulty = np.asarray(coarse | uneven | [_knots(curve) > FEWEST_POINTS for curve in curves])
    signed = sides[owners, None, None] * normals
    for index, (owner, _, left) in enumerate(found):
        if whole[index] and not faulty[index]:
            edge = Edge(points[index], signed[index], parameters[index], left)
        else:
            samples = _Samples(points[index], normals[index], defined[index], parameters[index])
            if faulty[index]:
                samples = _refined(curves[index], surfaces, owner)
            edge = _edge(samples, surfaces, owner, middles[owner], sides[owner], left)
        edges[owner].append(edge)
    return edges


def _curves(face: TopoDS_Face) -> Iterator[tuple[BRepAdaptor_Curve2d, float]]:
    """The edges of a face as curves in its parameter plane, each with the side on which the face lies.

    The explorer turns edges round with their face, so that a face has its inside to the left of them all, seen from
    where its normals point.
    """
    edges = edges_of(face)
    for edge in edges:
        if not (BRep_Tool.Degenerated_s(edge) or _is_seam(edge, face, edges)):
            yield BRepAdaptor_Curve2d(edge, face), -1.0 if edge.Orientation() == TopAbs_REVERSED else 1.0


def _is_seam(edge: TopoDS_Edge, face: TopoDS_Face, edges: Sequence[TopoDS_Edge]) -> bool:
    """Whether a face lies on both sides of an edge; of a piece that ends on what was a seam, it is the border."""
    return bool(BRep_Tool.IsClosed_s(edge, face)) and sum(other.IsSame(edge) for other in edges) > 1


def _edge(samples: _Samples, surfaces: SurfaceBatch, face: int, middle: Array, side: float, left: float) -> Edge:
    """Make an edge of its samples, with the normals that the surface does not define taken from next to them."""
    normals = samples.normals
    if not samples.defined.all():
        nudged = samples.parameters + NUDGE * (middle - samples.parameters)
        _, along_u, along_v = surfaces.evaluate(np.array(face), nudged)
        normals = np.where(samples.defined[:, None], normals, unit(cross(along_u, along_v)))
    return Edge(samples.points, side * normals, samples.parameters, left)


def _refined(curve: BRepAdaptor_Curve2d, surfaces: SurfaceBatch, face: int) -> _Samples:
    """Sample one edge anew at even spacing, the finer the more it turns."""
    count = FEWEST_POINTS
    while count < min(_knots(curve), MOST_POINTS):
        count = 2 * count - 1
    positions = np.interp(np.linspace(0.0, 1.0, count), EVEN_PARTS, _even_positions(curve))
    for _ in range(PASSES):
        parameters = _curve_values([curve], positions[None])[0]
        points, along_u, along_v = surfaces.evaluate(np.array(face), parameters)
        coarse, uneven = _faults(points)
        if not (coarse or uneven):
            break
        distances = np.concatenate([[0.0], np.cumsum(norm(np.diff(points, axis=0)))])
        count = min(2 * len(positions) - 1, MOST_POINTS) if coarse else len(positions)
        positions = np.interp(np.linspace(0.0, distances[-1], count), distances, positions)
    normals, _, defined = unit_normals(along_u, along_v)
    return _Samples(points, normals, defined, parameters)


def _faults(points: Array) -> tuple[BoolArray, BoolArray]:
    """Tell for (..., q, 3) polylines whether each turns too much between two segments, and is unevenly spaced."""
    segments = np.diff(points, axis=-2)
    lengths = norm(segments)
    products = lengths[..., 1:] * lengths[..., :-1]
    # A segment without length turns nowhere, and 0 < 0 below says so.
    cosines = np.einsum("...d,...d->...", segments[..., 1:, :], segments[..., :-1, :])
    coarse = (cosines < np.cos(np.radians(LARGEST_TURN)) * products).any(axis=-1)
    return coarse, lengths.max(axis=-1) > SPACING_RATIO * lengths.min(axis=-1)


def _knots(curve: BRepAdaptor_Curve2d) -> int:
    """How many knots a border has as a spline; 0 where it is none."""
    return int(curve.NbKnots()) if curve.GetType() == GeomAbs_BSplineCurve else 0


def _even_positions(curve: BRepAdaptor_Curve2d) -> Array:
    """Return positions along a curve, evenly spaced in its own parameter."""
    first, last = curve.FirstParameter(), curve.LastParameter()
    return np.asarray(first + EVEN_PARTS * (last - first))


def _curve_values(curves: Sequence[BRepAdaptor_Curve2d], positions: Array) -> Array:
    """Return the (e, q, 2) surface parameters at the (e, q) positions of e edges' curves in the parameter plane."""
    values = np.empty((*positions.shape, 2))
    straight, lines = [], []
    for index, curve in enumerate(curves):
        if curve.GetType() == GeomAbs_Line:
            line = curve.Line()
            straight.append(index)
            lines.append((line.Location().Coord(), line.Direction().Coord()))
        else:
            values[index] = [curve.Value(position).Coord() for position in positions[index].tolist()]
    if straight:
        origins, directions = np.array(lines).transpose(1, 0, 2)[:, :, None]
        values[straight] = origins + positions[straight, :, None] * directions
    return values
