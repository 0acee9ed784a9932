"""A trim of a Rhino face as the kernel wants it: a curve of the parameter plane that keeps pace with its edge.

openNURBS walks a trim at any pace; to the kernel, what the trim and the edge have at one parameter is one point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.Geom import Geom_BSplineCurve
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.GeomAbs import GeomAbs_C1
from OCP.GeomAdaptor import GeomAdaptor_Curve
from OCP.TColStd import TColStd_Array1OfReal
from scipy.interpolate import make_interp_spline

from cadpanel.arrays import Array
from cadpanel.brep.faces.surface_batch import kernel_values
from cadpanel.brep.files.opennurbs import ConversionError
from cadpanel.brep.kernel.splines import DEGREE, knot_arrays, numbers, pole_array_2d
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import norm

# Parts of an edge, and of each span of its spline, at which a trim is compared with it; and parts at which lengths are
# measured.
LOOKED_AT = np.linspace(0.0, 1.0, 33)
IN_SPAN = np.array([0.1, 0.5, 0.9])
MEASURED = np.linspace(0.0, 1.0, 257)
# A trim is straight where it is no farther off its chord than this part of the surface's range.
STRAIGHT = 1e-10
# Steps towards the point of a trim that is nearest to one of its edge, and how far a derivative is felt for.
NEWTON_STEPS = 4
FELT = 1e-6
# A step of this part of the trim leads no further.
STEADY = 1e-9
# Points on each smooth piece of an edge that are tried in turn.
COUNTS = (9, 17, 33, 65, 129, 257)
# Between them a curve may be farther off than on them by this factor.
NO_WORSE = 1.1


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """A curve of the parameter plane, by the edge's parameter, and how far off the edge it runs, units of the file."""

    curve: Geom2d_BSplineCurve
    off: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """A trim and its edge, both walked the way that the edge runs.

    Attributes:
        trim: the (k, 2) parameters at (k,) parts of the way along the trim.
        spline: the trim as a spline over the edge's range, which may keep its pace or not; None where it has none.
        surface: on which.
        edge: the curve in space.
        close: what counts as no distance, units of the file.
    """

    trim: Callable[[Array], Array]
    spline: Geom2d_BSplineCurve | None
    surface: BRepAdaptor_Surface
    edge: Geom_BSplineCurve
    close: float

    def looked_at(self) -> Array:
        """Parts of the edge's range at which a curve that keeps its pace is compared with it."""
        knots = numbers(self.edge.Knots())
        inside = knots[:-1, None] + IN_SPAN * np.diff(knots)[:, None]
        first, last = self.ends
        return np.unique(np.concatenate([LOOKED_AT, (inside.ravel() - first) / (last - first)]))

    def off(self, line: Geom2d_BSplineCurve, parts: Array) -> float:
        """How far a curve by the edge's parameter runs beside the edge at (k,) parts of its range."""
        on_surface = self.lifted(np.array([line.Value(place).Coord() for place in self.places(parts).tolist()]))
        return float(norm(on_surface - self.drawn(parts)).max())

    @property
    def ends(self) -> tuple[float, float]:
        """The first and last parameter of the edge."""
        return float(self.edge.FirstParameter()), float(self.edge.LastParameter())

    def places(self, parts: Array) -> Array:
        """Parameters of the edge at (k,) parts of its range."""
        first, last = self.ends
        return first + parts * (last - first)

    def drawn(self, parts: Array) -> Array:
        """(k, 3) points of the edge at (k,) parts of its range."""
        return np.array([self.edge.Value(place).Coord() for place in self.places(parts).tolist()])

    def lifted(self, parameters: Array) -> Array:
        """(k, 3) points of the surface at (k, 2) parameters."""
        return kernel_values(self.surface, parameters)[:, 0]


