"""How far each plane across a strip is turned from square so that panels on both sides of it can meet.

A plane with the normal n = t + a c + b m in the strip's frame (t along, c along the chord, m square to both) has two
numbers: a, the tangent of its turn about the strip's normal, and b, that of its tilt about the chord. What is left
open in it goes with n . e, e as `conjugate` has it, which is linear in both: the two flanges of a fold may want
different leans, and both get theirs. The numbers sought are linear between stations along the strip and make

    mean (n . e)^2 + mean e^2 (SQUARE (a^2 + b^2) + EVEN w^2 (a'^2 + b'^2))

small, w the strip's width, while no plane is turned by more than is allowed, nor so fast along the strip that a panel
would lose more than a part of its length at a long edge. The alternating direction method (Boyd et al. 2011) holds
those two; it takes a fixed number of sweeps, so that nothing hangs on when it stops.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.skin.conjugate import STRAIGHT, SeamBending
from cadpanel.geometry.vectors import norm

STATIONS = 65
SQUARE, EVEN = 0.02, 0.25
# By which part of its length a panel may be shorter at a long edge.
SHORTER = 0.25
SWEEPS = 400


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamTurns:
    """How planes are turned along a strip.

    Attributes:
        turns: (STATIONS, 2) a and b at equal parts of the length.
    """

    turns: Array

    def normals(self, parts: Array, frames: Array) -> Array:
        """(k, 3) unit normals of the planes at (k,) parts of the length with their (k, 3, 3) frames there."""
        stations = np.linspace(0.0, 1.0, len(self.turns))
        a, b = (np.interp(parts, stations, turn)[:, None] for turn in self.turns.T)
        normals = frames[:, 0] + a * frames[:, 1] + b * frames[:, 2]
        unit_normals: Array = normals / norm(normals)[:, None]
        return unit_normals


def seam_turns(bending: SeamBending, length: float, width: float, most: float) -> SeamTurns:
    """The turns along a strip.

    Args:
        bending: of the strip.
        length: of the strip, mm.
        width: of it, mm.
        most: by how much a plane may be turned from square, radians.
    """
    normal, pull = _quadratic(bending, width / length)
    stations = np.linspace(0.0, 1.0, STATIONS)
    ends = np.minimum(stations, 1.0 - stations) * length
    radii = np.minimum(np.tan(most), 2.0 * SHORTER * ends / width)
    step = length / (STATIONS - 1)
    slopes = np.full(STATIONS - 1, 2.0 * SHORTER * step / width)
    return SeamTurns(turns=_within(normal, pull, radii, slopes))


def _hats(places: Array) -> tuple[IntArray, Array]:
    """(m,) the station before each place, and (m,) the share of the next one."""
    at = np.clip(places, 0.0, 1.0) * (STATIONS - 1)
    before = np.minimum(at.astype(np.intp), STATIONS - 2)
    return before, at - before


def _quadratic(bending: SeamBending, width: float) -> tuple[Array, Array]:
    """The matrix and the right side of the sum of squares, of STATIONS times a and b; the width in lengths."""
    e, weights = bending.conjugate, bending.weights
    before, share = _hats(bending.places)
    normal, pull = np.zeros((STATIONS, 2, STATIONS, 2)), np.zeros((STATIONS, 2))
    outer = weights[:, None, None] * e[:, 1:, None] * e[:, None, 1:]
    right = -weights[:, None] * e[:, :1] * e[:, 1:]
    parts = ((0, 1.0 - share), (1, share))
    for one, mine in parts:
        np.add.at(pull, before + one, mine[:, None] * right)
        for other, its in parts:
            # The index arrays stand apart, so that their axis comes first.
            np.add.at(normal.transpose(0, 2, 1, 3), (before + one, before + other), (mine * its)[:, None, None] * outer)
    mean = float(weights @ np.einsum("mk,mk->m", e, e))
    toward_square = SQUARE * mean + STRAIGHT**2
    step = 1.0 / (STATIONS - 1)
    even = EVEN * mean * width**2 / step
    i = np.arange(STATIONS)
    for k in (0, 1):
        normal[i, k, i, k] += toward_square * step
        for a, b, sign in ((i[:-1], i[:-1], 1.0), (i[1:], i[1:], 1.0), (i[:-1], i[1:], -1.0), (i[1:], i[:-1], -1.0)):
            normal[a, k, b, k] += sign * even
    return normal.reshape(2 * STATIONS, 2 * STATIONS), pull.reshape(-1)


def _within(normal: Array, pull: Array, radii: Array, slopes: Array) -> Array:
    """(STATIONS, 2) turns of the least squares; none exceeds its radius, and no two differ by more than a slope."""
    count = len(radii)
    differences = np.diff(np.eye(count), axis=0)
    both = np.kron(np.vstack([np.eye(count), differences]), np.eye(2))
    limits = np.concatenate([radii, slopes])
    weight = float(np.trace(normal)) / len(normal)
    factor = cho_factor(normal + weight * both.T @ both)
    held, dual = np.zeros((len(limits), 2)), np.zeros((len(limits), 2))
    turns = np.zeros(len(normal))
    for _ in range(SWEEPS):
        turns = cho_solve(factor, pull + weight * both.T @ (held - dual).reshape(-1))
        reached = (both @ turns).reshape(-1, 2)
        held = _shortened(reached + dual, limits)
        dual = dual + reached - held
    return _shortened(turns.reshape(-1, 2), radii)


def _shortened(vectors: Array, limits: Array) -> Array:
    """(k, 2) vectors no longer than their (k,) limits."""
    sizes = np.sqrt(np.einsum("kd,kd->k", vectors, vectors))
    shortened: Array = vectors * np.minimum(1.0, limits / np.maximum(sizes, np.finfo(float).tiny))[:, None]
    return shortened
