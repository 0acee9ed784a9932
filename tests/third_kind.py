"""A kind of feature and of panel that the package does not know: a flat sheet with all its sides and corners alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import PanelError
from cadpanel.features.numbers import Number
from cadpanel.features.panel_edges import Edge, polygon_edges
from cadpanel.features.patches import Patch, Plane
from cadpanel.features.placed import Placed
from cadpanel.features.polygon import Polygon
from cadpanel.features.rulings import Points, Walk
from cadpanel.fitting.start.frames import Frames, Given
from cadpanel.fitting.start.polygons import start_polygons
from cadpanel.geometry import patches
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.frames import point_velocity
from cadpanel.geometry.panel import CutPlane, PanelEdge, Straightened
from cadpanel.geometry.polygon_checks import check_polygon
from cadpanel.geometry.shape import PolygonShape

NUMBERS = ("shift_n", "turn_b", "turn_t", "centre_b", "centre_t", "angle", "reach")


@dataclass(frozen=True)
class Regular:
    """A plane (3 numbers), the middle of its outline (2), which way the first corner lies, and how far the corners."""

    corner_count: int
    name: str = "regular"
    cuts: Literal["square"] = "square"
    anchor: int = 0
    curved: tuple[bool, ...] = (False,)
    four_sided: bool = False
    square: bool = True
    patches: tuple[Patch, ...] = (Plane(),)

    @property
    def numbers(self) -> tuple[Number, ...]:
        return tuple(Number(name, "angle" if name in ("turn_b", "turn_t", "angle") else "length") for name in NUMBERS)

    @property
    def cut_numbers(self) -> IntArray:
        return np.empty((0, 3), dtype=np.intp)

    @property
    def free(self) -> IntArray:
        return np.arange(len(NUMBERS), dtype=np.intp)

    @property
    def edges(self) -> tuple[Edge, ...]:
        return polygon_edges(self.corner_count)

    def in_units(self, length: float) -> Regular:
        del length
        return self

    def patch_slice(self, patch: int) -> slice:
        del patch
        return slice(0, 0)

    def expand(self, unknowns: Array) -> Array:
        return unknowns.copy()

    def by_unknowns(self, derivatives: Array) -> Array:
        return derivatives

    def bounds(self) -> tuple[Array, Array]:
        none = np.full(len(NUMBERS), np.inf)
        return -none, none

    def walk(self, values: Array, *, derivatives: bool) -> Walk:
        return replace(Polygon(3).walk(values, derivatives=derivatives), feature=self)

    def corners(self, walked: Walk) -> Points:
        plane, values = walked.anchor, walked.values
        angles = values[:, 5, None] + 2.0 * np.pi * np.arange(self.corner_count) / self.corner_count
        ways = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        axes = np.stack([plane.b[:, 0], plane.t[:, 0]], axis=1)
        position = plane.p + (values[:, None, 3:5] + values[:, 6, None, None] * ways) @ axes
        if plane.twist is None:
            return Points(position, None)
        moved = np.array(point_velocity(plane.twist, position))
        moved[..., 3:5] += np.swapaxes(axes, 1, 2)[:, None]
        moved[..., 5] += (values[:, 6, None, None] * np.stack([-ways[..., 1], ways[..., 0]], axis=-1)) @ axes
        moved[..., 6] += ways @ axes
        return Points(position, moved)

    def arcs(self, walked: Walk) -> Points:
        return Polygon(3).arcs(walked)

    def shapes(self, walked: Walk, placed: Placed) -> Sequence[RegularShape]:
        outlines, normals = placed.points(self.corners(walked).position), placed.directions(walked.anchor.n)[:, 0]
        return [RegularShape(name, self.name, outlines[i], normals[i]) for i, name in enumerate(placed.names)]


@dataclass(frozen=True)
class RegularShape:
    """The panel: its corners (n, 3), counterclockwise about the normal."""

    name: str
    feature: str
    outline: Array
    normal: Array
    four_sided: bool = False
    square: bool = True
    patches: tuple[patches.Patch, ...] = (patches.PlanePatch(),)

    def corners(self) -> Array:
        return self.outline[None]

    def rulings(self) -> tuple[Array, Array, Array]:
        return self.as_polygon().rulings()

    def cuts(self) -> tuple[Array, Array]:
        return self.as_polygon().cuts()

    def edge(self, edge: str) -> PanelEdge:
        return self.as_polygon().edge(edge)

    def arcs(self) -> CurvePieces:
        return self.as_polygon().arcs()

    def cut_back(self, planes: Mapping[str, CutPlane], depth: float) -> RegularShape:
        raise PanelError(self.name, f"cut along {sorted(planes)} to {depth:g} mm it is not regular: use a polygon.")

    def squared(self, _depth: float) -> RegularShape:
        return self

    def area(self) -> float:
        reach = np.linalg.norm(self.outline[0] - self.outline.mean(axis=0))
        return float(0.5 * len(self.outline) * reach**2 * np.sin(2.0 * np.pi / len(self.outline)))

    def offset(self, distance: float) -> RegularShape:
        return replace(self, outline=self.outline + distance * self.normal)

    def straightened(self) -> Straightened[RegularShape]:
        return Straightened(shape=self, patches=(), largest_move=0.0)

    def check(self) -> None:
        check_polygon(self)

    def check_sheet(self, away: RegularShape, thickness: float) -> None:
        pass

    def as_polygon(self) -> PolygonShape:
        return PolygonShape(name=self.name, feature=self.feature, outline=self.outline, normal=self.normal)


def start_regular(feature: Regular, given: Given) -> Frames:
    """From the start of a polygon: the middle of its corners, and how far and which way they lie."""
    begun = start_polygons(Polygon(feature.corner_count), given)
    (values,) = begun.values
    within = values[:, 3:].reshape(len(values), -1, 2)
    middle = within.mean(axis=1)
    out = within - middle[:, None]
    angle, reach = np.arctan2(out[:, 0, 1], out[:, 0, 0]), np.linalg.norm(out, axis=-1).mean(axis=1)
    return Frames(begun.origins, begun.axes, [np.column_stack([values[:, :3], middle, angle, reach])])


def regular(seed: int, corners: int, *, reach: float = 1000.0) -> PolygonShape:
    """A known panel, as its corners."""
    random = np.random.default_rng(seed)
    (b, t, n), _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn = random.uniform(0.0, 1.0) + 2.0 * np.pi * np.arange(corners) / corners
    n = np.cross(b, t)
    outline = random.uniform(-5000.0, 5000.0, 3) + reach * (np.outer(np.cos(turn), b) + np.outer(np.sin(turn), t))
    return PolygonShape(name=f"regular {seed}", feature="regular", outline=outline, normal=n)
