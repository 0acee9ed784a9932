"""Folded flat panels rolled out: the flat part, strips beyond its edges, arcs about its corners. Millimetres."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.flat_curves import FlatCurves, joined, segments
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.vectors import cross

CORNER = "corner"
"""How pieces of an outline are called, with its number, that belong to a relief and not to an edge."""


def of_corner(edge: str) -> bool:
    """Whether a piece of an outline that is called so belongs to a relief at a corner."""
    return edge.startswith(CORNER)


@dataclass(slots=True)
class FlatTray:
    """A flat pattern as it grows.

    Attributes:
        curves: pieces of the outline, counterclockwise.
        edges: the edge of each, or the corner.
        owners: the patch of each.
        tangents: (2, 2) the lines at which folds begin and end.
        bends: of each fold its patch, the pieces in which it ends, and its sweep.
        origins, ways: of each patch a point of its first ruling and its direction, (2,) each.
    """

    curves: list[FlatCurves] = field(default_factory=list)
    edges: list[str] = field(default_factory=list)
    owners: list[int] = field(default_factory=list)
    tangents: list[Array] = field(default_factory=list)
    bends: list[tuple[int, tuple[int, int], float]] = field(default_factory=list)
    origins: list[Array] = field(default_factory=list)
    ways: list[Array] = field(default_factory=list)

    def outline(self) -> FlatCurves:
        """All pieces."""
        return joined(self.curves)

    def add(self, piece: FlatCurves, edge: str, owner: int) -> int:
        """One more piece; returns its place."""
        self.curves.append(piece)
        self.edges.append(edge)
        self.owners.append(owner)
        return len(self.curves) - 1


def flat_tray(shape: TrayShape) -> FlatTray:
    """The flat pattern of a skin, its first edge along x."""
    plan = shape.plan
    axes = np.stack([plan.along[0], cross(plan.normal, plan.along[0])], axis=-1)
    corners, starts, stops = ((of - plan.corners[0]) @ axes for of in (plan.corners, plan.starts, plan.stops))
    along, outward = plan.along @ axes, plan.outward @ axes
    names, patch = shape.edges, 0
    found = FlatTray(origins=[np.zeros(2)], ways=[np.array([0.0, 1.0])])
    for edge, name in enumerate(names):
        here, after = f"{CORNER} {edge}", f"{CORNER} {(edge + 1) % len(names)}"
        if plan.reliefs[edge] > 0.0:
            found.add(_relief(corners[edge], stops[edge - 1], starts[edge], float(plan.openings[edge])), here, 0)
        if not plan.folded[edge]:
            found.add(_segment(starts[edge], stops[edge]), name, 0)
            continue
        bent = shape.radius * float(plan.angles[edge]) * outward[edge]
        tip = bent + float(plan.legs[edge]) * outward[edge]
        begin = [starts[edge], starts[edge] + bent, starts[edge] + tip]
        end = [stops[edge] + tip, stops[edge] + bent, stops[edge]]
        first = found.add(_segment(begin[0], begin[1]), here, patch + 1)
        found.add(_segment(begin[1], begin[2]), here, patch + 2)
        found.add(_segment(begin[2], end[0]), name, patch + 2)
        found.add(_segment(end[0], end[1]), after, patch + 2)
        last = found.add(_segment(end[1], end[2], backward=True), after, patch + 1)
        found.tangents += [np.array([begin[0], end[2]]), np.array([begin[1], end[1]])]
        found.bends.append((patch + 1, (first, last), float(plan.angles[edge])))
        found.origins += begin[:2]
        found.ways += [along[edge], along[edge]]
        patch += 2
    return found


def _segment(start: Array, stop: Array, *, backward: bool = False) -> FlatCurves:
    piece = segments(start[None], stop[None])
    piece.backward[:] = backward
    return piece


def _relief(middle: Array, start: Array, stop: Array, opening: float) -> FlatCurves:
    """The arc about a corner through the panel's inside: an end of a cone that is a disc, rolled out."""
    radius = float(math.hypot(*(start - middle)))
    return FlatCurves(
        start=start[None],
        stop=stop[None],
        origin=middle[None],
        along=((start - middle) / radius)[None],
        level_radius=np.zeros(1),
        sine=np.ones(1),
        first=np.zeros(1),
        sweep=np.array([opening]),
        reach=np.array([[radius, 0.0, 0.0]]),
        rate=np.array([[1.0, 0.0, 0.0]]),
        backward=np.zeros(1, dtype=bool),
        way_out=np.zeros(1),
    )
