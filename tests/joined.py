"""Flat panels that meet exactly, with their seams: quadrilaterals of a translation surface, and tangent hexagons."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.edge_planes import SeamEdges
from cadpanel.geometry.panel import CutPlane, Panel
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.vectors import cross, unit

SIDE = 1000.0  # mm


def polygon(name: str, corners: Array) -> PolygonShape:
    """Corners in one plane, counterclockwise seen from above."""
    turns = cross(corners - corners[0], np.roll(corners, -1, axis=0) - corners[0])
    return PolygonShape(name=name, feature="planar-polygon", outline=corners, normal=unit(turns.sum(axis=0)))


def quadrilaterals(count: int = 3, sags: tuple[float, float] = (20.0, 30.0), skew: float = 0.0) -> list[PolygonShape]:
    """Quadrilaterals between translates of one curve along another: flat, and four meet in each inner corner."""
    steps = np.arange(count + 1.0)
    along = np.stack([SIDE * steps, skew * SIDE * steps, -sags[0] * (steps - 0.5 * count) ** 2], axis=-1)
    across = np.stack([0.2 * SIDE * steps, SIDE * steps, -sags[1] * (steps - 0.3 * count) ** 2], axis=-1)
    points = along[:, None] + across
    return [
        polygon(f"Q{i}{j}", np.array([points[i, j], points[i + 1, j], points[i + 1, j + 1], points[i, j + 1]]))
        for i in range(count)
        for j in range(count)
    ]


def hexagons(radius: float = 12_000.0) -> list[PolygonShape]:
    """A hexagon and its six neighbours in planes that touch a sphere: three meet in each inner corner."""
    turns = np.radians(60.0 * np.arange(6))
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    places = [np.zeros(2), *(np.sqrt(3.0) * SIDE * ways)]
    return [
        polygon(f"H{i}", _touching(place, [place + np.sqrt(3.0) * SIDE * way for way in ways], radius))
        for i, place in enumerate(places)
    ]


def _touching(place: Array, others: list[Array], radius: float) -> Array:
    """Where the plane that touches the sphere above a place meets those above each two of the others in turn."""

    def normal(at: Array) -> Array:
        return np.array([*at, np.sqrt(radius**2 - at @ at)]) / radius

    around = zip(others, [*others[1:], others[0]], strict=True)
    planes = [np.stack([normal(place), normal(one), normal(two)]) for one, two in around]
    return np.array([np.linalg.solve(system, np.full(3, radius)) for system in planes])


def seams(panels: list[PolygonShape]) -> list[SeamEdges]:
    """Edges between the same two corners."""
    at: dict[tuple[float, ...], list[tuple[int, str]]] = defaultdict(list)
    for i, panel in enumerate(panels):
        middles = 0.5 * (panel.outline + np.roll(panel.outline, -1, axis=0))
        for edge, middle in enumerate(middles):
            at[tuple(np.round(middle, 3) + 0.0)].append((i, f"edge {edge}"))
    pairs = [found for found in at.values() if len(found) == 2]
    return [SeamEdges(panels=(one[0], two[0]), edges=(one[1], two[1])) for one, two in pairs]


def leaning(shape: Panel, edge: str, distance: float, lean: float, turn: float = 0.0) -> CutPlane:
    """A plane that many mm inside an edge of a panel, turned by `lean` about it, and by `turn` within the sheet."""
    own = shape.edge(edge)
    along = unit(own.corners[-1] - own.corners[0])
    normal = own.normal if own.normal is not None else cross(along, own.outward)
    way = unit(own.outward + lean * normal + turn * along)
    return CutPlane(point=own.corners.mean(axis=0) - distance * way, normal=way)


def turned(panel: PolygonShape, rotation: Array, shift: Array) -> PolygonShape:
    """The panel moved as a rigid body."""
    return replace(panel, outline=panel.outline @ rotation.T + shift, normal=rotation @ panel.normal)