def line_of(course: Course) -> Line:
    """The trim at the edge's pace: exactly itself where it keeps that pace, else a spline through points of it.

    Raises:
        ConversionError: the trim or the edge has no length.
    """
    for exact in (_straight(course), course.spline):
        if exact is not None:
            off = course.off(exact, course.looked_at())
            if off <= course.close:
                return Line(curve=exact, off=off)
    pieces = list(pairwise(_breaks(course).tolist()))
    reached = _Reached(course)
    for count in COUNTS:
        parts = [np.linspace(low, high, count) for low, high in pieces]
        line = _through(course, [(own, course.trim(reached.nearest(own))) for own in parts])
        middles = np.concatenate([0.5 * (own[1:] + own[:-1]) for own in parts])
        on_trim = norm(course.lifted(course.trim(reached.nearest(middles))) - course.drawn(middles)).max()
        if course.off(line, middles) <= max(course.close, NO_WORSE * on_trim):
            break
    return Line(curve=line, off=course.off(line, np.concatenate([middles, *parts, course.looked_at()])))


def straight_line(first: Array, last: Array, ends: tuple[float, float]) -> Geom2d_BSplineCurve:
    """The straight line from one point (2,) of the parameter plane to another, over a range of parameters."""
    knots = np.array([ends[0], ends[0], ends[1], ends[1]])
    return Geom2d_BSplineCurve(pole_array_2d(np.array([first, last])), *knot_arrays(knots), 1)


def _straight(course: Course) -> Geom2d_BSplineCurve | None:
    """The straight line from end to end of a trim that is one; no closed trim is."""
    points, surface = course.trim(LOOKED_AT), course.surface
    spans = np.array(
        [surface.LastUParameter() - surface.FirstUParameter(), surface.LastVParameter() - surface.FirstVParameter()]
    )
    chord, away = (points[-1] - points[0]) / spans, (points - points[0]) / spans
    length = float(norm(chord))
    if length <= STRAIGHT or np.abs(away[:, 0] * chord[1] - away[:, 1] * chord[0]).max() > STRAIGHT * length:
        return None
    return straight_line(points[0], points[-1], course.ends)


class _Reached:
    """Where on a trim points of its edge lie: at the same part of the length first, then nearest to them."""

    def __init__(self, course: Course) -> None:
        self._course = course
        edge = arc_length(course.drawn(MEASURED))
        trim = arc_length(course.lifted(course.trim(MEASURED)))
        if not (edge[-1] > 0.0 and trim[-1] > 0.0):
            raise ConversionError("an edge has no length")
        self._edge, self._trim = edge / edge[-1], trim / trim[-1]

    def nearest(self, parts: Array) -> Array:
        """(k,) parts of the way along the trim for (k,) parts of the edge's range."""
        course = self._course
        found = np.interp(np.interp(parts, MEASURED, self._edge), self._trim, MEASURED)
        drawn, most = course.drawn(parts), MEASURED[1]
        for _ in range(NEWTON_STEPS):
            before, after = np.maximum(found - FELT, 0.0), np.minimum(found + FELT, 1.0)
            here, low, high = (course.lifted(course.trim(places)) for places in (found, before, after))
            way = (high - low) / (after - before)[:, None]
            square = np.maximum(np.einsum("kd,kd->k", way, way), np.finfo(float).tiny)
            step = np.einsum("kd,kd->k", drawn - here, way) / square
            found = np.clip(found + np.clip(step, -most, most), 0.0, 1.0)
            if np.abs(step).max() <= STEADY:
                break
        found[parts <= 0.0], found[parts >= 1.0] = 0.0, 1.0
        return np.maximum.accumulate(found)


def _breaks(course: Course) -> Array:
    """The ends of the edge's smooth pieces, as parts of its range."""
    adaptor = GeomAdaptor_Curve(course.edge)
    found = TColStd_Array1OfReal(1, adaptor.NbIntervals(GeomAbs_C1) + 1)
    adaptor.Intervals(found, GeomAbs_C1)
    first, last = course.ends
    return (numbers(found) - first) / (last - first)


def _through(course: Course, pieces: list[tuple[Array, Array]]) -> Geom2d_BSplineCurve:
    """One spline through the points (k, 2) of each smooth piece at (k,) parts of the edge's range."""
    knots, poles = np.zeros(0), np.zeros((0, 2))
    for parts, points in pieces:
        spline = make_interp_spline(course.places(parts), points, k=DEGREE)
        # Where two pieces meet they share a pole, and a knot as often as the degree.
        knots = np.concatenate([knots[:-1], spline.t[DEGREE + 1 :]]) if len(knots) else spline.t
        poles = np.concatenate([poles[:-1], spline.c])
    return Geom2d_BSplineCurve(pole_array_2d(poles), *knot_arrays(knots), DEGREE)
