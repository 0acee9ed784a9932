"""Lips: where a strip's normals turn fast on the way across it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.skin.cross_sections import CrossSection, Sections

# Parts of the strip's length at which it is looked at across to find its lips.
SECTIONS = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
# A lip turns faster than the whole section does in the mean by this factor, and by so much in all, degrees.
FAST = 2.0
LEAST_TURN = 10.0
# A lip is followed from section to section within its width, or this part of the section's where it is a mere crease,
# on so fine a ruler, and sought again about what was found.
LEAST_REACH = 0.02
FINE = 2049
CORRECTIONS = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class Lip:
    """One lip.

    Attributes:
        turn: by how much the normals turn over it, degrees.
        width: along the surface, mm.
        middle: length from the strip's first long edge to where half of the turn is done, mm.
    """

    turn: float
    width: float
    middle: float

    @property
    def radius(self) -> float:
        """Mean radius, mm."""
        return self.width / float(np.radians(self.turn))


def lips_of(length: Array, turn: Array) -> tuple[Lip, ...]:
    """The lips of a section: stretches that turn fast.

    Args:
        length: (n,) lengths across the strip, not falling, mm.
        turn: (n,) by how much the normals have turned up to there, radians.
    """
    whole = float(turn[-1] - turn[0])
    if np.degrees(whole) < LEAST_TURN or length[-1] <= length[0]:
        return ()
    mean = whole / float(length[-1] - length[0])
    fast = np.diff(turn) > FAST * mean * np.diff(length)
    borders = np.flatnonzero(np.diff(np.concatenate([[False], fast, [False]]).astype(np.int8)))
    lips = []
    for start, stop in borders.reshape(-1, 2).tolist():
        turned = float(turn[stop] - turn[start])
        if np.degrees(turned) >= LEAST_TURN:
            half = float(np.interp(turn[start] + 0.5 * turned, turn[start : stop + 1], length[start : stop + 1]))
            lips.append(Lip(turn=float(np.degrees(turned)), width=float(length[stop] - length[start]), middle=half))
    return tuple(lips)


def lips_midway(sections: Sections) -> tuple[Lip, ...]:
    """The lips of the middle section, or of all in the mean where that has none."""
    section = sections.sections[len(sections.sections) // 2]
    return lips_of(section.length, section.turn) or lips_of(*sections.mean)


def follow_lip(sections: Sections, lip: Lip) -> Array:
    """(n,) the middle of a lip of the middle section, section by section, mm from the first long edge.

    It is followed from there both ways: in each section the middle is where half of what turns about the lip's last
    place has turned.
    """
    start = len(sections.sections) // 2
    section = sections.sections[start]
    reach = max(lip.width, LEAST_REACH * float(section.length[-1])) / section.length[-1]
    shares = np.full(len(sections.sections), lip.middle / section.length[-1])
    for indices in (range(start, len(shares)), range(start, -1, -1)):
        share = float(shares[start])
        for index in indices:
            for _ in range(CORRECTIONS):
                share = _half_turned(sections.sections[index], share - reach, share + reach)
            shares[index] = share
    widths = np.array([section.length[-1] for section in sections.sections])
    middles: Array = shares * widths
    return middles


def _half_turned(section: CrossSection, low: float, high: float) -> float:
    """Where between two parts of a section's width half of what turns there has turned, as a part again."""
    width = float(section.length[-1])
    # The section on a fine ruler: where two faces meet in a crease, its turn jumps.
    places = np.linspace(max(low, 0.0), min(high, 1.0), FINE) * width
    turn = np.interp(places, section.length, section.turn)
    if turn[-1] <= turn[0]:
        return 0.5 * (low + high)
    return float(np.interp(0.5 * (turn[0] + turn[-1]), turn, places)) / width
