"""A strip cut along its length into equal panels: so many, or as few as are no longer than allowed."""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.brep.cutting.cut_panel import CutPanel, along_panels
from cadpanel.brep.cutting.divisions import division_of
from cadpanel.brep.cutting.fewest import fewest
from cadpanel.brep.cutting.lip_band import lip_band
from cadpanel.brep.skin.adjacency import Surface
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
    band, notes = lip_band(surface, width, source, tolerance)
    return cut_lengths(band, how, source, tolerance), notes


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
