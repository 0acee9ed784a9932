"""Curves near surfaces, brought onto the faces that they are nearest to as curves of their parameter planes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from OCP.TopoDS import TopoDS_Edge
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.curves.curve_intervals import kept_on_face, runs_over, stretches_of
from cadpanel.brep.curves.drawn_curve import Curve
from cadpanel.brep.curves.pcurve_fit import Stretch, lay
from cadpanel.brep.curves.pieces import Piece, piece_through
from cadpanel.brep.curves.reach import ON_LIMIT, reach_of
from cadpanel.brep.curves.self_crossing import uncrossed
from cadpanel.brep.faces.closest_points import Search
from cadpanel.brep.faces.inside_test import Trim
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.face_cleanup import SkinFace
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.vectors import unit

# A curve lies nearer to another face mostly where that holds for more than this part of its points.
MOSTLY = 0.5
# A curve goes on from another one where it turns by less than an angle with this cosine.
ONWARD = 0.94


@dataclass(frozen=True, slots=True, kw_only=True)
class Landing:
    """What a set of curves leaves on a surface.

    Attributes:
        edges: for each curve its edges on the faces, none where it does not pass over the surface.
        offset: how far the farthest point of a curve lies off the surface, mm.
    """

    edges: tuple[tuple[TopoDS_Edge, ...], ...]
    offset: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Over:
    """A stretch of a curve over a face, and whether it mostly lies nearer to another face."""

    stretch: Stretch
    apart: bool


def land(surface: Surface, lines: Sequence[Array], reach: float, tolerance: float) -> Landing:
    """Bring smooth curves through points onto a surface.

    Args:
        surface: onto which.
        lines: (q, 3) points along each, mm.
        reach: how far off the surface a curve may lie, mm; what is farther away does not pass over it.
        tolerance: a curve that ends this close to the border of a face, or runs along it, reaches it, mm.

    Raises:
        ReferenceFileError: a curve cannot be followed on a face.
    """
    pieces = [(index, piece_through(line)) for index, line in enumerate(lines)]
    return _landings([surface], [reach], pieces, [f"cut {index + 1}" for index in range(len(lines))], tolerance)[0]


def land_curves(
    surfaces: Sequence[Surface], curves: Sequence[Curve], tolerance: float, curve_source: str
) -> tuple[Landing, ...]:
    """Bring the curves of a file onto the surfaces that they pass over, each onto the faces that it is nearest to.

    Args:
        surfaces: onto which.
        curves: of which all points within a part of a surface's size pass over it.
        tolerance: as above; and a curve lands on several faces on top of each other where it lies equally near to
            them to within this, mm.
        curve_source: the name of the curves' file, for messages.

    Raises:
        ReferenceFileError: a curve cannot be followed on a face.
    """
    pieces = _continued([(index, piece) for index, curve in enumerate(curves) for piece in curve.pieces])
    reaches = [reach_of(surface) for surface in surfaces]
    return _landings(surfaces, reaches, pieces, [f"{curve.called} of '{curve_source}'" for curve in curves], tolerance)


def _continued(pieces: list[tuple[int, Piece]]) -> list[tuple[int, Piece]]:
    """The same, with no own ends where one other curve goes on: there the curve does not stop short of a border."""
    sides = [(place, side) for place, (_, piece) in enumerate(pieces) for side in (0, 1) if piece.own_ends[side]]
    if not sides:
        return pieces
    lines = [pieces[place][1].points[:: -1 if side else 1] for place, side in sides]
    ends, ways = np.array([line[0] for line in lines]), unit(np.array([line[0] - line[1] for line in lines]))
    found = list(pieces)
    for number, near in enumerate(cKDTree(ends).query_ball_point(ends, CLOSE)):
        others = [other for other in near if other != number]
        if len(others) == 1 and ways[number] @ ways[others[0]] < -ONWARD:
            place, side = sides[number]
            index, piece = found[place]
            own = piece.own_ends
            found[place] = index, replace(piece, own_ends=(own[0] and side != 0, own[1] and side != 1))
    return found


def _landings(
    surfaces: Sequence[Surface],
    reaches: Sequence[float],
    pieces: Sequence[tuple[int, Piece]],
    names: Sequence[str],
    tolerance: float,
) -> tuple[Landing, ...]:
    """What is left on each surface by pieces, each with the index of its curve, of curves with names for messages."""
    if not pieces:
        return tuple(Landing(edges=(), offset=0.0) for _ in surfaces)
    tolerance += ON_LIMIT
    faces = [(place, face) for place, surface in enumerate(surfaces) for face in surface.faces]
    found = _over(faces, reaches, pieces, tolerance)
    # Where no face is the nearest one for most of a curve, all of them count.
    landed = {over.stretch.curve for overs in found for over in overs if not over.apart}
    edges: list[list[list[TopoDS_Edge]]] = [[[] for _ in names] for _ in surfaces]
    offsets = [0.0 for _ in surfaces]
    for (place, face), overs in zip(faces, found, strict=True):
        over_face = [over.stretch for over in overs if not (over.apart and over.stretch.curve in landed)]
        kept = [part for stretch in over_face for part in uncrossed(face.patch, stretch, tolerance)]
        for stretch, edge in zip(kept, lay(face.patch, kept), strict=True):
            if edge is None:
                called = names[stretch.curve]
                raise ReferenceFileError(
                    f"{called[:1].upper()}{called[1:]} cannot be followed to within {CLOSE:g} mm on face "
                    f"{face.number}: draw it onto the face, and part it where the face has a crease."
                )
            edges[place][stretch.curve].append(edge)
            offsets[place] = max(offsets[place], stretch.offset)
    return tuple(
        Landing(edges=tuple(map(tuple, own)), offset=offset) for own, offset in zip(edges, offsets, strict=True)
    )


def _over(
    faces: Sequence[tuple[int, SkinFace]],
    reaches: Sequence[float],
    pieces: Sequence[tuple[int, Piece]],
    tolerance: float,
) -> list[list[_Over]]:
    """The stretches over each face; a face comes with the place of its surface's reach."""
    points = np.concatenate([piece.points for _, piece in pieces])
    starts = np.cumsum([0, *(len(piece.points) for _, piece in pieces)]).tolist()
    sags = np.concatenate([np.broadcast_to(piece.sags, len(piece.points)) for _, piece in pieces])
    nearest = np.full(len(points), np.inf)
    found = []
    for place, face in faces:
        search = Search(face.patch)
        feet = search.feet(points)
        near = np.asarray(feet.distances <= reaches[place] + sags, dtype=np.bool_)
        inside = near.copy()
        trim = None if face.patch.whole else Trim(face.patch)
        if trim is not None:
            inside[inside] = trim.encloses(feet.parameters[inside])
        nearest = np.minimum(nearest, np.where(inside, feet.distances, np.inf))
        runs = []
        for (index, piece), start, stop in zip(pieces, starts[:-1], starts[1:], strict=True):
            runs += runs_over(search.patch, index, piece, feet.part(start, stop), start, near[start:stop], tolerance)
        if trim is not None:
            runs = kept_on_face(runs, trim, inside, tolerance)
        stretches = []
        for run, stretch in zip(runs, stretches_of(search, runs, tolerance, trim), strict=True):
            if stretch is not None:
                first, last = run.start + run.first, run.start + run.last
                where = first + np.flatnonzero(inside[first : last + 1])
                stretches.append((stretch, where, feet.distances[where], run.along))
        found.append(stretches)
    return [
        [
            _Over(
                # What runs beside a joint lies beside this face, and on the other one.
                stretch=replace(stretch, offset=float(nearest[where].max())) if along and len(where) else stretch,
                apart=bool(np.count_nonzero(distances > nearest[where] + tolerance) > MOSTLY * len(where)),
            )
            for stretch, where, distances, along in stretches
        ]
        for stretches in found
    ]
