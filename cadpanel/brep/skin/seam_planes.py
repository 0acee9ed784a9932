"""The planes that divide a strip into a number of panels: square to it, level, or conjugate to it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.conjugate import seam_bending
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.skin.seam_turns import seam_turns
from cadpanel.brep.skin.strip import MIDDLE_POINTS, Strip
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import Seams

UP = np.array([0.0, 0.0, 1.0])
# A strip rises where its way does so by this everywhere, degrees: a level plane cuts a flatter one along its length.
LEAST_RISE = 20.0

PlanesOf = Callable[[int], Cuts]
"""The planes between a number of panels, in order along the strip."""


def square_planes(strip: Strip) -> PlanesOf:
    """Planes through both long edges at equal parts of their lengths, square to the strip's direction there."""
    return lambda count: strip.planes(_inner(count))


def level_planes(strip: Strip, what: str) -> PlanesOf:
    """Level planes at equal heights between the strip's ends, so that those of strips beside each other line up.

    Args:
        strip: one that rises.
        what: it, for messages.

    Raises:
        ReferenceFileError: it does not rise everywhere.
    """
    fine = np.linspace(0.0, 1.0, MIDDLE_POINTS)
    ways = strip.frames(fine)[:, 0] @ UP
    side = float(np.sign(ways.sum()))
    least = float(np.degrees(np.arcsin(np.clip((side * ways).min(), -1.0, 1.0))))
    if least < LEAST_RISE:
        raise ReferenceFileError(
            f"T{what[1:]} rises by {round(least)} degrees where it is flattest, and level seams want {LEAST_RISE:g} "
            "everywhere: divide it with square seams."
        )
    heights = strip.points(fine).mean(axis=0) @ UP

    def planes(count: int) -> Cuts:
        wanted = heights[0] + _inner(count) * (heights[-1] - heights[0])
        parts = np.interp(side * wanted, side * heights, fine)
        return strip.planes(parts, np.tile(side * UP, (len(parts), 1)))

    return planes


def conjugate_planes(strip: Strip, surface: Surface, most: float) -> PlanesOf:
    """Planes midway between the long edges at equal parts of their lengths, turned so that panels can meet in them.

    Args:
        strip: the surface's.
        surface: whose bending is measured.
        most: by how much a plane may be turned from square, radians.
    """
    turns = seam_turns(seam_bending(surface, strip), strip.length, surface.area / strip.length, most)

    def planes(count: int) -> Cuts:
        parts = _inner(count)
        return strip.planes(parts, turns.normals(parts, strip.frames(parts)))

    return planes


def seam_planes(kind: Seams, strip: Strip, surface: Surface, most: float, what: str) -> PlanesOf:
    """The planes of the kind that is asked for; see each of them."""
    if kind == "level":
        return level_planes(strip, what)
    return conjugate_planes(strip, surface, most) if kind == "conjugate" else square_planes(strip)


def _inner(count: int) -> Array:
    """Where `count` equal parts meet."""
    return np.linspace(0.0, 1.0, count + 1)[1:-1]
