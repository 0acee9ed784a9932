"""Curves of a patch's parameter plane that follow what was drawn near the patch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepLib import BRepLib
from OCP.TopoDS import TopoDS_Edge
from scipy.interpolate import BSpline, make_interp_spline

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.curves.folds import turns_back
from cadpanel.brep.curves.pieces import Piece
from cadpanel.brep.faces.closest_points import Search
from cadpanel.brep.faces.face_patch import Patch, geometry
from cadpanel.brep.kernel.splines import DEGREE, spline_curve
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import norm, unit

# Numbers of even points that are tried in turn, until the spline through them follows the one through all points.
COUNTS = (9, 17, 33, 65, 129)
# Half of what a cut may be off is left to the spline through all points, and half to that through fewer.
HALF = 0.5 * CLOSE
# Times that points are added where the spline is off, and most of them.
ROUNDS = 24
MOST_POINTS = 20_000
# Points nearer to each other than this part of the length are one.
SAME = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Stretch:
    """A stretch of a curve over a patch.

    Attributes:
        curve: index of the curve.
        piece: which smooth piece of it.
        places: (k,) rising parameters of the piece; one that is no number is drawn on beyond the curve's end.
        line: (k, 2) parameters of the patch.
        offset: how far the curve lies off the patch at most, mm.
    """

    curve: int
    piece: Piece
    places: Array
    line: Array
    offset: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Course:
    """A stretch with what is worked out of its line.

    Attributes:
        stretch: of which.
        points: (k, 3) those of the patch along its line, mm.
        parts: (k,) how much of the way along them each has come, from 0 to 1.
        spline: through the line, by that part.
    """

    stretch: Stretch
    points: Array
    parts: Array
    spline: BSpline


def lay(patch: Patch, stretches: Sequence[Stretch]) -> list[TopoDS_Edge | None]:
    """The edges on a patch along stretches, to within CLOSE; None where that cannot be reached."""
    search = Search(patch)
    found: list[TopoDS_Edge | None] = [None] * len(stretches)
    active = dict(enumerate(stretches))
    for _ in range(ROUNDS):
        if not active:
            break
        courses = dict(zip(active, _courses(patch, list(active.values())), strict=True))
        middles = {place: 0.5 * (own.stretch.places[:-1] + own.stretch.places[1:]) for place, own in courses.items()}
        drawn = {place: np.isfinite(at) for place, at in middles.items()}
        points = [own.stretch.piece.at(middles[place][drawn[place]]) for place, own in courses.items()]
        starts = [0.5 * (own.stretch.line[:-1] + own.stretch.line[1:])[drawn[place]] for place, own in courses.items()]
        feet = search.feet(np.concatenate(points), np.concatenate(starts)).parameters
        parts = np.split(feet, np.cumsum([len(own) for own in points])[:-1])
        for (place, course), own in zip(courses.items(), parts, strict=True):
            segments = np.flatnonzero(drawn[place])
            off = _deviations(patch, course, own, segments)
            back = np.flatnonzero(off > HALF)
            line = course.stretch.line
            off[back[turns_back(patch, line[segments[back]], own[back], line[segments[back] + 1])]] = 0.0
            del active[place]
            if off.max(initial=0.0) <= HALF:
                found[place] = _edge(patch, course)
                continue
            bad, stretch = off > HALF, course.stretch
            closer = replace(
                stretch,
                places=np.insert(stretch.places, segments[bad] + 1, middles[place][segments[bad]]),
                line=np.insert(stretch.line, segments[bad] + 1, own[bad], axis=0),
            )
            if len(closer.places) <= MOST_POINTS:
                active[place] = closer
    return found


def _courses(patch: Patch, stretches: Sequence[Stretch]) -> list[_Course]:
    """What is worked out of each stretch, without points of it that lie on the one before."""
    every = patch.points(np.concatenate([stretch.line for stretch in stretches]))
    found = []
    for stretch, points in zip(
        stretches, np.split(every, np.cumsum([len(own.line) for own in stretches])[:-1]), strict=True
    ):
        reached = arc_length(points)
        keep = np.concatenate([[True], np.diff(reached) > SAME * reached[-1]])
        if not keep.all():
            stretch, points = replace(stretch, places=stretch.places[keep], line=stretch.line[keep]), points[keep]
            reached = arc_length(points)
        parts = reached / reached[-1]
        spline = make_interp_spline(parts, stretch.line, k=min(DEGREE, len(parts) - 1))
        found.append(_Course(stretch=stretch, points=points, parts=parts, spline=spline))
    return found


def _deviations(patch: Patch, course: _Course, feet: Array, segments: IntArray) -> Array:
    """How far the spline passes beside (m, 2) feet in the middles of (m,) segments, mm."""
    starts, ends = course.points[segments], course.points[segments + 1]
    middles = patch.points(feet)
    before, after = norm(middles - starts), norm(ends - middles)
    part = before / np.maximum(before + after, np.finfo(float).tiny)
    at = course.parts[segments] + part * (course.parts[segments + 1] - course.parts[segments])
    away = middles - patch.points(np.asarray(course.spline(at)))
    # Where along the spline a foot lies is known roughly only, and does not matter.
    along = unit(ends - starts)
    return norm(away - np.sum(away * along, axis=1)[:, None] * along)


def _edge(patch: Patch, course: _Course) -> TopoDS_Edge:
    """The edge along a course, with no more poles than it needs."""
    spline = course.spline
    for count in COUNTS:
        if count >= len(course.parts):
            break
        places = np.linspace(0.0, 1.0, count)
        fewer = make_interp_spline(places, spline(places), k=DEGREE)
        if norm(patch.points(np.asarray(fewer(course.parts))) - course.points).max() <= HALF:
            spline = fewer
            break
    edge = BRepBuilderAPI_MakeEdge(spline_curve(spline), geometry(patch)).Edge()
    BRepLib.BuildCurves3d_s(edge)
    return edge
