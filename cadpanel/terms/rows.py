"""Residual rows of a term and how they enter the normal equations; written once for all terms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.solver.scatter import Scatter

if TYPE_CHECKING:
    from cadpanel.solver.blocks import Normal


@dataclass(frozen=True, slots=True)
class Rows:
    """Residuals in groups; a group sees one panel, or the two panels of a seam.

    Attributes:
        residual: (groups, q).
        panels: one or two index arrays (groups,).
        jacobians: as many (groups, q, unknowns), by the unknowns of those panels.
        pair: (groups,) index among the coupled pairs of blocks (two panels only).
    """

    residual: Array
    panels: tuple[IntArray, ...]
    jacobians: tuple[Array, ...]
    pair: IntArray | None = None

    def booked(self, panels: int) -> Array:
        """(panels,) cost, booked on the first panel of each group."""
        return booked_cost(self.residual, self.panels, panels)

    def add_to(self, normal: Normal, into: Into | None = None) -> None:
        """Add J^T r and J^T J; `into` where it is known already how groups add to blocks."""
        own = Into.of(self.panels, self.pair, normal) if into is None else into
        for scatter, jacobian in zip(own.panels, self.jacobians, strict=True):
            transposed = np.swapaxes(jacobian, 1, 2)
            scatter.add(normal.gradient, (transposed @ self.residual[..., None])[..., 0])
            scatter.add(normal.diagonal, transposed @ jacobian)
        if own.pair is not None:
            own.pair.add(normal.coupling, np.swapaxes(self.jacobians[0], 1, 2) @ self.jacobians[1])


@dataclass(frozen=True, slots=True)
class Into:
    """How groups add to panels and to pairs of coupled panels, for terms that do so again and again."""

    panels: tuple[Scatter, ...]
    pair: Scatter | None

    @staticmethod
    def of(panels: Sequence[IntArray], pair: IntArray | None, normal: Normal) -> Into:
        """That of groups which see these panels, one or two arrays (groups,), and this pair of them (groups,)."""
        count, pairs = len(normal.gradient), len(normal.coupling)
        return Into(tuple(Scatter(index, count) for index in panels), None if pair is None else Scatter(pair, pairs))


def add_rows(rows: list[Rows], normal: Normal, panels: int, into: Into | None = None) -> Array:
    """Add all rows to the model; returns the (panels,) cost."""
    cost = np.zeros(panels)
    for group in rows:
        group.add_to(normal, into)
        cost += group.booked(panels)
    return cost


def booked_cost(residual: Array, panels: Sequence[IntArray], count: int) -> Array:
    """(count,) half the squares of `residual` (groups, ...), booked on the panels of each group in equal parts.

    Args:
        residual: rows in groups.
        panels: one or two index arrays (groups,).
        count: number of panels.
    """
    flat = residual.reshape(len(residual), -1)
    share = 0.5 / len(panels) * np.einsum("gq,gq->g", flat, flat)
    cost = np.zeros(count)
    for index in panels:
        cost += np.bincount(index, share, minlength=count)
    return cost
