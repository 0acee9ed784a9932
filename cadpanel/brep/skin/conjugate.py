"""How a strip bends along its seams, and which directions across it are conjugate to its own.

Panels that follow each other along a strip touch it along their middles. Two of them, with the unit normals N(s) and
N(s + h), cross in a line whose direction tends to e = N x dN/ds as they get shorter: it is conjugate to the strip's
direction t, II(t, e) = 0 (Liu et al. 2006; Pottmann et al. 2008). A seam of the direction d leaves a step between them
that grows with h II(t, d), and in a plane with the normal n it runs along n x N, where II(t, n x N) = n . e.

A part that is rolled has its rulings where its normal turns least, and is cut square to them, however the surface was
drawn: there t is first turned to t + beta s, s = N x t, on which N turns least. A flange of a fold is flat, and is left
as it is: what counts as rolled bends across the strip about as much as all of it does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.curvature import bending_of, joined
from cadpanel.brep.skin.strip import MIDDLE_POINTS, Strip
from cadpanel.geometry.vectors import cross, dot, norm, unit

# Points each way at which a face's bending is looked at.
GRID = 49
# A face is rolled where it bends across by more than this part of the mean over the section, and by more than this in
# all, radians; both tell smoothly.
ROLLED = 0.25
LEAST_TURN = np.radians(10.0)

# Curvature that leaves no step worth mention, 1/mm: 0.3 mm between panels of 2 m by 0.7 m.
STRAIGHT = 2e-7
# Places along a strip at which leans are told, and how close two of them count as alike, degrees.
LEAN_PLACES = 17
ALIKE = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamBending:
    """What seams across a strip meet, at m points all over it.

    Attributes:
        places: (m,) where along the strip, as parts of its length.
        sides: (m,) how far from the middle of the chord between the long edges, along it, mm.
        conjugate: (m, 3) e = N x dN/ds in the strip's own frame: along it, along the chord, and square to both, 1/mm.
        leans: (m,) angle between e and what is square to the strip on the surface, from 0 to pi / 2.
        weights: (m,) parts of the area; they add up to 1.
    """

    places: Array
    sides: Array
    conjugate: Array
    leans: Array
    weights: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamLean:
    """How far seams square to a strip are from where flat panels could meet without a step.

    Attributes:
        mean: all over the strip, degrees.
        largest: on the side of the strip and at the place where it is most, degrees.
        at: that place, from the strip's beginning, mm.
    """

    mean: float
    largest: float
    at: float


def seam_lean(bending: SeamBending, length: float) -> SeamLean:
    """The leans of a strip of a length, mm.

    Every point counts as much as it bends, and one that does not bend leans by 0: there any seam will do.
    """
    bent = norm(bending.conjugate)
    weights = bending.weights * (bent + STRAIGHT)
    leans = np.degrees(bending.leans) * bent**2 / (bent**2 + STRAIGHT**2)
    at, width = np.linspace(0.0, 1.0, LEAN_PLACES), 1.0 / (LEAN_PLACES - 1)
    near = weights * np.maximum(1.0 - np.abs(bending.places - at[:, None]) / width, 0.0)
    sums = [
        (near[:, side] @ leans[side], near[:, side].sum(axis=1)) for side in (bending.sides < 0.0, bending.sides >= 0.0)
    ]
    means = np.array([np.divide(of, by, out=np.zeros(LEAN_PLACES), where=by > 0.0) for of, by in sums])
    most = means.max(axis=0)
    # The first of those places that are equally bad: which of them rounding favours must not show.
    first = int(np.argmax(most >= most.max() - ALIKE))
    return SeamLean(
        mean=float(weights @ leans / weights.sum()), largest=float(most.max()), at=float(at[first]) * length
    )


def seam_bending(surface: Surface, strip: Strip) -> SeamBending:
    """Measure how a strip bends along its seams."""
    faces = [(face.area, bending_of(face.patch, GRID)) for face in surface.faces]
    bent = joined([one for _, one in faces])
    weights = np.concatenate([area * one.areas / one.areas.sum() for area, one in faces])
    weights /= weights.sum()
    places, frames, chord = _placed(bent.points, strip)
    ways = unit(frames[:, 0] - dot(frames[:, 0], bent.normals)[:, None] * bent.normals)
    aside = cross(bent.normals, ways)
    on, over = bent.turn(ways), bent.turn(aside)
    mean = float(weights @ norm(over))
    least = (ROLLED * mean) ** 2 + (LEAST_TURN * strip.length / surface.area) ** 2
    beta = -dot(on, over) / (dot(over, over) + least)
    turned, rolled = on + beta[:, None] * over, ways + beta[:, None] * aside
    conjugate = cross(bent.normals, turned)
    square = cross(bent.normals, unit(rolled))
    return SeamBending(
        places=places,
        sides=dot(bent.points - chord, frames[:, 1]),
        conjugate=np.einsum("mkd,md->mk", frames, conjugate),
        leans=np.arccos(np.clip(np.abs(dot(unit(conjugate), square)), 0.0, 1.0)),
        weights=weights,
    )


def _placed(points: Array, strip: Strip) -> tuple[Array, Array, Array]:
    """For (m, 3) points: parts of the strip's length (m,), its frames (m, 3, 3) and the middles (m, 3) there."""
    fine = np.linspace(0.0, 1.0, MIDDLE_POINTS)
    middles, frames = strip.points(fine).mean(axis=0), strip.frames(fine)
    near = cKDTree(middles).query(points)[1]
    # Between two places of the middle line by how far ahead of the nearer one a point lies.
    ahead = dot(points - middles[near], frames[near, 0])
    places = np.clip(fine[near] + ahead / strip.length, 0.0, 1.0)
    mixed = [
        np.stack([np.interp(places, fine, line) for line in of.reshape(len(fine), -1).T], axis=-1)
        for of in (frames, middles)
    ]
    return places, unit(mixed[0].reshape(-1, 3, 3)), mixed[1]
