"""Cross-sections of a strip, from one long edge to the other, and how its normals turn on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.skin.iso_strip import Lanes, find_lanes
from cadpanel.brep.skin.split_by_planes import THROUGH, cut_by_planes
from cadpanel.brep.skin.strip import find_strip
from cadpanel.brep.skin.strip_direction import turning_angles
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.polyline import arc_length, interpolate
from cadpanel.geometry.vectors import norm

# Points of a section on each face that it crosses, and on the mean of several sections.
POINTS = 257
MEAN_POINTS = 1025


@dataclass(frozen=True, slots=True, kw_only=True)
class CrossSection:
    """A strip across.

    Attributes:
        points: (q, 3) from one long edge to the other, mm.
        length: (q,) walked up to each of them, mm.
        turn: (q,) by how much the normals have turned up to there, radians.
    """

    points: Array
    length: Array
    turn: Array

    def at(self, lengths: Array) -> Array:
        """(k, 3) points at (k,) lengths."""
        return np.stack([np.interp(lengths, self.length, self.points[:, axis]) for axis in range(3)], axis=-1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sections:
    """Cross-sections that follow each other along a strip.

    Attributes:
        parts: (n,) where, as parts of the strip's length.
        sections: n of them, each begun at the same long edge.
        strip_length: mean length of the long edges, mm.
        lanes: the faces as lanes, where they are lanes; every section then follows parameter lines.
        lane, across: (q,) which lane each point of any section lies on, and at which part of its range; None without.
    """

    parts: Array
    sections: tuple[CrossSection, ...]
    strip_length: float
    lanes: Lanes | None = None
    lane: IntArray | None = None
    across: Array | None = None

    @property
    def mean(self) -> tuple[Array, Array]:
        """Lengths across the strip, and by how much normals have turned up to there, in the mean of all sections."""
        parts = np.linspace(0.0, 1.0, MEAN_POINTS)
        widths = [float(section.length[-1]) for section in self.sections]
        turns = [np.interp(parts, section.length / section.length[-1], section.turn) for section in self.sections]
        return parts * float(np.mean(widths)), np.asarray(np.mean(turns, axis=0), dtype=np.float64)


def sections_of(surface: Surface, parts: Array, source: str, tolerance: float) -> Sections:
    """Cross-sections at (n,) rising parts of a strip's length, neither 0 nor 1.

    Faces side by side that share a parameter are walked across along their parameter lines, all others along planes
    through both long edges. Faces that meet may lie apart by the tolerance, mm.

    Raises:
        ReferenceFileError: the surface is no strip, or cannot be cut across.
    """
    lanes = find_lanes(surface)
    if lanes is not None and lanes.outer:
        found = _along_lanes(lanes, parts)
        if found is not None:
            return found
    strip = find_strip(surface, source, tolerance)
    cuts = strip.planes(parts)
    groups = cut_by_planes(surface, cuts, source)
    starts = strip.points(parts)[0]
    sections = [_in_plane(groups[index], cuts, index, starts[index]) for index in range(len(parts))]
    for index, section in enumerate(sections):
        if section is None:
            x, y, z = cuts.origins[index]
            raise ReferenceFileError(
                f"The surface of {surface.numbers} of '{source}' has no whole section at ({x:.1f}, {y:.1f}, {z:.1f})."
            )
    return Sections(
        parts=parts,
        sections=tuple(section for section in sections if section is not None),
        strip_length=strip.length,
    )


def _along_lanes(lanes: Lanes, parts: Array) -> Sections | None:
    """Sections along the lanes' own parameter lines, or None where they are no chain from edge to edge."""
    order = lanes.order()
    if order is None:
        return None
    points, normals, numbers, acrosses = [], [], [], []
    places = lanes.at_lengths(parts)
    for index, forward in order:
        across = np.linspace(0.0, 1.0, POINTS) if forward else np.linspace(1.0, 0.0, POINTS)
        lane = lanes.lanes[index]
        parameters = lane.patch.at(lane.axis, lane.own(places)[:, None], across[None, :])
        points.append(lane.patch.points(parameters))
        normals.append(_defined(lane.patch.normals(parameters)))
        numbers.append(np.full(POINTS, index))
        acrosses.append(across)
    return Sections(
        parts=parts,
        sections=tuple(
            _section([line[place] for line in points], [line[place] for line in normals]) for place in range(len(parts))
        ),
        strip_length=float(lanes.reach()[-1]),
        lanes=lanes,
        lane=np.concatenate(numbers),
        across=np.concatenate(acrosses),
    )


def _defined(normals: Array) -> Array:
    """Normals (..., q, 3) along lines, those that a surface does not have (at a pole or an apex) as they are beside."""
    has_one = np.einsum("...d,...d->...", normals, normals) > 0.5
    if has_one.all():
        return normals
    places = np.arange(normals.shape[-2])
    distance = np.where(has_one[..., None, :], np.abs(places[:, None] - places), len(places))
    return np.take_along_axis(normals, distance.argmin(axis=-1)[..., None], axis=-2)


def _in_plane(faces: Sequence[TopoDS_Face], cuts: Cuts, index: int, start: Array) -> CrossSection | None:
    """The section that bounds faces in a plane, walked from the end that is nearest to `start`."""
    lines = []
    for face in faces:
        patch = patch_of(face)
        for edge in patch.edges:
            if np.abs((edge.points - cuts.origins[index]) @ cuts.normals[index]).max() > THROUGH:
                continue
            places = np.arange(len(edge.points), dtype=np.float64)
            fine = interpolate([places], edge.parameters, [np.linspace(0.0, places[-1], POINTS)])
            lines.append((patch.points(fine), _defined(patch.normals(fine))))
    points, normals, here = [], [], start
    while lines:
        ends = np.array([norm(line[0][[0, -1]] - here) for line in lines])
        nearest, end = np.unravel_index(ends.argmin(), ends.shape)
        line, turned = lines.pop(int(nearest))
        step = -1 if end else 1
        points.append(line[::step])
        normals.append(turned[::step])
        here = points[-1][-1]
    return _section(points, normals) if points else None


def _section(points: Sequence[Array], normals: Sequence[Array]) -> CrossSection:
    """A section of the lines on several faces, the end of one where the next one begins."""
    lengths, turns = [], []
    length, turn = 0.0, 0.0
    for index, (line, across) in enumerate(zip(points, normals, strict=True)):
        if index:
            # Neighbours may have their normals on different sides.
            length += float(norm(line[0] - points[index - 1][-1]))
            turn += float(np.arccos(np.clip(abs(across[0] @ normals[index - 1][-1]), 0.0, 1.0)))
        angles = turning_angles(across)
        lengths.append(length + arc_length(line))
        turns.append(turn + np.concatenate([[0.0], np.cumsum(angles)]))
        length, turn = float(lengths[-1][-1]), float(turns[-1][-1])
    return CrossSection(points=np.concatenate(points), length=np.concatenate(lengths), turn=np.concatenate(turns))
