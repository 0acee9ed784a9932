"""Areas of faces, on the surface and in its parameter plane, however they and their borders wave.

The kernel's own integration passes over waves: it was off by a seventh beside ten of them, and where it is asked for
precision still by some 1e-4, without a word.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.GeomAbs import (
    GeomAbs_BSplineCurve,
    GeomAbs_CN,
    GeomAbs_Cylinder,
    GeomAbs_Line,
    GeomAbs_Plane,
)
from OCP.gp import gp_Pnt2d, gp_Vec2d
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.faces.surface_batch import SurfaceBatch
from cadpanel.brep.kernel.shapes import edges_of
from cadpanel.brep.kernel.splines import breaks_of, curve_breaks, spans_of
from cadpanel.geometry.vectors import cross, norm

# Gauss points along each span of a border: as many as the degree of a spline, for which a plane comes out exactly, and
# at least so many where it has few spans; and along any other curve, of which an arc may go all the way round.
FEWEST_ALONG, FEW_SPANS, ALONG_ARC = 8, 4, 24
# Gauss points across a face: so many, more for each of its spans, and most; one where parameters cover area evenly.
FEWEST_ACROSS, ACROSS_A_SPAN, MOST_ACROSS = 4, 2, 32
EVEN = (GeomAbs_Plane, GeomAbs_Cylinder)
# Gauss points each way over each span of a whole face, more and more until two areas agree to within this part, or a
# face would have more points than so many.
OVER_SPAN = (2, 4, 8, 16, 24)
AGREE = 1e-5
MOST_POINTS = 500_000
# About so many points of whole faces are evaluated at once.
AT_ONCE = 100_000


def trimmed_areas(faces: Sequence[TopoDS_Face], surfaces: SurfaceBatch, chosen: IntArray, bounds: Array) -> Array:
    """The areas (k,) of some faces within their borders, mm^2.

    By Green's theorem, area is the integral along the border, counterclockwise, of dv times the area of a strip of
    width 1 in v that lies between the middle of the face and the border.

    Args:
        faces: F faces.
        surfaces: their surfaces.
        chosen: (k,) which.
        bounds: (F, 2, 2) least and largest parameter of each face, by u and v.
    """
    areas = np.zeros(len(chosen))
    borders = [_border(faces[face]) for face in chosen.tolist()]
    counts = np.array([_across(faces[face]) for face in chosen.tolist()])
    for count in np.unique(counts).tolist():
        nodes, weights = _gauss(count)
        places = np.flatnonzero(counts == count)
        owners = np.repeat(places, [len(borders[place][1]) for place in places.tolist()])
        ends = np.concatenate([borders[place][0] for place in places.tolist()])
        steps = np.concatenate([borders[place][1] for place in places.tolist()])
        middle = bounds[chosen[owners], 0].mean(axis=1)
        halves = 0.5 * (ends[:, 0] - middle)
        across = middle[:, None] + halves[:, None] * (1.0 + nodes)
        parameters = np.stack(np.broadcast_arrays(across, ends[:, 1:]), axis=-1)
        _, along_u, along_v = surfaces.evaluate(chosen[owners][:, None], parameters)
        strips = halves * (norm(cross(along_u, along_v)) @ weights)
        areas += np.bincount(owners, strips * steps, minlength=len(areas))
    return np.abs(areas)


def whole_areas(surfaces: SurfaceBatch, adaptors: Sequence[BRepAdaptor_Surface], chosen: IntArray) -> Array:
    """The areas (k,) of some faces that fill their parameter ranges, mm^2.

    Args:
        surfaces: of F faces.
        adaptors: the same, as the kernel has them.
        chosen: (k,) which.
    """
    breaks = [(breaks_of(adaptors[face], 0), breaks_of(adaptors[face], 1)) for face in chosen.tolist()]
    spans = np.array([(len(along) - 1) * (len(across) - 1) for along, across in breaks])
    left = np.arange(len(chosen))
    areas = _integrated(surfaces, chosen, breaks, OVER_SPAN[0])
    for count in OVER_SPAN[1:]:
        left = left[spans[left] * count**2 <= MOST_POINTS]
        finer = _integrated(surfaces, chosen[left], [breaks[place] for place in left.tolist()], count)
        off = np.abs(finer - areas[left]) > AGREE * finer
        areas[left] = finer
        left = left[off]
    return areas


def _integrated(surfaces: SurfaceBatch, chosen: IntArray, breaks: Sequence[tuple[Array, Array]], count: int) -> Array:
    """The same with so many Gauss points each way over each span between breaks, faces of as many at once."""
    areas = np.zeros(len(chosen))
    alike: dict[tuple[int, int], list[int]] = {}
    for place, (along, across) in enumerate(breaks):
        alike.setdefault((len(along) - 1, len(across) - 1), []).append(place)
    for spans, places in alike.items():
        at_once = max(AT_ONCE // (spans[0] * spans[1] * count**2), 1)
        for start in range(0, len(places), at_once):
            part = places[start : start + at_once]
            (u, weights_u), (v, weights_v) = (
                _rules(np.array([breaks[place][axis] for place in part]), count) for axis in (0, 1)
            )
            along_u, along_v = surfaces.slopes_on_grids(chosen[part], u, v)
            parts = norm(cross(along_u, along_v)) * weights_v[:, None]
            areas[part] = (parts.sum(axis=2) * weights_u).sum(axis=1)
    return areas


def _rules(breaks: Array, count: int) -> tuple[Array, Array]:
    """Places (k, n) along a parameter and the weights by which what is measured there adds up to an integral."""
    nodes, weights = _gauss(count)
    halves = 0.5 * np.diff(breaks)[..., None]
    places = breaks[:, :-1, None] + halves * (1.0 + nodes)
    return places.reshape(len(breaks), -1), (halves * weights).reshape(len(breaks), -1)


def enclosed(face: TopoDS_Face) -> float:
    """What a face's borders enclose in its parameter plane; negative where it is reversed against its surface."""
    ends, steps = _border(face)
    return float((ends[:, 0] - ends[:, 0].mean()) @ steps) if len(ends) else 0.0


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Points and weights of Gauss's rule from -1 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes, weights


