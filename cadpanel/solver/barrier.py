"""Held vectors as a barrier sees them: their multipliers, and what they add to a step's normal equations.

A vector v that may be tau long is a number c = (|v|^2 / tau^2 - 1) / 2 that may reach 0, and its multiplier w is a
weight of |v|^2 / tau^2: at a minimum the cost pulls along the vector. So each adds u^T (w I) u with u = v / tau to the
Gauss-Newton matrix, as a weighted residual would, and (u . J)^T (u . J) / D for how w itself follows the step, with
D = s / w + p / (nu - w) for slacks s and excesses p on the central path (solver/central_path.py). Slacks and excesses
are eliminated: one matrix with the blocks of the problem is factorized a step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.solver.blocks import Normal
from cadpanel.solver.central_path import central_weight, penalty
from cadpanel.solver.held_rows import HeldRows, Rowed

# Multipliers stay within this factor of those on the central path.
_BAND = 10.0
# A step takes a multiplier at most this share of the way to 0 or to its greatest value.
_LEAST_LEFT = 0.05
_NEARLY_NONE = 1e-300

Each = Array | float
"""A number for each vector, (vectors,), or one for all."""
Jacobians = Sequence[tuple[Array, ...]]
"""For each batch, for each of its blocks (groups, vectors, d, size)."""


@dataclass(frozen=True, slots=True)
class Work:
    """What a step's normal equations were made of.

    Attributes:
        weight: (vectors,) multipliers that the step was found with.
        stiffness: (vectors,) D.
        shift: (vectors,) by how much multipliers change without a step.
        u: (rows,) vectors by their distances.
        roots: (vectors,) roots across u, and what (.., along u) adds to them: residuals of a change e of u are
            roots e + along (u . e) u.
        along: see `roots`.
        residuals: for each bundle, for each of its blocks (groups, components, size) the residuals' derivatives.
    """

    weight: Array
    stiffness: Array
    shift: Array
    u: Array
    roots: Array
    along: Array
    residuals: tuple[tuple[Array, ...], ...]


class Barriers:
    """All held vectors and their multipliers.

    Attributes:
        held: whose they are.
        goal: (vectors,) the distances that are asked for.
        tau: (vectors,) the distances that count now, never below those that are asked for, and never rising.
        weight: (vectors,) multipliers w of |v|^2 / tau^2.
        most: (vectors,) the greatest that a multiplier may be.
    """

    def __init__(self, held: HeldRows, *, most: Each, ease: Each) -> None:
        """Hold vectors.

        Args:
            held: which.
            most: the greatest multiplier.
            ease: distances that may give way are so many times as wide.
        """
        self.held = held
        holds = [one.hold for one in held.held]
        self._radius = held.told([hold.radius for hold in holds])
        self._own = held.weights()
        self._ties = held.told([np.full(hold.radius.shape, hold.ties) for hold in holds])
        self.goal = np.where(held.gives_way, self._radius * ease, self._radius)
        scales = [np.full(hold.radius.shape, np.nan) if hold.scale is None else hold.scale for hold in holds]
        scale = held.told(scales)
        self.tau = np.where(np.isnan(scale), self.goal, scale)
        self.most = np.broadcast_to(most, self.goal.shape).astype(np.float64)
        self.weight = 0.5 * self.most

    def open(self, at: Rowed, widest: Each, lag: Each, mu: Each) -> None:
        """Begin with distances that hold the vectors nearly, see `follow`, and central multipliers."""
        near = np.maximum(self._goal(widest), lag * np.sqrt(at.squares))
        self.tau = np.where(self.held.one_sided, self.tau, near)
        self.weight = central_weight(self.numbers(at), mu, self.most)

    def follow(self, at: Rowed, widest: Each, lag: Each, where: BoolArray) -> None:
        """Narrow the distances; multipliers change such that the pull on the vectors stays as it is.

        Args:
            at: the vectors.
            widest: to which distances that may give way are narrowed now, in the unit of the vectors.
            lag: no distance becomes less than this share of what its vector is now.
            where: (vectors,) which ones; all others stay as they are, and so do numbers.
        """
        goal = self._goal(widest)
        tau = np.minimum(np.maximum(self.tau, goal), np.maximum(goal, lag * np.sqrt(at.squares)))
        tau = np.where(where & ~self.held.one_sided, tau, self.tau)
        self.weight = self.weight * tau / self.tau
        self.tau = tau

    def resume(self, old: Barriers) -> None:
        """Go on with the pull and the greatest multipliers of barriers of the same vectors."""
        self.most = old.most.copy()
        self.weight = np.where(self.held.one_sided, old.weight, old.weight * self.tau / old.tau)

    def mixed(self, other: Barriers, where: BoolArray) -> Barriers:
        """Barriers that are others of the same vectors for some of these (vectors,)."""
        mixed = Barriers(self.held, most=1.0, ease=1.0)
        for what in ("goal", "tau", "most", "weight"):
            setattr(mixed, what, np.where(where, getattr(other, what), getattr(self, what)))
        return mixed

    def _goal(self, widest: Each) -> Array:
        return np.where(self.held.gives_way, np.maximum(self.goal, widest), self.goal)

    @property
    def lagging(self) -> Array:
        """(vectors,) how many times as wide as asked for the distances are."""
        return np.where(self.held.one_sided, 1.0, self.tau / self.goal)

    @property
    def multipliers(self) -> tuple[Array, ...]:
        """For each batch (groups, vectors) the weight of |v|^2 / 2 in the cost that holds the vector."""
        return self.held.by_batch(self.weight / self.tau**2)

    def numbers(self, at: Rowed) -> Array:
        """(vectors,) the numbers c that may reach 0."""
        below = (at.values - self._radius) / self.tau
        return np.where(self.held.one_sided, below, 0.5 * (at.squares / self.tau**2 - 1.0))

    def violation(self, at: Rowed) -> Array:
        """(vectors,) |v| / goal."""
        return np.asarray(np.sqrt(at.squares) / self.goal)

    def cost(self, at: Rowed, mu: Each) -> Array:
        """(vectors,) penalties, and what the vectors cost anyhow."""
        return np.asarray(penalty(self.numbers(at), mu, self.most) + 0.5 * self._own * at.squares)

    def add_to(self, normal: Normal, at: Rowed, jacobians: Jacobians, mu: Each, damping: Array) -> Work:
        """Add everything held to the normal equations of a step.

        Args:
            normal: to be added to.
            at: the vectors.
            jacobians: how they follow the unknowns.
            mu: of the central path.
            damping: (blocks,).
        """
        held, tau = self.held, self.tau
        c = self.numbers(at)
        w, slack, over = self._multipliers(c, mu)
        left = self.most - w
        stiffness = slack / w + over / left
        shift = (c + mu / w - mu / left) / stiffness
        pull = np.clip(w + shift, 0.0, self.most)
        own = self._own * tau**2
        own[held.one_sided & (at.values <= 0.0)] = 0.0
        square = np.where(held.one_sided, 0.0, at.squares / tau**2)
        across = np.where(held.one_sided, 1.0 / stiffness + own, w + own + damping[held.first] * self._ties * tau**2)
        roots, longest = np.sqrt(across), np.sqrt(across + square / stiffness)
        along = (longest - roots) / np.maximum(square, _NEARLY_NONE)
        u = np.where(held.one_sided[held.of], 1.0, at.rows / tau[held.of])
        # Along u residuals count by their longest root: this one's product with the rows is the gradient.
        force = np.where(held.one_sided, pull + own * at.values / tau, pull + own) / longest
        residuals = self._rows(jacobians, u, roots / tau, along / tau)
        self._add(normal, residuals, force[held.of] * u)
        return Work(w, stiffness, shift, u, roots, along, residuals)

    def _rows(self, jacobians: Jacobians, u: Array, across: Array, along: Array) -> tuple[tuple[Array, ...], ...]:
        """For each bundle, for each of its blocks (groups, components, size) the residuals' derivatives."""
        held, found = self.held, []
        for bundle in held.bundles:
            size = jacobians[bundle.batches[0]][0].shape[-1]
            whole = tuple(np.empty((*bundle.rows.shape, size)) for _ in bundle.blocks)
            for i, columns in zip(bundle.batches, bundle.columns, strict=True):
                groups, q, d = held.shapes[i]
                vectors = held.vectors[i]
                by_vector = across[vectors].reshape(groups, q, 1, 1)
                straight = not held.held[i].hold.one_sided
                if straight:
                    radial = u[held.rows[i]].reshape(groups, q, 1, d)
                    out = np.swapaxes(along[vectors].reshape(groups, q, 1, 1) * radial, 2, 3)
                for into, jacobian in zip(whole, jacobians[i], strict=True):
                    row = by_vector * jacobian
                    if straight:
                        row += out * (radial @ jacobian)
                    into[:, columns] = row.reshape(len(into), -1, size)
            found.append(whole)
        return tuple(found)

    def _add(self, normal: Normal, residuals: tuple[tuple[Array, ...], ...], off: Array) -> None:
        """Add J^T r and J^T J of residuals that are `off` (rows,)."""
        for bundle, rows in zip(self.held.bundles, residuals, strict=True):
            turned = [np.swapaxes(row, 1, 2) for row in rows]
            here = off[bundle.rows][..., None]
            for scatter, row, back in zip(bundle.blocks, rows, turned, strict=True):
                scatter.add(normal.gradient, (back @ here)[..., 0])
                scatter.add(normal.diagonal, back @ row)
            if bundle.pair is not None:
                bundle.pair.add(normal.coupling, turned[0] @ rows[1])

    def bend(self, gradient: Array, work: Work, off: Array) -> None:
        """Add the gradient (blocks, size) of vectors that turned out to be `off` (rows,) at a trial.

        The second-order correction: the same matrix, with what the vectors are beyond their linear prediction.
        """
        held = self.held
        e = off / self.tau[held.of]
        residual = work.roots[held.of] * e + (work.along * held.total(work.u * e))[held.of] * work.u
        for bundle, rows in zip(held.bundles, work.residuals, strict=True):
            here = residual[bundle.rows][:, None]
            for scatter, row in zip(bundle.blocks, rows, strict=True):
                scatter.add(gradient, (here @ row)[:, 0])

    def moved(self, jacobians: Jacobians, step: Array) -> Array:
        """(rows,) how far the vectors move in a step (blocks, size), to first order."""
        parts = []
        for one, shape, own in zip(self.held.held, self.held.shapes, jacobians, strict=True):
            total = np.zeros(shape[0] * shape[1] * shape[2])
            for blocks, jacobian in zip(one.blocks, own, strict=True):
                flat = jacobian.reshape(shape[0], shape[1] * shape[2], step.shape[1])
                total += (flat @ step[blocks][..., None]).reshape(-1)
            parts.append(total)
        return self.held.told(parts)

    def renew(self, work: Work, moved: Array, taken: BoolArray) -> None:
        """Multipliers after a step that moved the vectors by `moved` (rows,), where (vectors,) it was taken."""
        w = work.weight
        wanted = w + work.shift + self.held.total(work.u * moved) / self.tau / work.stiffness
        wanted = np.clip(wanted, _LEAST_LEFT * w, self.most - _LEAST_LEFT * (self.most - w))
        self.weight = np.where(taken, wanted, self.weight)

    def recentre(self, at: Rowed, mu: Each, failed: BoolArray) -> None:
        """Bring multipliers back onto the central path of vectors whose first block (blocks,) failed.

        There the step is one along the slope of what is to fall: damped enough, it does.
        """
        central = central_weight(self.numbers(at), mu, self.most)
        self.weight = np.where(failed[self.held.first], central, self.weight)

    def raise_most(self, at: Rowed, taken: BoolArray, factor: float) -> None:
        """Let multipliers rise further where a vector is too long and its multiplier nearly as great as it may be."""
        pressed = taken & (self.weight > 0.5 * self.most) & (self.numbers(at) > -0.02)
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
