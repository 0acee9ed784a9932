"""The planar polygon: a plane and its corners in it. No chain of rulings, but the same to fits, terms and seams."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import Literal, Self

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.numbers import Number
from cadpanel.features.panel_edges import Edge, polygon_edges
from cadpanel.features.patches import Patch, Plane
from cadpanel.features.placed import Placed
from cadpanel.features.rulings import Points, Rulings, Walk
from cadpanel.geometry.frames import cayley, cayley_rates, point_velocity, skew
from cadpanel.geometry.shape import PolygonShape

MOST_CORNERS = 64

_PLANE = (
    Number("plane: shift_n", "length"),
    Number("plane: turn_b", "slope"),
    Number("plane: turn_t", "slope"),
)


@dataclass(frozen=True, init=False)
class Polygon:
    """A plane (3 numbers) and its corners in it (2 numbers each); all are independent.

    Attributes:
        name: as reports call it.
        corner_count: number of corners, 3 or more.
        patches: the one plane.
        cuts: a polygon's edges lie square on it.
        anchor: the patch that the walk starts from: the plane.
        numbers: all numbers: of the plane, then b and t of each corner.
        free: indices of the numbers that the fit may choose: all.
    """

    name: str
    corner_count: int
    patches: tuple[Patch, ...] = field(repr=False)
    cuts: Literal["square"]
    anchor: int
    numbers: tuple[Number, ...] = field(repr=False)
    free: IntArray = field(repr=False, compare=False)

    def __init__(self, corners: int, *, name: str = "planar-polygon") -> None:
        """Lay out the numbers.

        Raises:
            SettingsError: fewer than 3 corners, or more than any panel has.
        """
        if not 3 <= corners <= MOST_CORNERS:
            raise SettingsError(f"a polygon has between 3 and {MOST_CORNERS} corners, not {corners}")
        set_ = object.__setattr__
        set_(self, "name", name)
        set_(self, "corner_count", corners)
        set_(self, "patches", (Plane(),))
        set_(self, "cuts", "square")
        set_(self, "anchor", 0)
        of_corners = [Number(f"corner {i}: {axis}", "length") for i in range(corners) for axis in "bt"]
        set_(self, "numbers", (*_PLANE, *of_corners))
        set_(self, "free", np.arange(len(self.numbers), dtype=np.intp))

    @property
    def curved(self) -> tuple[bool, ...]:
        """Its one patch is flat."""
        return (False,)

    @property
    def edges(self) -> tuple[Edge, ...]:
        """One from each corner to the next."""
        return polygon_edges(self.corner_count)

    @property
    def cut_numbers(self) -> IntArray:
        """(0, 3) a polygon has edges all round and no ends that a plane could cut."""
        return np.empty((0, 3), dtype=np.intp)

    @property
    def four_sided(self) -> bool:
        """A polygon's edges are alike: none is an end or a side."""
        return False

    def patch_slice(self, patch: int) -> slice:
        """Empty: the plane's numbers are those of where it stands."""
        del patch
        return slice(0, 0)

    def in_units(self, length: float) -> Self:
        """The same feature: it fixes no length."""
        del length
        return copy.copy(self)

    def expand(self, unknowns: Array) -> Array:
        """(n, numbers) all numbers from the (n, free) unknowns."""
        return unknowns.copy()

    def by_unknowns(self, derivatives: Array) -> Array:
        """Derivatives (..., free) by the unknowns, from those (..., numbers) by all numbers."""
        return derivatives

    def bounds(self) -> tuple[Array, Array]:
        """(free,) least and greatest values of the unknowns: none."""
        none = np.full(len(self.free), np.inf)
        return -none, none

    def walk(self, values: Array, *, derivatives: bool) -> Walk:
        """The planes of panels with these numbers (n, numbers), as their only ruling."""
        panels = len(values)
        turn = np.concatenate([values[:, 1:3], np.zeros((panels, 1))], axis=1)
        axes = cayley(turn)
        frames = np.zeros((panels, 1, 4, 3))
        frames[:, 0, :3] = np.swapaxes(axes, 1, 2)
        frames[:, 0, 3, 2] = values[:, 0]
        twist = None
        if derivatives:
            twist = np.zeros((panels, 1, 6, values.shape[1]))
            twist[:, 0, 5, 0] = 1.0
            rates = cayley_rates(turn)[:, :, :2]
            twist[:, 0, :3, 1:3] = rates
            twist[:, 0, 3:, 1:3] = skew(frames[:, 0, 3]) @ rates
        plane = Rulings(frames, twist)
        return Walk(self, values, (), plane, plane.at(slice(0)), plane)

    def corners(self, walked: Walk) -> Points:
        """The corners (n, corners, 3) of walked panels."""
        plane, panels = walked.anchor, len(walked.values)
        axes = np.stack([plane.b[:, 0], plane.t[:, 0]], axis=1)
        within = walked.values[:, len(_PLANE) :].reshape(panels, -1, 2)
        position = plane.p + within @ axes
        if plane.twist is None:
            return Points(position, None)
        moved = np.array(point_velocity(plane.twist, position))
        for corner in range(self.corner_count):
            at = len(_PLANE) + 2 * corner
            moved[:, corner, :, at : at + 2] += np.swapaxes(axes, 1, 2)
        return Points(position, moved)

    def arcs(self, walked: Walk) -> Points:
        """No arc points (n, 0, 3): all edges are straight."""
        none = np.zeros((len(walked.values), 0, 3))
        return Points(none, None if walked.anchor.twist is None else np.zeros((*none.shape, walked.values.shape[1])))

    def shapes(self, walked: Walk, placed: Placed) -> list[PolygonShape]:
        """Walked panels in the coordinates of the reference's file, mm."""
        outlines, normals = placed.points(self.corners(walked).position), placed.directions(walked.anchor.n)[:, 0]
        return [
            PolygonShape(name=name, feature=self.name, outline=outlines[i], normal=normals[i])
            for i, name in enumerate(placed.names)
        ]