def _across(face: TopoDS_Face) -> int:
    """How many Gauss points a strip across a face needs."""
    surface = BRepAdaptor_Surface(face)
    if surface.GetType() in EVEN:
        return 1
    return min(FEWEST_ACROSS + ACROSS_A_SPAN * spans_of(surface)[0], MOST_ACROSS)


def _border(face: TopoDS_Face) -> tuple[Array, Array]:
    """Points (m, 2) of a face's border in the parameter plane, and (m,) the steps in v that they stand for."""
    ends, steps = [np.zeros((0, 2))], [np.zeros(0)]
    for edge in edges_of(face):
        # An edge inside the face, on none of its borders, is neither.
        if edge.Orientation() not in (TopAbs_FORWARD, TopAbs_REVERSED):
            continue
        side = -1.0 if edge.Orientation() == TopAbs_REVERSED else 1.0
        curve = BRepAdaptor_Curve2d(edge, face)
        breaks = _breaks(curve)
        nodes, weights = _gauss(_along(curve, len(breaks) - 1))
        halves = 0.5 * np.diff(breaks)
        places = (breaks[:-1, None] + halves[:, None] * (1.0 + nodes)).ravel()
        points, ways = _values(curve, places)
        ends.append(points)
        steps.append(side * (halves[:, None] * weights).ravel() * ways[:, 1])
    found, steps_in_v = np.concatenate(ends), np.concatenate(steps)
    # Where a border follows v, no strip begins.
    keep = steps_in_v != 0.0
    return found[keep], steps_in_v[keep]


def _along(curve: BRepAdaptor_Curve2d, spans: int) -> int:
    """How many Gauss points each span of a border needs."""
    if curve.GetType() == GeomAbs_Line:
        return FEWEST_ALONG
    if curve.GetType() != GeomAbs_BSplineCurve or curve.IsRational():
        return ALONG_ARC
    return int(curve.Degree()) if spans > FEW_SPANS else max(FEWEST_ALONG, int(curve.Degree()))


def _breaks(curve: BRepAdaptor_Curve2d) -> Array:
    """Both ends of a border's curve and its knots between them."""
    if curve.GetType() == GeomAbs_Line:
        return np.array([curve.FirstParameter(), curve.LastParameter()])
    return curve_breaks(curve, GeomAbs_CN)


def _values(curve: BRepAdaptor_Curve2d, places: Array) -> tuple[Array, Array]:
    """Points and first derivatives, (m, 2) each."""
    point, way = gp_Pnt2d(), gp_Vec2d()
    numbers: list[float] = []
    for place in places.tolist():
        curve.D1(place, point, way)
        numbers += point.Coord()
        numbers += way.Coord()
    values = np.array(numbers).reshape(-1, 4)
    return values[:, :2], values[:, 2:]
