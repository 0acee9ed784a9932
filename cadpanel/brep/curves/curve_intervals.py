"""Runs of a curve's points over a patch, and where the curve enters and leaves it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.curves.pcurve_fit import Stretch
from cadpanel.brep.curves.pieces import Piece
from cadpanel.brep.curves.reach import ON_LIMIT
from cadpanel.brep.faces.boundary import evaluate
from cadpanel.brep.faces.closest_points import Feet, Search
from cadpanel.brep.faces.face_patch import Patch
from cadpanel.brep.faces.inside_test import Trim
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.geometry.vectors import norm

# A jump of more than this part of the parameter range goes over the seam of a closed surface.
JUMP = 0.5
# Halvings by which the place is found where a curve leaves a face.
HALVINGS = 40
# A stretch along a border shorter than this many tolerances is where a curve crosses it.
LONG_STRETCH = 10.0
# A stretch shorter than this is a touch, mm.
TOUCH = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Points of a piece that follow each other over a patch.

    Attributes:
        curve: index of the curve.
        piece: which smooth piece of it.
        feet: on the patch, of all points of the piece.
        start: the place of the piece's first point among those of all pieces.
        first: the first of the points that lie over the patch.
        last: the last of them.
        along: whether they lie along its border.
        cut_short: whether at the first and at the last of them the curve leaves the face, though not its surface.
    """

    curve: int
    piece: Piece
    feet: Feet
    start: int
    first: int
    last: int
    along: bool
    cut_short: tuple[bool, bool] = (False, False)

    def goes_on(self, side: int) -> bool:
        """Whether the piece has a point beyond the first (-1) or the last one (1)."""
        return self.first > 0 if side < 0 else self.last < len(self.piece.points) - 1


def runs_over(
    patch: Patch, index: int, piece: Piece, feet: Feet, start: int, near: BoolArray, tolerance: float
) -> list[Run]:
    """The runs of those of a piece's points that are near a patch over it, and those along its border.

    Points belong to the border that lie beside it by no more than the tolerance, however far above: a curve over the
    joint of two faces has no feet inside either.
    """
    inside = near & ~feet.by_border
    beside = near & feet.by_border & (feet.asides <= tolerance)
    return [
        Run(curve=index, piece=piece, feet=feet, start=start, first=first, last=last, along=along)
        for chosen, along in ((inside, False), (beside, True))
        for first, last in _parted(chosen, feet.parameters, patch)
    ]


def kept_on_face(runs: Sequence[Run], trim: Trim, enclosed: BoolArray, tolerance: float) -> list[Run]:
    """Runs without what lies clearly beyond the border of the face; one of which nothing is left is kept out.

    Args:
        runs: over the face's surface.
        trim: the face's border.
        enclosed: of the points of all pieces, those whose feet lie on the face.
        tolerance: what runs this close beside the border stays, mm.
    """
    found = []
    for run in runs:
        own = enclosed[run.start + run.first : run.start + run.last + 1]
        left = np.ones(len(own), dtype=np.bool_)
        for first, last in _stretches(np.flatnonzero(~own)):
            line = run.feet.parameters[run.first + first : run.first + last + 1]
            left[first : last + 1] = not trim.leaves_out(line, tolerance)
        for first, last in _stretches(np.flatnonzero(left)):
            short = (first > 0, last < len(own) - 1)
            found.append(replace(run, first=run.first + first, last=run.first + last, cut_short=short))
    return found


def _stretches(places: IntArray) -> list[tuple[int, int]]:
    """First and last of each stretch of rising places that follow each other."""
    parts = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)
    return [(int(part[0]), int(part[-1])) for part in parts if len(part)]


def _parted(chosen: BoolArray, parameters: Array, patch: Patch) -> list[tuple[int, int]]:
    """First and last index of each run of chosen points, parted where the parameters jump over a seam."""
    places = np.flatnonzero(chosen)
    if not len(places):
        return []
    jumps = (np.abs(np.diff(parameters[places], axis=0)) > JUMP * np.ptp(patch.bounds, axis=1)).any(axis=1)
    breaks = np.flatnonzero((np.diff(places) > 1) | jumps)
    firsts = np.concatenate([[0], breaks + 1])
    lasts = np.concatenate([breaks, [len(places) - 1]])
    return list(zip(places[firsts].tolist(), places[lasts].tolist(), strict=True))


