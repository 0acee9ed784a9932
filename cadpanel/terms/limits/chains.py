"""Many panels as arrays, for what limits measure of their shapes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.panel import Chain, Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.vectors import cross, dot


@dataclass(frozen=True, slots=True, kw_only=True)
class Chains:
    """Chains of k patches that are curved and flat in the same places.

    Attributes:
        panels: (n,) their places among all panels.
        curved, flat: which patches are cones or cylinders, and which are flat.
        points, directions, normals: (n, k + 1, 3) of the rulings, mm.
        corners: (n, 2, k + 1, 3) by end and ruling, mm.
        cut_normals: (n, 2, 3) unit normals of the planes that cut the ends.
        radius, half_angle: (n, k) normal radius in mm and half angle in radians of the patches, 0 where flat.
    """

    panels: IntArray
    curved: IntArray
    flat: IntArray
    points: Array
    directions: Array
    normals: Array
    corners: Array
    cut_normals: Array
    radius: Array
    half_angle: Array

    def heights(self, patch: int) -> Array:
        """(n, 2, 2) how far up their generatrices a curved patch's corners lie, by end and ruling, mm.

        From the level of the first ruling's point: wherever the second one has its own.
        """
        half_angle = self.half_angle[:, patch, None]
        axis = np.cos(half_angle) * self.directions[:, patch] - np.sin(half_angle) * self.normals[:, patch]
        beyond = self.corners[:, :, patch : patch + 2] - self.points[:, None, None, patch]
        return np.asarray(dot(beyond, axis[:, None, None]) / np.cos(half_angle)[..., None])

    @property
    def widths(self) -> Array:
        """(n, 2, k) of the patches at both ends, from one ruling square across to the corner on the next, mm."""
        across = cross(self.directions, self.normals)[:, None, :-1]
        return dot(self.corners[:, :, 1:] - self.corners[:, :, :-1], across)


def chains_of(shapes: Sequence[Panel]) -> Iterator[Chains]:
    """The chains among panels, in batches that are alike."""
    alike: dict[tuple[bool, ...], list[Chain]] = defaultdict(list)
    where: dict[tuple[bool, ...], list[int]] = defaultdict(list)
    kinds: dict[type[Panel], bool] = {}  # what a protocol's attributes tell is dear to ask panel by panel
    for place, shape in enumerate(shapes):
        kind = type(shape)
        if kind not in kinds:
            kinds[kind] = isinstance(shape, Chain)
        if kinds[kind]:
            chain = cast(Chain, shape)
            curved = tuple(isinstance(patch, ConePatch) for patch in chain.patches)
            alike[curved].append(chain)
            where[curved].append(place)
    for curved, chains in alike.items():
        yield _chains(curved, where[curved], chains)


def _chains(curved: tuple[bool, ...], places: list[int], shapes: list[Chain]) -> Chains:
    points, directions, normals, cut_points, cut_normals = (
        np.array([getattr(shape, name) for shape in shapes])
        for name in ("points", "directions", "normals", "cut_points", "cut_normals")
    )
    # As `PanelShape.corners` has it, for all at once.
    planes = cut_normals[:, :, None]
    to_plane = dot(cut_points[:, :, None] - points[:, None], planes)
    corners = points[:, None] + (to_plane / dot(directions[:, None], planes))[..., None] * directions[:, None]
    numbers = np.array(
        [[(p.radius, p.half_angle) if isinstance(p, ConePatch) else (0.0, 0.0) for p in s.patches] for s in shapes]
    )
    return Chains(
        panels=np.array(places, dtype=np.intp),
        curved=np.flatnonzero(curved),
        flat=np.flatnonzero(~np.array(curved)),
        points=points,
        directions=directions,
        normals=normals,
        corners=corners,
        cut_normals=cut_normals,
        radius=numbers[..., 0],
        half_angle=numbers[..., 1],
    )
