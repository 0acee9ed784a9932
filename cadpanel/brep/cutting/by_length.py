"""A strip cut along its length into equal panels: so many, or as few as are no longer than allowed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from OCP.TopoDS import TopoDS_Face
from scipy.spatial import cKDTree

from cadpanel.brep.cutting.cut_panel import CutPanel, along_panels
from cadpanel.brep.cutting.divisions import division_of
from cadpanel.brep.cutting.fewest import fewest
from cadpanel.brep.cutting.lip_band import lip_band
from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.skin.adjacency import Surface, surfaces_of
from cadpanel.brep.skin.belt import find_belt
from cadpanel.brep.skin.face_cleanup import SkinFace, measure
from cadpanel.brep.skin.iso_strip import find_lanes
from cadpanel.brep.skin.ring import find_ring
from cadpanel.errors import CadpanelError, NoStripError, ReferenceFileError
from cadpanel.reference.settings import Seams


@dataclass(frozen=True, slots=True, kw_only=True)
class Lengths:
    """How a strip is divided.

    Attributes:
        count: number of panels; None where their length tells it.
        longest: length that no panel may exceed along either long edge, mm.
        seams: which planes part them.
        most_turn: by how much one of conjugate seams may be turned from square, radians.
    """

    count: int | None
    longest: float | None
    seams: Seams
    most_turn: float


def cut_lip(
    surface: Surface, how: Lengths, width: float, source: str, tolerance: float
) -> tuple[tuple[CutPanel, ...], tuple[str, ...]]:
    """Cut the band of a width about a strip's lip, mm, along its length.

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
            if not _divides(surface, how, source, tolerance):
                raise
            raise ReferenceFileError(
                f"The surface of {surface.numbers} of '{source}' has no two long edges between which a lip could be "
                "told, but all of it can be divided: leave the band out."
            ) from error
        return cut_lengths(band, how, source, tolerance), notes
    bands = [lip_band(half, width, source, tolerance) for half in halves]
    faces = [face for band, _ in bands for face in band.faces]
    found, _ = surfaces_of(faces, source, tolerance)
    if len(found) != 1:
        raise ReferenceFileError(
            f"The band about the lip of the surface of {surface.numbers} of '{source}' does not close to a ring as the "
            "surface does: choose faces that do not go all the way round."
        )
    panels = cut_lengths(replace(found[0], name=surface.name), how, source, tolerance)
    return panels, tuple(note for _, notes in bands for note in notes)


def _divides(surface: Surface, how: Lengths, source: str, tolerance: float) -> bool:
    """Whether all of a surface can be divided so."""
    try:
        return bool(cut_lengths(surface, how, source, tolerance))
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


def cut_lengths(surface: Surface, how: Lengths, source: str, tolerance: float) -> tuple[CutPanel, ...]:
    """Cut a strip where the mean length of its two long edges has equal parts; with level seams, its height.

    Args:
        surface: what to cut.
        how: into what.
        source: the reference's name.
        tolerance: how far faces that meet may lie apart, mm.

    Raises:
        ReferenceFileError: the surface is no strip, or cannot be cut.
        SettingsError: it has no room for so many panels.
    """
    division = division_of(surface, how.seams, how.most_turn, source, tolerance)
    count = how.count
    if count is None:
        assert how.longest is not None
        count = fewest(
            division.longest_panel, division.longest, how.longest, f"the surface of {surface.numbers} of '{source}'"
        )
    return along_panels(surface.name, division.cut(count))