def stretches_of(search: Search, runs: Sequence[Run], tolerance: float, trim: Trim | None) -> list[Stretch | None]:
    """The stretch of each run, up to the border where the curve reaches it; None where it hardly touches the patch.

    Args:
        search: on the patch.
        runs: over it.
        tolerance: what ends this close to the border reaches it, mm.
        trim: the border of its face, where that cuts runs short.
    """
    ends = [(run, side) for run in runs for side in (-1, 1)]
    crossing = [end for end in ends if end[0].goes_on(end[1])]
    crossed = iter(_crossings(search, crossing, tolerance, trim))
    added = [next(crossed) if run.goes_on(side) else _own_end(search, run, side, tolerance) for run, side in ends]
    found: list[Stretch | None] = []
    for run, before, after in zip(runs, added[::2], added[1::2], strict=True):
        own = slice(run.first, run.last + 1)
        places = np.concatenate([before[:, 0], run.piece.parameters[own], after[:, 0]])
        line = np.concatenate([before[:, 1:], run.feet.parameters[own], after[:, 1:]])
        shortest = LONG_STRETCH * tolerance if run.along else TOUCH
        long = norm(np.diff(search.patch.points(line), axis=0)).sum() > shortest
        offset = float(run.feet.distances[own].max())
        stretch = Stretch(curve=run.curve, piece=run.piece, places=places, line=line, offset=offset)
        found.append(stretch if long else None)
    return found


def _crossings(search: Search, ends: Sequence[tuple[Run, int]], tolerance: float, trim: Trim | None) -> list[Array]:
    """What to add to runs at ends where the curve goes on: (1, 3) the parameter of the piece, and two of the patch.

    That is where it leaves the border after a run along it, else where it reaches the border: that of the face where it
    cuts the run short, or that of its surface.
    """
    if not ends:
        return []
    bounds = search.patch.bounds
    along = np.array([run.along for run, _ in ends])
    cut_short = np.flatnonzero([run.cut_short[0 if side < 0 else 1] for run, side in ends])
    places = [run.last if side > 0 else run.first for run, side in ends]
    here = np.array([run.feet.parameters[place] for (run, _), place in zip(ends, places, strict=True)])
    inner = np.array([run.piece.parameters[place] for (run, _), place in zip(ends, places, strict=True)])
    outer = np.array([run.piece.parameters[place + side] for (run, side), place in zip(ends, places, strict=True)])
    start = here.copy()

    def points(at: Array) -> Array:
        return np.concatenate([run.piece.at(at[[index]]) for index, (run, _) in enumerate(ends)])

    for _ in range(HALVINGS):
        middle = 0.5 * (inner + outer)
        feet = search.feet(points(middle), start)
        within = np.where(along, feet.by_border & (feet.asides <= tolerance), ~feet.on_border)
        if trim is not None and len(cut_short):
            within[cut_short] = trim.encloses(feet.parameters[cut_short])
        inner, outer = np.where(within, middle, inner), np.where(within, outer, middle)
        start[within] = feet.parameters[within]
    at = np.where(along, inner, outer)
    feet = search.feet(points(at), start)
    reached = feet.parameters
    # The place is found from a hair inside the border, and the next point may lie by it: both are meant to be on it.
    for index in np.setdiff1d(np.flatnonzero(~along & feet.by_border), cut_short).tolist():
        reached[index] = _clamped(reached[index], bounds)
    for index in np.flatnonzero(np.abs(reached - here).max(axis=1) > JUMP * np.ptp(bounds, axis=1).max()).tolist():
        reached[index] = _clamped(here[index], bounds)
    return list(np.column_stack([at, reached])[:, None])


def _own_end(search: Search, run: Run, side: int, tolerance: float) -> Array:
    """What to add to a run that ends with its piece: a border within the tolerance was meant.

    Returns:
        (0 or 1, 3) no parameter of the piece, as it is drawn on, and the two of the patch.
    """
    if not run.piece.own_ends[0 if side < 0 else 1]:
        return np.zeros((0, 3))
    here = run.feet.parameters[run.last if side > 0 else run.first]
    bounds = search.patch.bounds
    _, along_u, along_v = evaluate(search.patch.surface, here[None])
    speeds = np.array([np.linalg.norm(along_u), np.linalg.norm(along_v)])
    gaps = np.abs(here[:, None] - bounds) * speeds[:, None]
    if run.along:
        gaps[gaps <= CLOSE] = np.inf
    # Of two as near, beside a corner, the first.
    axis, border = np.unravel_index(int((gaps <= gaps.min() + ON_LIMIT).argmax()), gaps.shape)
    if gaps[axis, border] > tolerance:
        return np.zeros((0, 3))
    reached = here.copy()
    reached[axis] = bounds[axis, border]
    return np.concatenate([[np.nan], reached])[None]


def _clamped(parameters: Array, bounds: Array) -> Array:
    """The parameters moved to the nearest border of the range."""
    parts = np.abs(parameters[:, None] - bounds) / np.ptp(bounds, axis=1)[:, None]
    axis, border = np.unravel_index(int(parts.argmin()), parts.shape)
    moved = parameters.copy()
    moved[axis] = bounds[axis, border]
    return moved
