"""Patches that a user might write: planes, cones and cylinders told by other numbers than the package's own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.numbers import Number, Value
from cadpanel.features.patches import Dimensions


@dataclass(frozen=True, kw_only=True)
class CurvedBy:
    """A cylinder told by its sweep and by the curvature of its sheet, 1 / mm."""

    sweep: Value = None
    curvature: Value = None

    @property
    def kind(self) -> Literal["cylinder"]:
        return "cylinder"

    def numbers(self) -> tuple[Number, ...]:
        return Number.of("sweep", "angle", self.sweep), Number.of("curvature", "curvature", self.curvature)

    def dimensions(self, values: Array) -> Dimensions:
        sweep, curvature = values.T
        rates = np.zeros((len(values), 3, 2))
        rates[:, 0, 1], rates[:, 2, 0] = -1.0 / curvature**2, 1.0
        return Dimensions(np.stack([1.0 / curvature, np.zeros(len(values)), sweep], axis=1), rates)

    def numbers_for(self, dimensions: Array) -> Array:
        return np.stack([dimensions[:, 2], 1.0 / dimensions[:, 0]], axis=1)


@dataclass(frozen=True, kw_only=True)
class AngleFirst:
    """A cone told by the package's numbers in another order: half angle, sweep, radius."""

    half_angle: Value = None
    sweep: Value = None
    radius: Value = None

    @property
    def kind(self) -> Literal["cone"]:
        return "cone"

    def numbers(self) -> tuple[Number, ...]:
        return (
            Number.of("half_angle", "angle", self.half_angle),
            Number.of("sweep", "angle", self.sweep),
            Number.of("radius", "length", self.radius),
        )

    def dimensions(self, values: Array) -> Dimensions:
        order = [2, 0, 1]
        return Dimensions(values[:, order], np.tile(np.eye(3)[order], (len(values), 1, 1)))

    def numbers_for(self, dimensions: Array) -> Array:
        return dimensions[:, [1, 2, 0]]


@dataclass(frozen=True, kw_only=True)
class ByGirth:
    """A cone told by how much sheet goes round it, radius times sweep, besides its half angle and radius."""

    girth: Value = None
    half_angle: Value = None
    radius: Value = None

    @property
    def kind(self) -> Literal["cone"]:
        return "cone"

    def numbers(self) -> tuple[Number, ...]:
        return (
            Number.of("girth", "length", self.girth),
            Number.of("half_angle", "angle", self.half_angle),
            Number.of("radius", "length", self.radius),
        )

    def dimensions(self, values: Array) -> Dimensions:
        girth, half_angle, radius = values.T
        rates = np.zeros((len(values), 3, 3))
        rates[:, 0, 2] = rates[:, 1, 1] = 1.0
        rates[:, 2, 0], rates[:, 2, 2] = 1.0 / radius, -girth / radius**2
        return Dimensions(np.stack([radius, half_angle, girth / radius], axis=1), rates)

    def numbers_for(self, dimensions: Array) -> Array:
        radius, half_angle, sweep = dimensions.T
        return np.stack([radius * sweep, half_angle, radius], axis=1)


@dataclass(frozen=True, kw_only=True)
class ByRoot:
    """A plane told by its turn and by the root of its width, which cannot become negative."""

    turn: Value = None
    root: Value = None

    @property
    def kind(self) -> Literal["plane"]:
        return "plane"

    def numbers(self) -> tuple[Number, ...]:
        return Number.of("turn", "angle", self.turn), Number.of("root", "root length", self.root)

    def dimensions(self, values: Array) -> Dimensions:
        turn, root = values.T
        rates = np.zeros((len(values), 2, 2))
        rates[:, 0, 1], rates[:, 1, 0] = 2.0 * root, 1.0
        return Dimensions(np.stack([root**2, turn], axis=1), rates)

    def numbers_for(self, dimensions: Array) -> Array:
        return np.stack([dimensions[:, 1], np.sqrt(np.maximum(dimensions[:, 0], 0.0))], axis=1)
