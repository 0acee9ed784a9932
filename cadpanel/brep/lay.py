"""Curves of a patch's parameter plane that follow what was drawn near the patch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepLib import BRepLib
from OCP.TopoDS import TopoDS_Edge
from scipy.interpolate import BSpline, make_interp_spline

from cadpanel.brep.feet import Search
from cadpanel.brep.patch import Patch, geometry
from cadpanel.brep.slices import DEGREE, spline_curve
from cadpanel.brep.smooth import CLOSE, Piece
from cadpanel.reference.polyline import arc_length, norm, unit

Array = NDArray[np.float64]

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


def lay(patch: Patch, stretches: Sequence[Stretch]) -> list[TopoDS_Edge | None]:
    """The edges on a patch along stretches, to within CLOSE; None where that cannot be reached."""
    search = Search(patch)
    found: list[TopoDS_Edge | None] = [None] * len(stretches)
    active = {place: _tidy(patch, stretch) for place, stretch in enumerate(stretches)}
    for _ in range(ROUNDS):
        if not active:
            break
        splines = {place: _spline(patch, stretch) for place, stretch in active.items()}
        middles = {place: 0.5 * (stretch.places[:-1] + stretch.places[1:]) for place, stretch in active.items()}
        drawn = {place: np.isfinite(at) for place, at in middles.items()}
        points = [active[place].piece.at(middles[place][drawn[place]]) for place in active]
        starts = [0.5 * (active[place].line[:-1] + active[place].line[1:])[drawn[place]] for place in active]
        feet = search.feet(np.concatenate(points), np.concatenate(starts)).parameters
        parts = np.split(feet, np.cumsum([len(own) for own in points])[:-1])
        for place, own in zip(list(active), parts, strict=True):
            stretch = active[place]
            segments = np.flatnonzero(drawn[place])
            off = _deviations(patch, stretch, splines[place], own, segments)
            if off.max(initial=0.0) <= HALF:
                found[place] = _edge(patch, stretch, splines[place])
                del active[place]
                continue
            bad = off > HALF
            active[place] = replace(
                stretch,
                places=np.insert(stretch.places, segments[bad] + 1, middles[place][segments[bad]]),
                line=np.insert(stretch.line, segments[bad] + 1, own[bad], axis=0),
            )
            if len(active[place].places) > MOST_POINTS:
                del active[place]
    return found


def _tidy(patch: Patch, stretch: Stretch) -> Stretch:
    """Without points that lie on the one before."""
    reached = arc_length(patch.points(stretch.line))
    keep = np.concatenate([[True], np.diff(reached) > SAME * reached[-1]])
    return replace(stretch, places=stretch.places[keep], line=stretch.line[keep])


def _spline(patch: Patch, stretch: Stretch) -> BSpline:
    """The spline through all points, by the part of the way along them."""
    reached = arc_length(patch.points(stretch.line))
    return make_interp_spline(reached / reached[-1], stretch.line, k=min(DEGREE, len(reached) - 1))


def _deviations(patch: Patch, stretch: Stretch, spline: BSpline, feet: Array, segments: NDArray[np.intp]) -> Array:
    """How far the spline passes beside (m, 2) feet in the middles of (m,) segments, mm."""
    points, middles = patch.points(stretch.line), patch.points(feet)
    reached = arc_length(points)
    before, after = norm(middles - points[segments]), norm(points[segments + 1] - middles)
    part = before / np.maximum(before + after, np.finfo(float).tiny)
    at = (reached[segments] + part * np.diff(reached)[segments]) / reached[-1]
    away = middles - patch.points(np.asarray(spline(at)))
    # Where along the spline a foot lies is known roughly only, and does not matter.
    along = unit(points[segments + 1] - points[segments])
    return norm(away - np.sum(away * along, axis=1)[:, None] * along)


def _edge(patch: Patch, stretch: Stretch, spline: BSpline) -> TopoDS_Edge:
    """The edge along a spline, with no more poles than it needs."""
    reached = arc_length(patch.points(stretch.line))
    parts = reached / reached[-1]
    points = patch.points(stretch.line)
    for count in COUNTS:
        places = np.linspace(0.0, 1.0, count)
        fewer = make_interp_spline(places, spline(places), k=DEGREE)
        if count < len(parts) and norm(patch.points(np.asarray(fewer(parts))) - points).max() <= HALF:
            spline = fewer
            break
    edge = BRepBuilderAPI_MakeEdge(spline_curve(spline), geometry(patch)).Edge()
    BRepLib.BuildCurves3d_s(edge)
    return edge
