"""Held vectors as a barrier sees them: their multipliers, and what they add to a step's normal equations.

A vector v that may be tau long is a number c = (|v|^2 / tau^2 - 1) / 2 that may reach 0, and its multiplier w is a
weight of |v|^2 / tau^2: at a minimum the cost pulls along the vector. So each adds u^T (w I) u with u = v / tau to the
Gauss-Newton matrix, as a weighted residual would, and (u . J)^T (u . J) / D for how w itself follows the step, with
D = s / w + p / (nu - w) for slacks s and excesses p on the central path (solver/central_path.py). Slacks and excesses
are eliminated: one matrix with the blocks of the problem is factorized a step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.blocks import Normal
from cadpanel.solver.central_path import central_weight, penalty
from cadpanel.solver.hold import HeldVectors
from cadpanel.solver.scatter import scatter_add

# Multipliers stay within this factor of those on the central path.
_BAND = 10.0
# A step takes a multiplier at most this share of the way to 0 or to its greatest value.
_LEAST_LEFT = 0.05
_NEARLY_NONE = 1e-300

Each = Array | float
"""A number for each group, (groups, 1), or one for all."""


@dataclass(frozen=True, slots=True)
class Work:
    """What a step's normal equations were made of, for a batch.

    Attributes:
        weight: (groups, vectors) multipliers that the step was found with.
        stiffness: (groups, vectors) D.
        shift: (groups, vectors) by how much multipliers change without a step.
        u: (groups, vectors, d) vectors by their distances.
        roots: (groups, vectors) roots across u, and what (.., along u) adds to them: residuals of a change e of u are
            roots e + along (u . e) u.
        along: see `roots`.
        rows: for each block (groups, vectors d, size) the residuals' derivatives.
    """

    weight: Array
    stiffness: Array
    shift: Array
    u: Array
    roots: Array
    along: Array
    rows: tuple[Array, ...]


class Barrier:
    """A batch of held vectors and their multipliers.

    Attributes:
        held: whose they are.
        tau: (groups, vectors) the distances that count now, never below those that are asked for, and never rising.
        weight: (groups, vectors) multipliers w of |v|^2 / tau^2.
        most: (groups, vectors) the greatest that a multiplier may be.
    """

    def __init__(self, held: HeldVectors, *, most: Each, ease: Each) -> None:
        """Hold a batch.

        Args:
            held: whose vectors they are.
            most: the greatest multiplier.
            ease: distances that may give way are so many times as wide.
        """
        self.held = held
        hold = held.hold
        self.goal = hold.radius * ease if hold.gives_way else hold.radius
        self.tau = self.goal if hold.scale is None else hold.scale
        self.most = np.broadcast_to(most, hold.radius.shape).astype(np.float64)
        self.weight = 0.5 * self.most

    def open(self, vectors: Array, widest: Each, lag: Each, mu: Each) -> None:
        """Begin with distances that hold vectors (groups, vectors, d) nearly, see `follow`, and central multipliers."""
        if not self.held.hold.one_sided:
            self.tau = np.maximum(self._goal(widest), lag * np.linalg.norm(vectors, axis=-1))
        self.weight = central_weight(self.numbers(vectors), mu, self.most)

    def follow(self, vectors: Array, widest: Each, lag: Each, where: BoolArray) -> None:
        """Narrow the distances; multipliers change such that the pull on the vectors stays as it is.

        Args:
            vectors: (groups, vectors, d).
            widest: to which distances that may give way are narrowed now, in the unit of the vectors.
            lag: no distance becomes less than this share of what its vector is now.
            where: (groups, 1) which groups; all others stay as they are.
        """
        if self.held.hold.one_sided:
            return
        goal = self._goal(widest)
        tau = np.minimum(np.maximum(self.tau, goal), np.maximum(goal, lag * np.linalg.norm(vectors, axis=-1)))
        tau = np.where(where, tau, self.tau)
        self.weight = self.weight * tau / self.tau
        self.tau = tau

    def resume(self, old: Barrier) -> None:
        """Go on with the pull and the greatest multipliers of a barrier of the same vectors."""
        self.most = old.most.copy()
        self.weight = old.weight if self.held.hold.one_sided else old.weight * self.tau / old.tau

    def mixed(self, other: Barrier, where: BoolArray) -> Barrier:
        """A barrier that is another one of the same vectors in some groups (groups, 1)."""
        mixed = Barrier(self.held, most=1.0, ease=1.0)
        for what in ("goal", "tau", "most", "weight"):
            setattr(mixed, what, np.where(where, getattr(other, what), getattr(self, what)))
        return mixed

    def _goal(self, widest: Each) -> Array:
        return np.maximum(self.goal, widest) if self.held.hold.gives_way else self.goal

    @property
    def lagging(self) -> Array:
        """(groups, vectors) how many times as wide as asked for the distances are."""
        return np.ones_like(self.tau) if self.held.hold.one_sided else np.asarray(self.tau / self.goal)

    def numbers(self, vectors: Array) -> Array:
        """(groups, vectors) the numbers c that may reach 0."""
        hold = self.held.hold
        if hold.one_sided:
            numbers: Array = (vectors[..., 0] - hold.radius) / self.tau
            return numbers
        u = vectors / self.tau[..., None]
        return np.asarray(0.5 * (np.einsum("gqd,gqd->gq", u, u) - 1.0))

    def violation(self, vectors: Array) -> Array:
        """(groups, vectors) |v| / goal."""
        return np.sqrt(self.held.hold.squares(vectors) / self.goal**2)

    def cost(self, vectors: Array, mu: Each) -> Array:
        """(groups,) penalties, and what the vectors cost anyhow."""
        own = self.held.hold.weight * self.held.hold.squares(vectors)
        total: Array = (penalty(self.numbers(vectors), mu, self.most) + 0.5 * own).sum(axis=1)
        return total

    def add_to(self, normal: Normal, vectors: Array, jacobians: tuple[Array, ...], mu: Each, damping: Array) -> Work:
        """Add the batch to the normal equations of a step.

        Args:
            normal: to be added to.
            vectors: (groups, vectors, d).
            jacobians: for each block (groups, vectors, d, size).
            mu: of the central path.
            damping: (blocks,).
        """
        held, hold, tau = self.held, self.held.hold, self.tau
        c = self.numbers(vectors)
        w, slack, over = self._multipliers(c, mu)
        stiffness = slack / w + over / (self.most - w)
        shift = (c + mu / w - mu / (self.most - w)) / stiffness
        pull = np.clip(w + shift, 0.0, self.most)
        groups = len(vectors)
        if hold.one_sided:
            own = hold.weight * tau**2 * (vectors[..., 0] > 0.0)
            u = np.ones((*c.shape, 1))
            roots, along = np.sqrt(1.0 / stiffness + own), np.zeros_like(c)
            force = (pull + own * vectors[..., 0] / tau)[..., None]
        else:
            own = hold.weight * tau**2
            u = vectors / tau[..., None]
            square = np.einsum("gqd,gqd->gq", u, u)
            across = w + own + (damping[held.blocks[0]] * hold.ties)[:, None] * tau**2
            roots = np.sqrt(across)
            along = (np.sqrt(across + square / stiffness) - roots) / np.maximum(square, _NEARLY_NONE)
            force = (pull + own)[..., None] * u
        rows = []
        for jacobian in jacobians:
            row = (roots / tau)[..., None, None] * jacobian
            if not hold.one_sided:
                radial = u[..., None, :] @ jacobian
                row += ((along / tau)[..., None] * u)[..., None] * radial
            rows.append(row.reshape(groups, -1, row.shape[-1]))
        force = (force / tau[..., None]).reshape(groups, 1, -1)
        for blocks, row, jacobian in zip(held.blocks, rows, jacobians, strict=True):
            flat = jacobian.reshape(groups, -1, jacobian.shape[-1])
            scatter_add(normal.gradient, blocks, (force @ flat)[:, 0])
            scatter_add(normal.diagonal, blocks, np.swapaxes(row, 1, 2) @ row)
        if held.pair is not None:
            scatter_add(normal.coupling, held.pair, np.swapaxes(rows[0], 1, 2) @ rows[1])
        return Work(w, stiffness, shift, u, roots, along, tuple(rows))

    def bend(self, gradient: Array, work: Work, off: Array) -> None:
        """Add the gradient (blocks, size) of vectors that turned out to be `off` (groups, vectors, d) at a trial.

        The second-order correction: the same matrix, with what the vectors are beyond their linear prediction.
        """
        e = off / self.tau[..., None]
        residual = work.roots[..., None] * e
        residual += (work.along * np.einsum("gqd,gqd->gq", work.u, e))[..., None] * work.u
        flat = residual.reshape(len(off), 1, -1)
        for blocks, row in zip(self.held.blocks, work.rows, strict=True):
            scatter_add(gradient, blocks, (flat @ row)[:, 0])

    def moved(self, jacobians: tuple[Array, ...], step: Array) -> Array:
        """(groups, vectors, d) how far the vectors move in a step (blocks, size), to first order."""
        total = np.zeros(jacobians[0].shape[:-1])
        for blocks, jacobian in zip(self.held.blocks, jacobians, strict=True):
            groups, q, d, size = jacobian.shape
            total += (jacobian.reshape(groups, q * d, size) @ step[blocks][..., None]).reshape(groups, q, d)
        return total

    def renew(self, work: Work, moved: Array, taken: BoolArray) -> None:
        """Multipliers after a step that moved the vectors by `moved`, in the groups (groups,) where it was taken."""
        if self.held.hold.one_sided:
            rate = moved[..., 0] / self.tau
        else:
            rate = np.einsum("gqd,gqd->gq", work.u, moved) / self.tau
        w = work.weight
        wanted = w + work.shift + rate / work.stiffness
        wanted = np.clip(wanted, _LEAST_LEFT * w, self.most - _LEAST_LEFT * (self.most - w))
        self.weight = np.where(taken[:, None], wanted, self.weight)

    def recentre(self, vectors: Array, mu: Each, failed: BoolArray) -> None:
        """Bring multipliers back onto the central path in groups of which a block (blocks,) failed.

        There the step is one along the slope of what is to fall: damped enough, it does.
        """
        groups = failed[self.held.blocks[0]]
        central = central_weight(self.numbers(vectors), mu, self.most)
        self.weight = np.where(groups[:, None], central, self.weight)

    def raise_most(self, vectors: Array, taken: BoolArray, factor: float) -> None:
        """Let multipliers rise further where a vector is too long and its multiplier nearly as great as it may be."""
        pressed = taken[:, None] & (self.weight > 0.5 * self.most) & (self.numbers(vectors) > -0.02)
        self.most = np.where(pressed, factor * self.most, self.most)

    def _multipliers(self, c: Array, mu: Each) -> tuple[Array, Array, Array]:
        """Multipliers in the band about the central path, with slacks and excesses: what c is off goes to one."""
        central = central_weight(c, mu, self.most)
        left = self.most - central
        w = np.clip(self.weight, central / _BAND, np.minimum(central * _BAND, self.most - left / _BAND))
        w = np.maximum(w, self.most - _BAND * left)
        slack, over = mu / w, mu / (self.most - w)
        off = c - over + slack
        return w, np.where(off < 0.0, slack - off, slack), np.where(off > 0.0, over + off, over)
