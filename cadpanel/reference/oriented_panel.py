"""A panel before it is known which of its edges are ends: samples, and a closed loop of sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.vectors import cross, norm, unit
from cadpanel.reference.model import RawPanel, Turning
from cadpanel.reference.outline import Outline
from cadpanel.reference.outline_sides import Side

# Where the mean of a panel's normals is shorter than this, it winds round too far to have a side that faces a viewer.
WOUND = 0.1


@dataclass(frozen=True, kw_only=True)
class Sheet:
    """Samples and outline of one panel; which face is the outer one may still be changed.

    Attributes:
        name: the panel's stable name.
        points, normals, weights: (m, 3), (m, 3) and (m,) samples over all faces, mm.
        sides: follow each other counterclockwise about the normals.
    """

    name: str
    points: Array
    normals: Array
    weights: Array
    sides: tuple[Side, ...]

    def other_face(self) -> Sheet:
        """The same panel with its other face outside; side k becomes side -1 - k."""
        return Sheet(
            name=self.name,
            points=self.points,
            normals=-self.normals,
            weights=self.weights,
            sides=tuple(
                Side(points=side.points[::-1], normals=-side.normals[::-1], length=side.length)
                for side in reversed(self.sides)
            ),
        )

    @cached_property
    def bends(self) -> Array:
        """(sides,) angle by which the normals lean forwards on the way along each side, radians; > 0 where convex."""
        return np.asarray(self.leans.sum(axis=1))

    def bend_of_pair(self, side: int) -> float:
        """By how much a side and the opposite one, of four, bend at most between any two places on them, radians.

        Where both bend one way all along that is the sum of their `bends`; a Z profile bends to and fro, and nothing is
        left of it in the end. Bends that the two sides have in opposite ways, as on a twisted flat panel, do not count.
        """
        leans = self.leans[side] + self.leans[(side + 2) % 4][::-1]
        turned = np.concatenate([[0.0], np.cumsum(leans)])
        return float(np.ptp(turned))

    @cached_property
    def leans(self) -> Array:
        """(sides, q - 1) angles by which the normals lean forwards from each point of a side to the next, radians.

        Turning sideways (the twist of a flange) does not count.
        """
        steps = np.diff(np.array([[side.normals, side.points] for side in self.sides]), axis=2)
        turns, ways = steps[:, 0], steps[:, 1]
        angles = 2.0 * np.arcsin(np.clip(0.5 * norm(turns), 0.0, 1.0))
        return np.asarray(angles * np.einsum("skd,skd->sk", unit(turns), unit(ways)))


def sheet(panel: RawPanel, outline: Outline) -> Sheet:
    """The panel with the outline that was found for it."""
    normals = [sign * face.normals for sign, face in zip(outline.face_signs, panel.faces, strict=True)]
    found = Sheet(
        name=panel.name,
        points=np.concatenate([face.points for face in panel.faces]),
        normals=np.concatenate(normals),
        weights=np.concatenate([face.weights for face in panel.faces]),
        sides=outline.sides,
    )
    if _runs_counterclockwise(found):
        return found
    sides = tuple(
        Side(points=side.points[::-1], normals=side.normals[::-1], length=side.length) for side in outline.sides[::-1]
    )
    return Sheet(name=found.name, points=found.points, normals=found.normals, weights=found.weights, sides=sides)


def turning(sheet_: Sheet, first: int) -> Turning:
    """How the normals turn along the outline of a panel whose ends are the sides `first` and `first + 2`."""
    bends = sheet_.bends
    ends = [sheet_.sides[first], sheet_.sides[(first + 2) % 4]]
    long_edges = [sheet_.sides[(first + 1) % 4], sheet_.sides[(first + 3) % 4]]
    return Turning(
        across=float(0.5 * (bends[first] + bends[(first + 2) % 4])),
        along=max(_spread(side) for side in long_edges),
        to_and_fro=float(np.abs(sheet_.leans).sum(axis=1).max()),
        slenderness=sum(side.length for side in ends) / sum(side.length for side in long_edges),
    )


def _runs_counterclockwise(of: Sheet) -> bool:
    """Whether the loop encloses its area on the left, seen against the normals.

    The integral of a surface's normals is that of r x dr / 2 along its loop. Where a panel winds round so far that
    nothing is left of either, the samples next to the loop tell on which side of it the panel lies.
    """
    loop = np.concatenate([side.points[:-1] for side in of.sides])
    loop = loop - loop.mean(axis=0)
    facing = of.weights @ of.normals
    if float(norm(facing)) > WOUND * float(of.weights.sum()):
        return bool(np.cross(loop, np.roll(loop, -1, axis=0)).sum(axis=0) @ facing > 0.0)
    normals = np.concatenate([side.normals[:-1] for side in of.sides])
    points = np.concatenate([side.points[:-1] for side in of.sides])
    _, nearest = cKDTree(of.points).query(points)
    inwards = cross(normals, np.roll(loop, -1, axis=0) - loop)
    return bool(np.einsum("ld,ld->", inwards, of.points[nearest] - points) > 0.0)


def _spread(side: Side) -> float:
    """Largest angle between any two normals along a side, radians."""
    return float(np.arccos(np.clip((side.normals @ side.normals.T).min(), -1.0, 1.0)))


def curves(sheets: Sequence[Sheet]) -> tuple[Array, IntArray]:
    """All sides of all panels, (s, q, 3), and (s, 2) the panel and side that each is."""
    owners = [(panel, side) for panel, one in enumerate(sheets) for side in range(len(one.sides))]
    lines = np.array([sheets[panel].sides[side].points for panel, side in owners])
    return lines, np.array(owners, dtype=np.intp).reshape(-1, 2)
