"""A band of even width about a strip's lip, cut out of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import Akima1DInterpolator
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.curves.projection import land
from cadpanel.brep.faces.face_patch import rectangle
from cadpanel.brep.skin.adjacency import Surface, surfaces_of
from cadpanel.brep.skin.cross_sections import CrossSection, Sections, sections_of
from cadpanel.brep.skin.face_cleanup import SkinFace, measure
from cadpanel.brep.skin.lips import Lip, follow_lip, lips_midway
from cadpanel.brep.splitting.split_along_edges import split_along
from cadpanel.brep.splitting.splitter import Pieces
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import cross, norm, unit

# Parts of the strip's length at which the lip is looked for, close to both ends, and by how much the band's borders are
# drawn on beyond them.
PLACES = np.concatenate([[0.004, 0.02], np.linspace(0.05, 0.95, 19), [0.98, 0.996]])
BEYOND = 0.008
# Points along each border of the band.
BORDER_POINTS = 513
# A band along parameter lines may be off its width by this part of it.
EVEN = 0.01
# Two lips turn alike where the lesser turn is no less than this part of the other.
ALIKE = 0.9
# Lips are two where their middles are farther apart than this part of their widths together; side by side it is 0.5.
APART = 0.6
# The band's borders come from points on the surface and leave it no farther than this part of the strip's length.
NEAR_PART = 1e-3
NEAR = 1.0
# A piece lies in the band when this part of its area does, as points of the strip tell that lie around it.
MOST = 0.9
CLOUD_ACROSS, CLOUD_ALONG = 401, 201
CLOUD_REACH = 3.0
# Bands of these parts of the width are tried where one cannot be cut out.
OTHER_WIDTHS = (0.9, 1.1, 0.75, 1.35)
# What a border of the band leaves of a face is no panel's part where it is narrower than this many tolerances, or mm
# where that is more; but no wider than this part of the band.
SLIVER = 1.5
SLIVER_PART = 0.05
# Such a piece is less than this part of its face: a blend may be as narrow, and is kept.
CUT_OFF = 0.5


def lip_band(surface: Surface, width: float, source: str, tolerance: float) -> tuple[Surface, tuple[str, ...]]:
    """The part of a strip within half a width of the middle of its lip, or of that which turns most, both ways.

    Args:
        surface: a strip.
        width: of the band, along the surface, mm.
        source: the reference's name.
        tolerance: how far faces that meet may lie apart, mm.

    Returns:
        The band, and notes where there are further lips, or a border was moved to where two faces meet.

    Raises:
        ReferenceFileError: the surface is no strip, has no lip or two that turn alike, the band reaches beyond the
            surface, or the kernel cannot cut it out; then it is told whether a band of nearly that width can be.
    """
    try:
        return _band(surface, width, source, tolerance)
    except _UncutError as error:
        for part in OTHER_WIDTHS:
            other = float(f"{part * width:.2g}")
            try:
                _band(surface, other, source, tolerance)
            except (_UncutError, ReferenceFileError):
                continue
            raise ReferenceFileError(f"{error}; a band of {other:g} mm can be cut.") from error
        raise ReferenceFileError(f"{error}, nor are bands of nearly that width.") from error


class _UncutError(Exception):
    """What the kernel makes of a band that it cannot cut out, without an end."""


def _band(surface: Surface, width: float, source: str, tolerance: float) -> tuple[Surface, tuple[str, ...]]:
    sections = sections_of(surface, PLACES, source, tolerance)
    lips = sorted(lips_midway(sections), key=lambda lip: -lip.turn)
    if not lips:
        raise ReferenceFileError(
            f"The surface of {surface.numbers} of '{source}' has no lip, a stretch across it that turns fast: "
            "divide all of it."
        )
    notes = _other_lips(lips, surface, width, source)
    middles = follow_lip(sections, lips[0])
    square = _square_to_the_lip(sections, middles)
    borders = np.array(
        [
            [_border(section, own, side * width) for section, own in zip(sections.sections, square, strict=True)]
            for side in (-0.5, 0.5)
        ]
    )
    _check_room(surface, width, middles, borders, sections, source)
    faces = _along_parameters(sections, borders, surface.faces, source)
    if faces is None:
        what = f"the surface of {surface.numbers} of '{source}' along its lip"
        pieces = _cut_along_curves(surface, sections, borders, what, tolerance)
        faces = _within(pieces, surface, _cloud(sections, square, 0.5 * width), 0.5 * width, source)
    limit = min(SLIVER * max(tolerance, NEAR), SLIVER_PART * width)
    faces, moved = _without_slivers(faces, surface, limit, source)
    return _joined(faces, surface, source, tolerance), (*notes, *moved)


def _other_lips(lips: Sequence[Lip], surface: Surface, width: float, source: str) -> tuple[str, ...]:
    """What to say of lips beside the first one, which turns most.

    Raises:
        ReferenceFileError: one of them turns as much, and the band holds only one of the two.
    """
    chief = lips[0]
    # Two stretches next to each other are one lip, in the midst of which a spline turns less for a moment.
    others = [lip for lip in lips[1:] if abs(lip.middle - chief.middle) > APART * (chief.width + lip.width)]
    for lip in others:
        if lip.turn >= ALIKE * chief.turn and abs(lip.middle - chief.middle) > 0.5 * width:
            first, second = sorted((chief, lip), key=lambda one: one.middle)
            raise ReferenceFileError(
                f"The surface of {surface.numbers} of '{source}' has two lips that turn alike, by {first.turn:.0f} and "
                f"{second.turn:.0f} degrees at {first.middle:.0f} and {second.middle:.0f} mm from its long edge: "
                f"{_chosen(surface)}."
            )
    if not others:
        return ()
    most = f"another one, which turns by {others[0].turn:.0f}" if len(others) == 1 else f"{len(others)} others"
    where = f"that turns by {chief.turn:.0f} degrees, {chief.middle:.0f} mm from its long edge"
    return (
        f"The band on the surface of {surface.numbers} of '{source}' lies about the lip {where}, and not about {most}; "
        f"for another band, {_chosen(surface)}.",
    )


def _chosen(surface: Surface) -> str:
    """What to do for the band about one lip of several."""
    split = "split it between its lips where it was modelled, and " if len(surface.faces) == 1 else ""
    return f"{split}choose the faces of the lip that is meant"


def _square_to_the_lip(sections: Sections, middles: Array) -> list[Array]:
    """For each section the (q,) distances of its points from the lip's middle, square to the lip, mm.

    On a swept wing the sections themselves are longer than that.
    """
    line = np.array([section.at(middles[[i]])[0] for i, section in enumerate(sections.sections)])
    along = unit(np.gradient(line, sections.parts, axis=0))
    found = []
    for section, middle, way in zip(sections.sections, middles, along, strict=True):
        steps = norm(cross(np.broadcast_to(way, (len(section.points) - 1, 3)), np.diff(section.points, axis=0)))
        distance = np.concatenate([[0.0], np.cumsum(steps)])
        found.append(distance - np.interp(middle, section.length, distance))
    return found


def _border(section: CrossSection, square: Array, wanted: float) -> float:
    """The length on a section at a distance from the lip; beyond a long edge it goes on along the section."""
    beyond = min(wanted - float(square[0]), 0.0) + max(wanted - float(square[-1]), 0.0)
    return float(np.interp(wanted, square, section.length)) + beyond


def _check_room(
    surface: Surface, width: float, middles: Array, borders: Array, sections: Sections, source: str
) -> None:
    """Refuse a band that does not lie on the surface.

    Raises:
        ReferenceFileError: both its borders lie beyond it, or one of them somewhere.
    """
    widths = np.array([section.length[-1] for section in sections.sections])
    if np.all(borders[0] <= 0.0) and np.all(borders[1] >= widths):
        raise ReferenceFileError(
            f"The surface of {surface.numbers} of '{source}' is {widths.min():.6g} mm wide, no more than the band of "
            f"{width:g} mm about its lip: divide all of it."
        )
    if np.any(borders[0] <= 0.0) or np.any(borders[1] >= widths):
        # Of the sections' halves as long as the band's, the shortest tells how wide a band has room everywhere.
        room = np.minimum(middles / (middles - borders[0]), (widths - middles) / (borders[1] - middles))
        raise ReferenceFileError(
            f"The band of {width:g} mm about the lip of the surface of {surface.numbers} of '{source}' runs over its "
            f"long edge: give less than {width * float(room.min()):.6g} mm, or divide all of it."
        )


def _along_parameters(
    sections: Sections, borders: Array, faces: Sequence[SkinFace], source: str
) -> list[SkinFace] | None:
    """The band between parameter lines of the lanes, exactly; None where these do not keep it even."""
    if sections.lanes is None or sections.lane is None or sections.across is None:
        return None
    # Places across all lanes as one number: lanes in their order across, and the points of each.
    count = np.arange(len(sections.lane), dtype=np.float64)
    wanted = np.array([np.interp(borders[:, i], one.length, count) for i, one in enumerate(sections.sections)])
    low, high = wanted.mean(axis=0)
    for index, section in enumerate(sections.sections):
        off = np.interp([low, high], count, section.length) - np.clip(borders[:, index], 0.0, section.length[-1])
        if np.abs(off).max() > EVEN * float(borders[1, index] - borders[0, index]):
            return None
    kept = []
    for number in dict.fromkeys(sections.lane.tolist()):
        own = np.flatnonzero(sections.lane == number).astype(np.float64)
        if own[-1] <= low or own[0] >= high:
            continue
        lane = sections.lanes.lanes[number]
        ends = np.interp([max(low, own[0]), min(high, own[-1])], own, sections.across[own.astype(np.intp)])
        first, last = sorted(lane.patch.at(lane.axis, np.zeros(2), ends)[:, 1 - lane.axis].tolist())
        along = tuple(lane.patch.bounds[lane.axis].tolist())
        ranges = (along, (first, last)) if lane.axis == 0 else ((first, last), along)
        kept.append(measure(replace(faces[number].source, face=rectangle(lane.patch, *ranges)), source))
    return [face for face in kept if face is not None]


def _cut_along_curves(surface: Surface, sections: Sections, borders: Array, what: str, tolerance: float) -> Pieces:
    """Cut the surface by curves through points of its sections, (curves, n) lengths on them, by the kernel."""
    fine = np.linspace(-BEYOND, 1.0 + BEYOND, BORDER_POINTS)
    curves = []
    for border in borders:
        points = np.array([section.at(border[[i]])[0] for i, section in enumerate(sections.sections)])
        curves.append(_between(PLACES, points, fine))
    landing = land(surface, curves, max(NEAR, NEAR_PART * sections.strip_length), tolerance)
    tools = [edge for edges in landing.edges for edge in edges]
    return split_along([face.patch.face for face in surface.faces], tools, what)


def _cloud(sections: Sections, square: Sequence[Array], half: float) -> tuple[Array, Array]:
    """(m, 3) points of the strip, and their (m,) distances from the lip's middle, square to it.

    Between two sections they lie on lines of one distance. They reach as far beyond the band as it is wide: what lies
    farther off is nearest to the outermost of them.
    """
    low, high = min(own[0] for own in square), max(own[-1] for own in square)
    distances = np.linspace(max(low, -CLOUD_REACH * half), min(high, CLOUD_REACH * half), CLOUD_ACROSS)
    lines = np.array(
        [
            section.at(np.interp(distances, own, section.length))
            for section, own in zip(sections.sections, square, strict=True)
        ]
    )
    fine = np.linspace(0.0, 1.0, CLOUD_ALONG)
    points = _between(sections.parts, lines, fine)
    return points.reshape(-1, 3), np.tile(distances, CLOUD_ALONG)


def _between(parts: Array, points: Array, fine: Array) -> Array:
    """What goes smoothly through points (n, ...) at (n,) parts of the strip's length, and a little beyond.

    By Akima's curve, whose way at a point hangs on its neighbours only: a kink of the surface's outline does not make
    it swing elsewhere.
    """
    found: Array = Akima1DInterpolator(parts, points, extrapolate=True)(fine)
    return found


def _within(pieces: Pieces, surface: Surface, cloud: tuple[Array, Array], half: float, source: str) -> list[SkinFace]:
    """The pieces that lie no farther than half a width from the lip."""
    tree = cKDTree(cloud[0])
    kept = []
    for face, parts in zip(surface.faces, pieces.faces, strict=True):
        for part in parts:
            piece = measure(replace(face.source, face=part), source)
            if piece is None:
                continue
            near = np.abs(cloud[1][tree.query(piece.samples.points)[1]]) <= half
            share = float(piece.samples.weights @ near) / piece.area
            if 1.0 - MOST < share < MOST:
                raise _UncutError(
                    f"The band about the lip of face {face.number} of '{source}' is not cut by the CAD kernel"
                )
            if share >= MOST:
                kept.append(piece)
    return kept


def _without_slivers(
    faces: Sequence[SkinFace], surface: Surface, limit: float, source: str
) -> tuple[list[SkinFace], tuple[str, ...]]:
    """Make the band's border where two faces meet, where what it leaves beyond is no wider than a limit, mm.

    Returns:
        The pieces that stay, and a note on those that do not.
    """
    whole = {face.number: face.area for face in surface.faces}
    widths = [2.0 * face.area / sum(arc_length(edge)[-1] for edge in face.samples.edges) for face in faces]
    slivers = {
        index: width
        for index, (face, width) in enumerate(zip(faces, widths, strict=True))
        if width <= limit and face.area < CUT_OFF * whole[face.number]
    }
    kept = [face for index, face in enumerate(faces) if index not in slivers]
    if not slivers or not kept:
        return list(faces), ()
    widest = max(slivers, key=lambda index: slivers[index])
    return kept, (
        f"The border of the band about the lip of '{source}' would take in only {slivers[widest]:.2g} mm of "
        f"face {faces[widest].number}, and is made where that face begins.",
    )


def _joined(faces: Sequence[SkinFace], surface: Surface, source: str, tolerance: float) -> Surface:
    """The pieces as a surface under the old name."""
    found, _ = surfaces_of(faces, source, tolerance)
    if len(found) != 1:
        raise _UncutError(
            f"The band about the lip of the surface of {surface.numbers} of '{source}' falls into {len(found)} parts"
        )
    return replace(found[0], name=surface.name)
