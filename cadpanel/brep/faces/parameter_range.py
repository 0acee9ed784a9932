"""The parameter range that a face fills.

The kernel bounds a border by its control points, which lie far outside of a rational one: a circle's form a triangle.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.BRepTools import BRepTools
from OCP.GeomAbs import GeomAbs_CN, GeomAbs_Line
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array
from cadpanel.brep.kernel.shapes import edges_of
from cadpanel.brep.kernel.splines import curve_breaks

# Parts of each span of a border at first, and of the stretch around its farthest point later on.
PARTS = 8
ROUNDS = 10
# A range is tight where the border reaches it to within this part of it.
TIGHT = 1e-9


def parameter_range(face: TopoDS_Face) -> Array:
    """The least and largest parameter (2, 2) of a face, by u and v."""
    loose = np.array(BRepTools.UVBounds_s(face)).reshape(2, 2)
    curves = [BRepAdaptor_Curve2d(edge, face) for edge in edges_of(face)]
    if not curves:
        return loose
    margin = TIGHT * np.ptp(loose, axis=1)
    ends = [_values(curve, [curve.FirstParameter(), curve.LastParameter()]) for curve in curves]
    reached = _around(ends)
    # Mostly corners reach all four borders of the range.
    if (np.abs(reached - loose) <= margin[:, None]).all():
        return loose
    tight = _around([*ends, *(_farthest(curve) for curve in curves if curve.GetType() != GeomAbs_Line)])
    return np.where(np.abs(tight - loose) <= margin[:, None], loose, tight)


def _around(points: Sequence[Array]) -> Array:
    stacked = np.concatenate(points)
    return np.stack([stacked.min(axis=0), stacked.max(axis=0)], axis=1)


def _farthest(curve: BRepAdaptor_Curve2d) -> Array:
    """Points (k, 2) of a border, among them those in which it reaches farthest each way."""
    breaks = curve_breaks(curve, GeomAbs_CN)
    places = np.interp(np.arange(PARTS * (len(breaks) - 1) + 1) / PARTS, np.arange(len(breaks)), breaks)
    points = _values(curve, places.tolist())
    found = [points]
    for axis in (0, 1):
        for sign in (-1.0, 1.0):
            height = sign * points[:, axis]
            # A closed border may begin beside its farthest point, which then lies before its end: all peaks count that
            # rise to where the highest may be.
            beside = np.maximum(np.append(height[1:], -np.inf), np.insert(height[:-1], 0, -np.inf))
            steepest = np.abs(np.diff(height)).max()
            for peak in np.flatnonzero((height >= beside) & (height >= height.max() - steepest)).tolist():
                found.append(_peak(curve, axis, sign, places[max(peak - 1, 0)], places[min(peak + 1, len(places) - 1)]))
    return np.concatenate(found)


def _peak(curve: BRepAdaptor_Curve2d, axis: int, sign: float, low: float, high: float) -> Array:
    """Points (PARTS + 1, 2) ever nearer around the one between two parameters in which u or v is largest or least."""
    for _ in range(ROUNDS):
        places = np.linspace(low, high, PARTS + 1)
        points = _values(curve, places.tolist())
        best = int((sign * points[:, axis]).argmax())
        low, high = places[max(best - 1, 0)], places[min(best + 1, PARTS)]
    return points


def _values(curve: BRepAdaptor_Curve2d, places: Sequence[float]) -> Array:
    return np.array([curve.Value(place).Coord() for place in places])
