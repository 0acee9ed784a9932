"""How wide the joints are that stand between the sheets in a file, along whole seams. Millimetres.

Both walls at a seam are planes. The clear width is measured square to either wall, from every point of the other one's
outline: along both faces of the sheet, and up and down its corners. It is linear on a wall, so it is least and largest
on the outline, and an arc of ellipse is extreme where a formula says; other edges are followed point by point. Where
two walls are not parallel, as where the sides of cones run along rulings, a corner of one may lie where the other has
ended: the joint is at least as wide as the space between two parallel planes that part the walls. Square ends that bend
have no one plane: there the width is measured along the way across the joint, at least and at most between any place of
the one wall and any of the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.proof.edge_pieces import edge_pieces
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.sampled_curves import POINTS, reach
from cadpanel.geometry.shape import edge_corners
from cadpanel.geometry.vectors import unit

CLEAR_LIMIT = 1e-6
"""How much narrower than asked a joint may be, and how far from what is stated, mm."""
DIGITS = 9
"""Of a width in mm that are told: those behind them are rounding's."""


@dataclass(frozen=True, slots=True)
class Clear:
    """The least and the largest clear width along a seam, mm, to DIGITS digits."""

    least: float
    largest: float


@dataclass(frozen=True, slots=True)
class _Wall:
    """A wall: a point on its plane, its unit normal out of the sheet, and its outline.

    One that stands in no one plane has neither point nor normal, and edges that are no lines or arcs, (o, q, 3) points.
    """

    outline: CurvePieces
    point: Array | None = None
    normal: Array | None = None
    others: Array = field(default_factory=lambda: np.empty((0, POINTS, 3)))

    def reach(self, ways: Array) -> tuple[Array, Array]:
        """(d,) least and greatest inner product of its points with ways (d, 3)."""
        (least, greatest), others = self.outline.reach(ways), reach(self.others, ways)
        return (
            np.minimum(least.min(axis=1), others[0].min(axis=1, initial=np.inf)),
            np.maximum(greatest.max(axis=1), others[1].max(axis=1, initial=-np.inf)),
        )


def clearances(
    panels: Iterable[ExpectedPanel],
    solid_of: dict[str, ShapeFacts],
    seams: Sequence[ExpectedSeam],
    joint: float,
    failures: list[str],
) -> list[Clear | None]:
    """The clear width of each seam's joint, None where it has no two walls; what is not as asked or stated fails."""
    expected = {panel.name: panel for panel in panels}
    found: list[Clear | None] = []
    for seam in seams:
        walls = [
            _wall(solid_of[name], expected[name], edge) if name in solid_of and name in expected else None
            for name, edge in zip(seam.panels, seam.edges, strict=True)
        ]
        first, second = walls
        if first is None or second is None:
            failures.append(f"{seam.called}: a wall of the sheets cannot be found.")
            found.append(None)
            continue
        clear = _between(first, second, seam.across)
        if clear is None:
            failures.append(f"{seam.called}: nothing says across which way its joint is measured.")
            found.append(None)
            continue
        found.append(clear)
        failures += _faults(seam, clear, joint if seam.joint is None else seam.joint)
    return found


def _faults(seam: ExpectedSeam, clear: Clear, joint: float) -> list[str]:
    if not clear.least >= joint - CLEAR_LIMIT:
        return [f"{seam.called}: the joint is only {clear.least:.6g} mm wide, {joint:g} mm were asked for."]
    if seam.clear is None:
        return []
    off = max(abs(clear.least - seam.clear[0]), abs(clear.largest - seam.clear[1]))
    if off <= CLEAR_LIMIT:
        return []
    return [
        f"{seam.called}: the joint is {clear.least:.6g} to {clear.largest:.6g} mm wide, {seam.clear[0]:.6g} to "
        f"{seam.clear[1]:.6g} mm are stated."
    ]


def _wall(solid: ShapeFacts, panel: ExpectedPanel, edge: str) -> _Wall | None:
    """The face of a sheet at one edge: of the planes on which all of the edge lies, the one that leaves the skin."""
    standing = _standing(panel, edge)
    if standing is not None:
        return _wall_in(solid, *standing)
    corners = panel.corners
    if panel.side_plane(edge) is not None:
        return _wall_at_side(solid, edge_corners(corners, edge))
    chosen = edge_pieces(solid, corners, edge)
    if chosen is None:
        return None
    if panel.square and edge.startswith("end") and set(panel.kinds) != {"plane"}:
        return _walls_of_pieces(solid, corners, chosen)
    shared = set.intersection(*(set(faces) for faces in solid.piece_faces[chosen].tolist())) - {-1}
    flat = [face for face in shared if solid.surfaces[face, 6] == 0.0]
    if not flat:
        return None
    bounds = [solid.bounds(face) for face in flat]
    leaves = [_farthest(solid.piece_ends[own].reshape(-1, 3), corners.reshape(-1, 3)) for own in bounds]
    place = int(np.argmax(leaves))
    surface = solid.surfaces[flat[place]]
    return _Wall(solid.pieces.take(bounds[place]), surface[:3], surface[8] * surface[3:6])


