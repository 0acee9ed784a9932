"""A loose curve as smooth pieces with points along them, parted where it turns sharply."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_BSplineCurve, GeomAbs_C1
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopoDS import TopoDS_Edge
from scipy.interpolate import make_interp_spline

from cadpanel.arrays import Array
from cadpanel.brep.curves.polyline_smoothing import FACET, SmoothCurve, corners, missed, smooth_curve
from cadpanel.brep.kernel.splines import DEGREE, curve_breaks
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.geometry.vectors import norm, unit

# Segments along a whole curve at first, and the fewest along a piece and along a span between two of its knots.
SEGMENTS = 256
FEWEST_SEGMENTS = 4
SPAN_SEGMENTS = 2
# A break is a sharp turn where a smooth curve through points on both sides would miss it by more than this, mm.
SHARP = 0.25 * CLOSE
# How far beside a break the curve's direction is taken, as a part of the stretch to the next one.
BESIDE = 1e-9
# Two segments that turn by more than this are halved, degrees, as long as they are longer than this, mm.
LARGEST_TURN = 5.0
SHORTEST = 0.01
# Times that segments are halved at most.
HALVINGS = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """A part of a curve without sharp turns.

    Attributes:
        at: gives the points (m, 3) at (m,) parameters, mm.
        parameters: (q,) rising.
        points: (q, 3) there, mm.
        own_ends: whether its first and its last point are the curve's own ends, and not a sharp turn or a join.
        beside: how far it runs beside the polyline that was drawn and stands for it, at most, mm.
        sags: (q,) by how much farther off a surface than a curve's its points may lie, where it is a chord of it, mm;
            one number where it is the same for all.
    """

    at: Callable[[Array], Array]
    parameters: Array
    points: Array
    own_ends: tuple[bool, bool] = (True, True)
    beside: float = 0.0
    sags: Array | float = 0.0


def smooth_pieces(edge: TopoDS_Edge) -> tuple[Piece, ...]:
    """Part a curve where it turns sharply, and lay points along it, the closer the more it bends.

    Raises:
        Standard_Failure: the kernel cannot evaluate it.
    """
    curve = BRepAdaptor_Curve(edge)
    breaks = curve_breaks(curve, GeomAbs_C1)  # where the derivative may jump
    knots = _knots(curve, breaks)
    ends, facets = _turns(curve, breaks, knots)
    closed = bool(norm(np.diff(_values(curve, ends[[0, -1]]), axis=0))[0] <= CLOSE)
    pieces: list[Piece] = []
    for first, last in pairwise(ends.tolist()):
        share = (last - first) / (ends[-1] - ends[0])
        inner = facets[(facets > first) & (facets < last)]
        smooth = _smoothed(curve, breaks, knots, (first, last)) if len(inner) else None
        if smooth is None:
            for part in pairwise([first, *inner.tolist(), last]):
                pieces.append(
                    _piece(partial(_values, curve), part, knots, share * (part[1] - part[0]) / (last - first))
                )
        else:
            own_knots = np.unique(smooth.spline.t)
            pieces.append(
                replace(_piece(smooth.spline, (own_knots[0], own_knots[-1]), own_knots, share), beside=smooth.off)
            )
    if not closed:
        pieces[0] = replace(pieces[0], own_ends=(True, len(pieces) == 1))
        pieces[-1] = replace(pieces[-1], own_ends=(len(pieces) == 1, True))
    return tuple(pieces)


def _piece(at: Callable[[Array], Array], ends: tuple[float, float], knots: Array, share: float) -> Piece:
    """The piece between two parameters, which is a share of the whole curve and has an end of its own at neither."""
    first, last = ends
    count = max(FEWEST_SEGMENTS, round(SEGMENTS * share))
    parameters = np.union1d(np.linspace(first, last, count + 1), knots[(knots > first) & (knots < last)])
    parameters, points = _refined(at, parameters)
    return Piece(at=at, parameters=parameters, points=points, own_ends=(False, False))


def piece_through(points: Array) -> Piece:
    """The smooth curve through (q, 3) points as one piece."""
    parameters = np.arange(float(len(points)))
    spline = make_interp_spline(parameters, points, k=min(DEGREE, len(points) - 1))
    return Piece(at=lambda places: np.asarray(spline(places)), parameters=parameters, points=points)


def _values(curve: BRepAdaptor_Curve, parameters: Array) -> Array:
    return np.array([curve.Value(place).Coord() for place in parameters.tolist()]).reshape(-1, 3)


def _ways(curve: BRepAdaptor_Curve, parameters: Array) -> Array:
    """First derivatives (m, 3)."""
    point, way = gp_Pnt(), gp_Vec()
    ways = []
    for place in parameters.tolist():
        curve.D1(place, point, way)
        ways.append(way.Coord())
    return np.array(ways)


def _turns(curve: BRepAdaptor_Curve, breaks: Array, knots: Array) -> tuple[Array, Array]:
    """Of the breaks, those at which a piece ends, the curve's own ends among them; and the facets of a fine polyline.

    All others are too small to tell.
    """
    if len(breaks) == 2:
        return breaks, np.zeros(0)
    steps = BESIDE * np.diff(breaks)
    before, after = (unit(_ways(curve, at)) for at in (breaks[1:-1] - steps[:-1], breaks[1:-1] + steps[1:]))
    off = missed(before, after, norm(np.diff(_values(curve, breaks), axis=0)))
    # A corner may be drawn in several turns, a hair apart, each of which is too small to tell.
    found = corners(_values(curve, knots), np.searchsorted(knots, breaks[1:-1]))
    ends = np.concatenate([[True], found | (off > FACET), [True]])
    facets = np.concatenate([[False], off > SHARP, [False]]) & ~ends
    return breaks[ends], breaks[facets]


def _smoothed(curve: BRepAdaptor_Curve, breaks: Array, knots: Array, ends: tuple[float, float]) -> SmoothCurve | None:
    """What a fine polyline between two of its corners stands for."""
    within = knots[(knots >= ends[0]) & (knots <= ends[1])]
    vertices = breaks[(breaks >= ends[0]) & (breaks <= ends[1])]
    return smooth_curve(_values(curve, within), np.searchsorted(within, vertices))


def _knots(curve: BRepAdaptor_Curve, breaks: Array) -> Array:
    """Parameters that must be among those of the points, so that no span of a spline is passed over."""
    if curve.GetType() != GeomAbs_BSplineCurve or curve.Degree() == 1:
        return breaks
    spline = curve.BSpline()
    knots = np.array([spline.Knot(place) for place in range(1, spline.NbKnots() + 1)])
    parts = np.arange(SPAN_SEGMENTS) / SPAN_SEGMENTS
    within = (knots[:-1, None] + parts * np.diff(knots)[:, None]).ravel()
    return np.union1d(breaks, within)


def _refined(at: Callable[[Array], Array], parameters: Array) -> tuple[Array, Array]:
    """Halve segments until none turns much against the next: (q,) parameters and (q, 3) points."""
    points = at(parameters)
    for _ in range(HALVINGS):
        ways = np.diff(points, axis=0)
        lengths = norm(ways)
        products = lengths[1:] * lengths[:-1]
        turning = np.sum(ways[1:] * ways[:-1], axis=1) < np.cos(np.radians(LARGEST_TURN)) * products
        coarse = np.zeros(len(ways), dtype=np.bool_)
        coarse[1:] |= turning
        coarse[:-1] |= turning
        coarse &= lengths > SHORTEST
        if not coarse.any():
            break
        middles = 0.5 * (parameters[:-1] + parameters[1:])[coarse]
        places = np.flatnonzero(coarse) + 1
        parameters = np.insert(parameters, places, middles)
        points = np.insert(points, places, at(middles), axis=0)
    return parameters, points
