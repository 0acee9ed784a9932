"""Holes in the file against the flat pattern: how many, how wide, where, and how far from edges and bends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.geometry.fixings import TOO_NEAR, clearance
from cadpanel.geometry.flat_places import FlatPlace
from cadpanel.geometry.unroll import FlatPattern

HOLE_LIMIT = 1e-6
"""Distance in mm of a hole's rim from the circle on the flat pattern, and from the face that it pierces."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedHoles:
    """The holes of a panel.

    Attributes:
        pattern: the panel's.
        places: its patches, on the skin and in the plane.
        patches: the patch in which each hole lies.
        middles: (h, 2) on the flat pattern, mm.
        diameter: of all of them, mm.
        distance: that their middles keep from edges and from where bends begin and end, mm.
        depth: where the sheet's other face lies, mm along the skin's normals.
        skin_area: what they take of the skin, mm2.
    """

    pattern: FlatPattern
    places: tuple[FlatPlace, ...]
    patches: tuple[int, ...]
    middles: Array
    diameter: float
    distance: float
    depth: float
    skin_area: float

    @property
    def walls(self) -> tuple[str, ...]:
        """Kinds of the faces that they add: two a hole."""
        kinds = ("cylinder" if self.places[patch].frame is None else "other" for patch in self.patches)
        return tuple(kind for kind in kinds for _ in range(2))

    @property
    def smooth_edges(self) -> int:
        """Straight edges between the halves of cylinders."""
        return self.walls.count("cylinder")


class _Rim(NamedTuple):
    """Where a hole should pierce a face: which one, and at which height over the skin."""

    hole: int
    lift: float


def check_holes(name: str, expected: ExpectedHoles | None, solid: ShapeFacts, failures: list[str]) -> float:
    """How far a place of a rim lies off its circle at most, mm; what does not hold becomes a sentence."""
    wanted = 0 if expected is None else 2 * len(expected.patches)
    if len(solid.rims) != wanted:
        failures.append(f"Panel '{name}': its solid has {len(solid.rims)} rims of holes, expected {wanted}.")
        return 0.0
    if expected is None or not wanted:
        return 0.0
    rims = [_Rim(hole, lift) for hole in range(len(expected.patches)) for lift in (0.0, expected.depth)]
    flats, off = _flat_rims(expected, rims, solid.rims)
    error = max(off, float(np.abs(_radii(expected, rims, flats) - 0.5 * expected.diameter).max()))
    if not error <= HOLE_LIMIT:
        failures.append(f"Panel '{name}': a hole in its solid lies {error:.3g} mm off where the flat pattern has it.")
        return error
    # Rims are circles about these middles now, so that what holds of the middles holds of them.
    room = float(clearance(expected.pattern, expected.middles).min())
    if not room >= expected.distance - 2.0 * TOO_NEAR:
        failures.append(
            f"Panel '{name}': a hole's middle is {room:.3g} mm from an edge or a bend, {expected.distance:g} mm were "
            "asked for."
        )
    return error


def _flat_rims(expected: ExpectedHoles, rims: Sequence[_Rim], found: Array) -> tuple[Array, float]:
    """(2 h, q, 2) the rims in the plane, each in the place of the one that it should be, and how far one is off."""
    centres = np.array([_pierced(expected, rim) for rim in rims])
    middles = found.mean(axis=1)
    # The middle of a rim that is rolled round lies a little inside of it, by far less than holes are apart.
    nearest = np.linalg.norm(middles[:, None] - centres, axis=-1).argmin(axis=1)
    if len(set(nearest.tolist())) != len(rims):
        return np.zeros((len(rims), found.shape[1], 2)), np.inf
    order = np.argsort(nearest)
    flats, off = [], 0.0
    for rim, points in zip(rims, found[order], strict=True):
        place = expected.places[expected.patches[rim.hole]]
        flat = place.in_plane(points, rim.lift)
        on_skin, normals = place.on_skin(flat)
        off = max(off, float(np.abs(on_skin + rim.lift * normals - points).max()))
        flats.append(flat)
    return np.array(flats), off


def _pierced(expected: ExpectedHoles, rim: _Rim) -> Array:
    """(3,) where the middle of a hole lies on a face."""
    place = expected.places[expected.patches[rim.hole]]
    (point,), (normal,) = place.on_skin(expected.middles[rim.hole][None])
    return np.asarray(point + rim.lift * normal)


def _radii(expected: ExpectedHoles, rims: Sequence[_Rim], flats: Array) -> Array:
    """(2 h, q) distances of rims from the middles of their holes."""
    middles = expected.middles[[rim.hole for rim in rims]]
    return np.asarray(np.linalg.norm(flats - middles[:, None], axis=-1))