def _standing(panel: ExpectedPanel, edge: str) -> tuple[Array, Array] | None:
    """A point on and the normal of the plane in which a wall stands by the panel's numbers; None where none does.

    That is the outer face of a return, or the wall at a side that follows no ruling.
    """
    if panel.tray is not None:
        return panel.tray.wall(edge)
    plane = panel.side_plane(edge)
    if plane is not None and not panel.square:
        return plane.point, plane.normal
    if panel.sheet is None or not edge.startswith("side") or not panel.folded[int(edge[-1])]:
        return None
    outer = panel.sheet.shape.offset(0.0 if panel.sheet.skin_side == "outer" else panel.sheet.thickness)
    points, _, normals = outer.rulings()
    return points[-int(edge[-1])], normals[-int(edge[-1])]


def _wall_in(solid: ShapeFacts, point: Array, normal: Array) -> _Wall | None:
    """The face of a sheet that stands in a plane and looks along its normal."""
    flat = np.flatnonzero(solid.surfaces[:, 6] == 0.0)
    normals = solid.surfaces[flat, 8:9] * solid.surfaces[flat, 3:6]
    off = np.abs((solid.surfaces[flat, :3] - point) @ normal)
    there = flat[(off <= CLEAR_LIMIT) & (np.linalg.norm(normals - normal, axis=-1) <= CLEAR_LIMIT)]
    if not len(there):
        return None
    own = np.any([solid.bounds(face) for face in there], axis=0)
    others = solid.other_points[np.isin(solid.other_edges, there).any(axis=1)]
    return _Wall(solid.pieces.take(own), point, normal, others)


def _wall_at_side(solid: ShapeFacts, corners: Array) -> _Wall | None:
    """The wall of normals at a side that is neither a line nor an arc, from corner (2, 3) to corner."""
    ends = solid.other_points[:, [0, -1]]
    off = np.minimum(*(np.abs(ends - row).max(axis=(1, 2), initial=0.0) for row in (corners, corners[::-1])))
    if not len(off) or off.min() > CLEAR_LIMIT:
        return None
    walls = [face for face in solid.other_edges[int(off.argmin())].tolist() if np.isnan(solid.surfaces[face, 6])]
    own = np.asarray(np.isin(solid.piece_faces, walls).any(axis=1))
    return _Wall(solid.pieces.take(own), others=solid.other_points[np.isin(solid.other_edges, walls).any(axis=1)])


def _walls_of_pieces(solid: ShapeFacts, corners: Array, chosen: IntArray) -> _Wall:
    """The faces at an edge of several pieces: of both at each piece the one that leaves the skin."""
    flat = corners.reshape(-1, 3)
    faces = []
    for pair in solid.piece_faces[chosen].tolist():
        leaves = [_farthest(solid.piece_ends[solid.bounds(face)].reshape(-1, 3), flat) for face in pair]
        faces.append(pair[int(np.argmax(leaves))])
    own = np.asarray(np.isin(solid.piece_faces, faces).any(axis=1))
    others = solid.other_points[np.isin(solid.other_edges, faces).any(axis=1)]
    return _Wall(solid.pieces.take(own), others=others)


def _farthest(points: Array, corners: Array) -> float:
    """How far the farthest point is from the corner that is nearest to it."""
    return float(np.linalg.norm(points[:, None] - corners, axis=-1).min(axis=1).max())


def _between(one: _Wall, other: _Wall, across: Array | None) -> Clear | None:
    if one.normal is None or other.normal is None:
        if across is None:
            return None
        way = unit(across)[None]
        ahead, behind = other.reach(way), one.reach(way)
        return _told(float(ahead[0][0] - behind[1][0]), float(ahead[1][0] - behind[0][0]))
    widths = [_beyond(one, other), _beyond(other, one)]
    halfway = unit(one.normal - other.normal)
    ways = np.stack([halfway, halfway if across is None else unit(across)])
    between = other.reach(ways)[0] - one.reach(ways)[1]
    least = max(float(between.max()), min(least for least, _ in widths))
    largest = max(largest for _, largest in widths)
    return _told(least, largest)


def _told(least: float, largest: float) -> Clear:
    return Clear(round(least, DIGITS) + 0.0, round(largest, DIGITS) + 0.0)


def _beyond(wall: _Wall, other: _Wall) -> tuple[float, float]:
    """How far the outline of another wall lies beyond a wall's plane, at least and at most."""
    assert wall.normal is not None
    assert wall.point is not None
    least, greatest = other.reach(wall.normal[None])
    level = float(wall.normal @ wall.point)
    return float(least[0]) - level, float(greatest[0]) - level
