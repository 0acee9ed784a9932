"""Chains of segments and conic arcs in one formula, with exact derivatives, for many chains at once.

Every piece is C(w) = E(phi) / D(phi) + w * span for w from 0 to 1, with phi = start + w * turn and E, D linear in 1,
cos(phi) and sin(phi). An arc of any conic has no span; a segment has no turn, and E / D is its start. Vectors run along
the first axis here: ten times as many short sums are taken as anywhere else, and they are quickest that way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray

# Rows of a table of coefficients: E's three vectors, D's three numbers, span, start, turn.
_CONSTANT, _COSINE, _SINE, _WEIGHTS, _SPAN = (slice(row, row + 3) for row in (0, 3, 6, 9, 12))
_START, _TURN = 15, 16


@dataclass(frozen=True, slots=True, kw_only=True)
class ConicChains:
    """c chains of k pieces each; piece i of chain j stands in column j * k + i.

    Attributes:
        pieces: k.
        curves: (17, c * k) coefficients of the curve.
        normals: (9, c * k) the surface's unit normal by phi: its constant, cosine and sine vectors.
    """

    pieces: int
    curves: Array
    normals: Array

    @property
    def count(self) -> int:
        """How many chains."""
        return int(self.curves.shape[1]) // self.pieces

    def part(self, chains: slice) -> ConicChains:
        """Some of the chains."""
        first, last, _ = chains.indices(self.count)
        columns = slice(first * self.pieces, last * self.pieces)
        return ConicChains(pieces=self.pieces, curves=self.curves[:, columns], normals=self.normals[:, columns])

    def normals_at(self, columns: IntArray, w: Array) -> tuple[Array, Array]:
        """Unit normals (3, n) at w (n,) of the pieces in the columns (n,), and their derivatives by w."""
        turn = self.curves[_TURN, columns]
        phi = self.curves[_START, columns] + w * turn
        cosine, sine = np.cos(phi), np.sin(phi)
        normals = np.take(self.normals, columns, axis=1)
        across = normals[_COSINE], normals[_SINE]
        return normals[_CONSTANT] + across[0] * cosine + across[1] * sine, turn * (
            across[1] * cosine - across[0] * sine
        )


def conic_chains(
    *,
    constant: Array,
    cosine: Array,
    sine: Array,
    weights: Array,
    span: Array,
    start: Array,
    turn: Array,
    normals: Sequence[Array],
) -> ConicChains:
    """Chains from vectors (c, k, 3), of which `normals` holds three, and numbers (c, k); weights (c, k, 3)."""

    def rows(vectors: Array) -> Array:
        return np.moveaxis(vectors, 2, 0).reshape(3, -1)

    numbers = np.stack([start.ravel(), turn.ravel()])
    return ConicChains(
        pieces=int(turn.shape[1]),
        curves=np.concatenate([*(rows(of) for of in (constant, cosine, sine, weights, span)), numbers]),
        normals=np.concatenate([rows(of) for of in normals]),
    )


def joined(one: ConicChains, other: ConicChains) -> ConicChains:
    """The chains of both, one after the other; where one has fewer pieces, its last piece stands there again."""
    pieces = max(one.pieces, other.pieces)
    filled = [_filled(chains, pieces) for chains in (one, other)]
    return ConicChains(
        pieces=pieces,
        curves=np.concatenate([chains.curves for chains in filled], axis=1),
        normals=np.concatenate([chains.normals for chains in filled], axis=1),
    )


def _filled(chains: ConicChains, pieces: int) -> ConicChains:
    if chains.pieces == pieces:
        return chains
    own = np.minimum(np.arange(pieces), chains.pieces - 1)
    columns = (np.arange(chains.count)[:, None] * chains.pieces + own).ravel()
    return ConicChains(pieces=pieces, curves=chains.curves[:, columns], normals=chains.normals[:, columns])


def seen_from(curves: Array, points: Array) -> Array:
    """Coefficients (17, n) of pieces moved so that the points (3, n) lie in the origin."""
    moved = curves.copy()
    for i, vectors in enumerate((_CONSTANT, _COSINE, _SINE)):
        moved[vectors] -= points * curves[_WEIGHTS][i]
    return moved


def followed(curves: Array, w: Array) -> Array:
    """Points (3, n) at w (n,) of pieces with the coefficients (17, n)."""
    phi = curves[_START] + w * curves[_TURN]
    cosine, sine = np.cos(phi), np.sin(phi)
    weights = curves[_WEIGHTS]
    above = curves[_CONSTANT] + curves[_COSINE] * cosine + curves[_SINE] * sine
    points: Array = above / (weights[0] + weights[1] * cosine + weights[2] * sine) + w * curves[_SPAN]
    return points


def followed_twice(curves: Array, w: Array) -> tuple[Array, Array, Array]:
    """Points (3, n) at w (n,) of pieces with the coefficients (17, n), and their first and second derivatives by w."""
    turn = curves[_TURN]
    phi = curves[_START] + w * turn
    cosine, sine = np.cos(phi), np.sin(phi)
    constant, weights, span = curves[_CONSTANT], curves[_WEIGHTS], curves[_SPAN]
    swing = curves[_COSINE] * cosine + curves[_SINE] * sine
    below_swing = weights[1] * cosine + weights[2] * sine
    inverse = 1.0 / (weights[0] + below_swing)
    below_rate = weights[2] * cosine - weights[1] * sine
    quotient = (constant + swing) * inverse
    # (E / D)' = (E' - E / D * D') / D, and the second derivatives of E and D are their swings turned round.
    rate = (curves[_SINE] * cosine - curves[_COSINE] * sine - quotient * below_rate) * inverse
    bend = (quotient * below_swing - swing - 2.0 * below_rate * rate) * inverse
    return quotient + w * span, turn * rate + span, turn**2 * bend


def inner(first: Array, second: Array) -> Array:
    """Inner products (...) of vectors (3, ...)."""
    products: Array = first[0] * second[0] + first[1] * second[1] + first[2] * second[2]
    return products
