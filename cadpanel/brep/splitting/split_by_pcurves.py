"""A patch cut from border to border by curves in its parameter plane, into faces of the same surface."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.GCE2d import GCE2d_MakeSegment
from OCP.Geom import Geom_Surface
from OCP.Geom2d import Geom2d_Curve
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face
from scipy.interpolate import make_interp_spline

from cadpanel.arrays import Array
from cadpanel.brep.faces.face_patch import Patch, geometry, rectangle
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.splines import DEGREE, spline_curve

# A cut that stays within this part of the range is a parameter line.
STRAIGHT = 1e-12


def slice_patch(patch: Patch, axis: int, across: Array, cuts: Array) -> list[TopoDS_Face]:
    """Cut a whole patch into n + 1 faces, in the order of parameter `axis`.

    Args:
        patch: a whole patch.
        axis: the parameter that the cuts divide, 0 for u and 1 for v.
        across: (w,) rising parts of the other parameter, from 0 to 1.
        cuts: (n, w) the parts of the range of `axis` at which each cut lies there, rising from cut to cut.
    """
    borders = np.concatenate([np.zeros((1, len(across))), cuts, np.ones((1, len(across)))])
    surface = geometry(patch)
    curves = [_curve(patch, axis, across, border) for border in borders]
    pieces = []
    for (first, second), (one, other) in zip(pairwise(borders), pairwise(curves), strict=True):
        if np.ptp(first) <= STRAIGHT and np.ptp(second) <= STRAIGHT:
            low, high = (float(patch.at(axis, border[:1], across[:1])[0, axis]) for border in (first, second))
            full = tuple(patch.bounds[1 - axis].tolist())
            pieces.append(rectangle(patch, *(((low, high), full) if axis == 0 else (full, (low, high)))))
            continue
        ends = [patch.at(axis, border[[0, -1]], across[[0, -1]]) for border in (first, second)]
        # Counterclockwise in the parameter plane: along the first cut, over to the second one, back along it, and home.
        loop = [one, _segment(ends[0][1], ends[1][1]), other.Reversed(), _segment(ends[1][0], ends[0][0])]
        if axis == 0:
            loop = [curve.Reversed() for curve in reversed(loop)]
        pieces.append(_face(surface, loop, patch.side))
    return pieces


def edge_across(patch: Patch, axis: int, across: Array, parts: Array) -> TopoDS_Edge:
    """The edge at (w,) parts of the range of parameter `axis`, at (w,) rising parts of that of the other one."""
    edge = BRepBuilderAPI_MakeEdge(_curve(patch, axis, across, parts), geometry(patch)).Edge()
    BRepLib.BuildCurves3d_s(edge)
    return edge


def _face(surface: Geom_Surface, loop: list[Geom2d_Curve], side: float) -> TopoDS_Face:
    wiring = BRepBuilderAPI_MakeWire()
    for curve in loop:
        wiring.Add(BRepBuilderAPI_MakeEdge(curve, surface).Edge())
    face = BRepBuilderAPI_MakeFace(surface, wiring.Wire(), False).Face()
    BRepLib.BuildCurves3d_s(face)
    return TopoDS.Face_s(face.Reversed()) if side < 0.0 else face


def _segment(first: Array, last: Array) -> Geom2d_Curve:
    return GCE2d_MakeSegment(kernel.point_2d(first[0], first[1]), kernel.point_2d(last[0], last[1])).Value()


def _curve(patch: Patch, axis: int, across: Array, parts: Array) -> Geom2d_Curve:
    """The cut as a curve of the parameter plane, interpolated."""
    parameters = patch.at(axis, parts, across)
    if np.ptp(parts) <= STRAIGHT:
        return _segment(parameters[0], parameters[-1])
    return spline_curve(make_interp_spline(across, parameters, k=DEGREE))
