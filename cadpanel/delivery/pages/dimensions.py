"""Dimensions on a page: lines with arrows beside what they measure, and the number on them."""

from __future__ import annotations

import math

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.pages.paper import Paper, width_of

HEIGHT = 2.2
"""Of the numbers, mm."""
_ARROW = 1.8
_GAP = 1.0
_GREY = 0.35


def dimension(paper: Paper, start: Array, stop: Array, away: Array, distance: float, number: str) -> None:
    """The length between two places (2,), on a line that lies `distance` mm from them in the unit direction `away`."""
    first, last = start + distance * away, stop + distance * away
    for end, foot in ((start, first), (stop, last)):
        paper.lines(np.array([end + _GAP * away, foot + _GAP * away]), width=0.1, grey=_GREY)
    paper.lines(np.array([first, last]), width=0.1, grey=_GREY)
    along = (last - first) / max(float(np.linalg.norm(last - first)), 1e-9)
    room = float(np.linalg.norm(last - first)) >= 3.0 * _ARROW
    for tip, way in ((first, along), (last, -along)):
        # Where there is no room between them, arrows point from outside.
        _arrow(paper, tip, way if room else -way)
    words_along(paper, 0.5 * (first + last), along, away, number)


def words_along(paper: Paper, place: Array, along: Array, away: Array, words: str, *, halo: bool = False) -> None:
    """Words beside a place, running along a unit direction (2,), to be read from below or from the right."""
    angle = math.atan2(along[1], along[0])
    # A turn of just under half a circle is told from one of just over it with a margin.
    if not -0.5 * math.pi + 1e-6 < angle <= 0.5 * math.pi + 1e-6:
        angle -= math.copysign(math.pi, angle)
    up = np.array([-math.sin(angle), math.cos(angle)])
    foot = place + 0.5 * away if float(up @ away) > 0.0 else place + (HEIGHT + 0.5) * away
    paper.words(words, foot, HEIGHT, anchor="middle", angle=angle, halo=halo)


def room_for(words: str) -> float:
    """How long a line must be to carry words, mm on paper."""
    return width_of(words, HEIGHT) + 2.0 * _ARROW


def _arrow(paper: Paper, tip: Array, way: Array) -> None:
    """An arrow's head at its tip, which comes out of the unit direction `way`."""
    side = np.array([-way[1], way[0]])
    paper.area(
        np.array([tip, tip + _ARROW * way + 0.25 * _ARROW * side, tip + _ARROW * way - 0.25 * _ARROW * side]),
        (_GREY, _GREY, _GREY),
    )
