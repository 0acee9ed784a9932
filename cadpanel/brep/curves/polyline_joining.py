"""Loose straight edges that go on from each other with hardly a turn, joined to polylines.

Some programs write a polyline as one edge a segment.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_BezierCurve, GeomAbs_BSplineCurve, GeomAbs_Line
from OCP.TopoDS import TopoDS_Edge

from cadpanel.arrays import Array
from cadpanel.brep.curves.polyline_smoothing import missed
from cadpanel.brep.files.model import ModelCurve
from cadpanel.brep.kernel.splines import polyline_edge
from cadpanel.geometry.vectors import norm, unit

# How closely an edge must begin where the one before it ends, mm.
MEET = 1e-3


def joined(curves: Sequence[ModelCurve], most: float) -> list[tuple[int, ModelCurve]]:
    """The curves of a file, straight ones that go on from the one before them joined with it.

    Args:
        curves: in file order.
        most: a smooth curve past the turn between two that are joined misses it by no more than this, mm.

    Returns:
        Each curve, or polyline instead of several, with the place of its first edge in the file, from 1.
    """
    found: list[tuple[int, ModelCurve]] = []
    line: list[Array] = []
    for number, curve in enumerate(curves, start=1):
        segment = _segment(curve.edge)
        onward = None
        if line and segment is not None and curve.label == found[-1][1].label:
            onward = _onward(line, segment, most)
        if onward is not None:
            line.append(onward)
            continue
        _finish(found, line)
        line = [] if segment is None else list(segment)
        found.append((number, curve))
    _finish(found, line)
    return found


def _segment(edge: TopoDS_Edge) -> tuple[Array, Array] | None:
    """Both ends (3,) of a straight edge, None for any other."""
    if BRep_Tool.Degenerated_s(edge):
        return None
    curve = BRepAdaptor_Curve(edge)
    straight = curve.GetType() == GeomAbs_Line
    if curve.GetType() in (GeomAbs_BSplineCurve, GeomAbs_BezierCurve):
        # So the kernel reads the segments of an IGES polyline.
        straight = curve.NbPoles() == 2
    if not straight:
        return None
    first, last = (np.array(curve.Value(at).Coord()) for at in (curve.FirstParameter(), curve.LastParameter()))
    return (first, last) if np.linalg.norm(last - first) > MEET else None


def _onward(line: list[Array], segment: tuple[Array, Array], most: float) -> Array | None:
    """Where a polyline goes on along a segment, which may be drawn the other way round; None where it does not.

    A polyline of one segment may be the one that was drawn so: it is turned round.
    """
    if len(line) == 2 and min(np.linalg.norm(end - line[-1]) for end in segment) > MEET:
        line.reverse()
    for start, stop in (segment, segment[::-1]):
        if np.linalg.norm(start - line[-1]) <= MEET:
            ways = np.diff([line[-2], line[-1], stop], axis=0)
            off = missed(unit(ways[:1]), unit(ways[1:]), norm(ways))[0]
            return stop if off <= most else None
    return None


def _finish(found: list[tuple[int, ModelCurve]], line: list[Array]) -> None:
    """Put a polyline in the place of the first of its edges, which is the last one found."""
    if len(line) > 2:
        number, curve = found[-1]
        found[-1] = number, replace(curve, edge=polyline_edge(line))
