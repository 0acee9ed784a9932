"""A strip cut into a number of panels of equal length along it: the paper's way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from OCP.TopoDS import TopoDS_Face
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.cutting.cut_panel import CutPanel, along_panels
from cadpanel.brep.cutting.lip_band import lip_band
from cadpanel.brep.cutting.smallest_panel import require_room
from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.skin.adjacency import Surface, surfaces_of
from cadpanel.brep.skin.belt import find_belt
from cadpanel.brep.skin.face_cleanup import SkinFace, measure
from cadpanel.brep.skin.iso_strip import find_lanes
from cadpanel.brep.skin.ring import find_ring
from cadpanel.brep.skin.split_by_planes import cut_by_planes
from cadpanel.brep.skin.strip import NoStripError, find_strip
from cadpanel.errors import CadpanelError, ReferenceFileError
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import norm

# Points of a long edge by which its length is measured.
EDGE_POINTS = 257


def cut_lip(
    surface: Surface, count: int, width: float, source: str, tolerance: float
) -> tuple[tuple[CutPanel, ...], tuple[str, ...]]:
    """Cut the band of a width about a strip's lip, mm, where its long edges have equal parts.

    Returns:
        The panels, and notes.

    Raises:
        ReferenceFileError: the surface is no strip, has no lip that could be meant, or cannot be cut.
    """
    halves = _halves(surface, source, tolerance)
    if halves is None:
        try:
            band, notes = lip_band(surface, width, source, tolerance)
        except NoStripError as error:
            if not _divides(surface, count, source, tolerance):
                raise
            raise ReferenceFileError(
                f"The surface of {surface.numbers} of '{source}' has no two long edges between which a lip could be "
                "told, but all of it can be divided: leave the band out."
            ) from error
        return cut_lengths(band, count, source, tolerance), notes
    bands = [lip_band(half, width, source, tolerance) for half in halves]
    faces = [face for band, _ in bands for face in band.faces]
    found, _ = surfaces_of(faces, source, tolerance)
    if len(found) != 1:
        raise ReferenceFileError(
            f"The band about the lip of the surface of {surface.numbers} of '{source}' does not close to a ring as the "
            "surface does: choose faces that do not go all the way round."
        )
    panels = cut_lengths(replace(found[0], name=surface.name), count, source, tolerance)
    return panels, tuple(note for _, notes in bands for note in notes)


def _divides(surface: Surface, count: int, source: str, tolerance: float) -> bool:
    """Whether all of a surface can be cut into so many panels."""
    try:
        return bool(cut_lengths(surface, count, source, tolerance))
    except CadpanelError:
        return False


def _halves(surface: Surface, source: str, tolerance: float) -> tuple[Surface, ...] | None:
    """A ring as two strips that meet at both ends, whose lips can be told; None of what is no ring."""
    lanes = find_lanes(surface)
    if lanes is not None and lanes.outer:
        return None
    ring = find_ring(surface)
    belt = None if ring is not None else find_belt(surface, source, tolerance)
    if ring is not None and ring.length >= ring.width:
        groups = ring.cut(2, tolerance)
    elif belt is not None:
        groups = belt.cut(surface, 2, source)
    else:
        return None
    halves = [surfaces_of(_pieces(group, surface, source), source, tolerance)[0] for group in groups]
    return tuple(replace(half, name=surface.name) for found in halves for half in found)


def _pieces(pieces: Sequence[TopoDS_Face], surface: Surface, source: str) -> list[SkinFace]:
    """Pieces of a surface's faces, each with what the file says of the face that it lies on."""
    owners = np.repeat(np.arange(len(surface.faces)), [len(face.samples.points) for face in surface.faces])
    tree = cKDTree(np.concatenate([face.samples.points for face in surface.faces]))
    found = []
    for piece in pieces:
        (samples,) = sample_faces(piece)
        owner = int(np.bincount(owners[tree.query(samples.points)[1]]).argmax())
        found.append(measure(replace(surface.faces[owner].source, face=piece), source))
    return [piece for piece in found if piece is not None]


def cut_lengths(surface: Surface, count: int, source: str, tolerance: float) -> tuple[CutPanel, ...]:
    """Cut a strip where the mean length of its two long edges has equal parts.

    Faces side by side that share their parameter along the strip are cut along parameter lines, without any boolean,
    as are faces that follow each other round a ring, no wider than it is long, in rows with common joints. All others,
    strips and rings, are cut by planes through the two long edges, square to the strip.

    Args:
        surface: what to cut.
        count: number of panels.
        source: the reference's name.
        tolerance: how far faces that meet may lie apart, mm.

    Raises:
        ReferenceFileError: the surface is no strip, or cannot be cut.
        SettingsError: it has no room for so many panels.
    """
    what = f"the surface of {surface.numbers} of '{source}'"
    lanes = find_lanes(surface)
    parts = np.linspace(0.0, 1.0, count + 1)
    if lanes is None or not lanes.outer:
        ring = find_ring(surface)
        if ring is not None and ring.length >= ring.width:
            _require_parts(count, what)
            require_room([ring.longest], 0.0, count, what, tolerance)
            return along_panels(surface.name, ring.cut(count, tolerance))
        if ring is not None or lanes is not None:
            raise ReferenceFileError(
                f"T{what[1:]} is closed round its length, and a panel cannot go round: cut it both ways, with a grid."
            )
        belt = find_belt(surface, source, tolerance)
        if belt is not None:
            _require_parts(count, what)
            require_room([belt.length], 0.0, count, what, tolerance)
            return along_panels(surface.name, belt.cut(surface, count, source))
    if lanes is not None:
        _require_room(lanes.edges(np.linspace(0.0, 1.0, EDGE_POINTS)), count, what, tolerance)
        parts[1:-1] = lanes.at_lengths(parts[1:-1])
        return along_panels(surface.name, lanes.cut(parts))
    strip = find_strip(surface, source, tolerance)
    _require_room(np.array(strip.edges), count, what, tolerance)
    if count == 1:
        return along_panels(surface.name, [[face.patch.face for face in surface.faces]])
    return along_panels(surface.name, cut_by_planes(surface, strip.planes(parts[1:-1]), source))


def _require_parts(count: int, what: str) -> None:
    if count == 1:
        raise ReferenceFileError(
            f"T{what[1:]} closes to a ring, and a panel cannot go round: divide it into 2 or more."
        )


def _require_room(edges: Array, count: int, what: str, tolerance: float) -> None:
    """Refuse more panels than there is room for between two long edges, (2, q, 3) points."""
    lengths = [float(arc_length(edge)[-1]) for edge in edges]
    require_room(lengths, float(norm(edges[1] - edges[0]).min()), count, what, tolerance)
