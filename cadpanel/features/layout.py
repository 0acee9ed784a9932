"""Which panels have which feature, and how the unknowns of all of them stand in one array."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.numbers import POWERS
from cadpanel.features.rulings import PanelFeature, Walk

Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True, slots=True)
class Group:
    """Panels of one feature.

    Attributes:
        feature: their feature, lengths in the solver's units.
        panels: (n,) their indices, rising.
    """

    feature: PanelFeature
    panels: IntArray


@dataclass(frozen=True)
class Layout:
    """Panels in groups of one feature each.

    Each panel has a row of unknowns as long as the longest; what a feature does not need at its end stays 0.

    Attributes:
        groups: every panel is in one of them.
        panels: number of panels.
    """

    groups: tuple[Group, ...]
    panels: int

    @staticmethod
    def of(features: Sequence[PanelFeature], length: float = 1.0) -> Layout:
        """The layout of panels with these features, lengths counted in units of `length` mm."""
        groups: dict[PanelFeature, list[int]] = {}
        for panel, feature in enumerate(features):
            groups.setdefault(feature, []).append(panel)
        return Layout(
            tuple(
                Group(feature.in_units(length), np.array(panels, dtype=np.intp)) for feature, panels in groups.items()
            ),
            len(features),
        )

    @cached_property
    def size(self) -> int:
        """Unknowns in a row."""
        return max(len(group.feature.free) for group in self.groups)

    @cached_property
    def feature_of(self) -> tuple[PanelFeature, ...]:
        """The feature of every panel."""
        found: dict[int, PanelFeature] = {}
        for group in self.groups:
            found |= dict.fromkeys(group.panels.tolist(), group.feature)
        return tuple(found[panel] for panel in range(self.panels))

    @cached_property
    def used(self) -> BoolArray:
        """(panels, size) which entries are unknowns of the panel's feature."""
        used = np.zeros((self.panels, self.size), dtype=bool)
        for group in self.groups:
            used[group.panels, : len(group.feature.free)] = True
        return used

    @cached_property
    def powers(self) -> Array:
        """(panels, size) the power of a length that each unknown counts in."""
        powers = np.zeros((self.panels, self.size))
        for group in self.groups:
            feature = group.feature
            powers[group.panels, : len(feature.free)] = [POWERS[feature.numbers[i].unit] for i in feature.free]
        return powers

    @cached_property
    def patches(self) -> IntArray:
        """(panels,) number of patches."""
        return np.array([len(feature.patches) for feature in self.feature_of], dtype=np.intp)

    @cached_property
    def curved(self) -> BoolArray:
        """(panels, K) which patches are cones or cylinders; K at most, no patch is where a panel has fewer."""
        curved = np.zeros((self.panels, int(self.patches.max())), dtype=bool)
        for panel, feature in enumerate(self.feature_of):
            curved[panel, : len(feature.curved)] = feature.curved
        return curved

    def walk(self, unknowns: Array, *, derivatives: bool) -> tuple[Walk, ...]:
        """Walk all panels at the unknowns (panels, size), group by group."""
        return tuple(
            group.feature.walk(
                group.feature.expand(self.own(unknowns, group)[:, : len(group.feature.free)]), derivatives=derivatives
            )
            for group in self.groups
        )

    def own(self, values: Array, group: Group) -> Array:
        """Rows (n, ...) of the panels of one group, without a copy where it is all of them."""
        return values if len(self.groups) == 1 else values[group.panels]

    def gather(self, parts: Sequence[NDArray[Scalar]]) -> NDArray[Scalar]:
        """One array (panels, ...) from one (n, ...) a group; axes that differ in length are filled up with zeros."""
        if len(parts) == 1:
            return parts[0]
        shape = np.max([part.shape[1:] for part in parts], axis=0, initial=0)
        whole = np.zeros((self.panels, *shape), dtype=parts[0].dtype)
        for group, part in zip(self.groups, parts, strict=True):
            filled = np.zeros((len(part), *shape), dtype=part.dtype)
            filled[tuple(slice(length) for length in part.shape)] = part
            whole[group.panels] = filled
        return whole
