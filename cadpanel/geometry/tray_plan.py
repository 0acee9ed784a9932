"""Flat panels whose edges are folded inwards: where folds begin, how far they reach, reliefs at corners. Millimetres.

The outer face of a leg lies in the plane in which the wall of its edge stood, so that joints stay as wide as they were.
The panel's flat part ends where folds begin. Where two of those lines meet, or one and an edge that is not folded, a
round relief about that point ends the folds on either side of it square to them; its radius is that of the sheet's
thickness, or what keeps legs as far from each other as the sheet is thick, and within the walls beside them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.errors import PanelError
from cadpanel.geometry.polygon_cutting import NEARLY_STRAIGHT
from cadpanel.geometry.returns import ReturnRule, leg_behind, tangent_length
from cadpanel.geometry.sheet_checks import SkinSide, sheet_depth
from cadpanel.geometry.vectors import cross, dot, unit


@dataclass(frozen=True, slots=True, kw_only=True)
class Bed:
    """A flat panel before its edges are folded.

    Attributes:
        name: the panel's.
        corners: (n, 3) of the skin, counterclockwise about the normal, where the planes of its walls meet.
        posts: (n, 3) by how much each moves for one mm along the normal, as walls lean.
        normal: (3,) unit, outward.
        thickness: of the sheet, mm.
        skin_side: "outer" where the sheet lies inside of the skin.
    """

    name: str
    corners: Array
    posts: Array
    normal: Array
    thickness: float
    skin_side: SkinSide

    @property
    def outer(self) -> float:
        """Where the outer face lies, mm along the normal from the skin."""
        return 0.0 if self.skin_side == "outer" else self.thickness

    @property
    def along(self) -> Array:
        """(n, 3) unit directions of the edges."""
        return unit(np.roll(self.corners, -1, axis=0) - self.corners)

    @property
    def outward(self) -> Array:
        """(n, 3) unit, out of each edge, in the panel's plane."""
        return cross(self.along, self.normal[None])

    @property
    def leans(self) -> Array:
        """(n,) how far each wall leans out for one mm along the normal."""
        return dot(self.posts, self.outward)

    @property
    def walls(self) -> Array:
        """(n, 3) unit normals of the planes of the walls, out of the sheet."""
        return unit(self.outward - self.leans[:, None] * self.normal)

    @property
    def outer_corners(self) -> Array:
        """(n, 3) corners of the outer face."""
        return np.asarray(self.corners + self.outer * self.posts)

    @property
    def turns(self) -> Array:
        """(n,) angles by which the outline turns at each corner; all are positive where it is convex."""
        before = np.roll(self.along, 1, axis=0)
        return np.arctan2(dot(cross(before, self.along), self.normal[None]), dot(before, self.along))


@dataclass(frozen=True, slots=True, kw_only=True)
class TrayPlan:
    """Where a folded panel's parts lie on its skin.

    Attributes:
        normal: (3,) of its flat part.
        along, outward: (n, 3) unit directions of its edges, and out of each.
        corners: (n, 3) where the lines meet at which folds begin, or edges stand that are not folded, mm.
        reliefs: (n,) radii about them; 0 where there is none.
        openings: (n,) inner angles at corners, radians.
        folded: (n,) which edges are.
        angles: (n,) by which they are folded, radians.
        legs: (n,) lengths of the flat parts of the legs, mm.
        radius: of folds on the skin, mm.
        wall_points, walls: (n, 3) a point on and the normal of the plane in which each edge's outermost face stands.
    """

    normal: Array
    along: Array
    outward: Array
    corners: Array
    reliefs: Array
    openings: Array
    folded: BoolArray
    angles: Array
    legs: Array
    radius: float
    wall_points: Array
    walls: Array

    @property
    def starts(self) -> Array:
        """(n, 3) where each edge begins behind its relief."""
        return np.asarray(self.corners + self.reliefs[:, None] * self.along)

    @property
    def stops(self) -> Array:
        """(n, 3) where each edge ends before the next relief."""
        return np.asarray(
            np.roll(self.corners, -1, axis=0) - np.roll(self.reliefs, -1)[:, None] * self.along,
        )

    @property
    def lengths(self) -> Array:
        """(n,) of the edges between reliefs, mm."""
        return dot(self.stops - self.starts, self.along)

    @property
    def seams(self) -> int:
        """Straight edges of a sheet at which two faces are tangent: along folds on both faces, and at their ends."""
        return 8 * int(self.folded.sum())

    @property
    def wall_kinds(self) -> tuple[str, ...]:
        """Kinds of the walls of a sheet: five at each fold, one at each other edge, and those of reliefs."""
        folds, reliefs = int(self.folded.sum()), int((self.reliefs > 0.0).sum())
        return (len(self.folded) + 4 * folds) * ("plane",) + reliefs * ("cylinder",)

    @property
    def away(self) -> Array:
        """(n, 3) normals of the legs, out of the building."""
        return np.asarray(np.sin(self.angles)[:, None] * self.outward + np.cos(self.angles)[:, None] * self.normal)

    @property
    def onwards(self) -> Array:
        """(n, 3) ways from the folds to the edges of the legs."""
        return np.asarray(np.cos(self.angles)[:, None] * self.outward - np.sin(self.angles)[:, None] * self.normal)


def plan_tray(bed: Bed, folded: BoolArray, rule: ReturnRule) -> TrayPlan:
    """Where everything lies when these edges (n,) are folded; the outline must be convex.

    Raises:
        PanelError: nothing is left of a leg behind its fold, or legs of opposite edges would meet.
    """
    angles = 0.5 * math.pi + np.arctan(bed.leans)
    radius = rule.inner_radius + bed.thickness
    reach = np.array([tangent_length(rule, bed.thickness, angle) for angle in angles.tolist()])
    for edge in np.flatnonzero(folded).tolist():
        leg_behind(bed.name, f"edge {edge}", rule, bed.thickness, float(reach[edge]))
    legs = rule.length - reach
    # An edge that is not folded stands square to the sheet, where the shorter of its two faces ends.
    depth = sheet_depth(bed.thickness, bed.skin_side)
    levels = dot(bed.corners, bed.outward)
    square = levels + np.minimum(0.0, depth * bed.leans)
    level = np.where(folded, levels + bed.outer * bed.leans - reach, square)
    corners = _meetings(bed, level)
    reliefs = _reliefs(bed, folded, corners, _profiles(bed, angles, reach, legs, radius))
    plan = TrayPlan(
        normal=bed.normal,
        along=bed.along,
        outward=bed.outward,
        corners=corners,
        reliefs=reliefs,
        openings=math.pi - bed.turns,
        folded=folded,
        angles=angles,
        legs=legs,
        radius=radius - bed.outer,
        wall_points=np.where(folded[:, None], bed.outer_corners, corners),
        walls=np.where(folded[:, None], bed.walls, bed.outward),
    )
    _check_opposite(bed, plan)
    return plan


def foldable(bed: Bed, rule: ReturnRule) -> tuple[BoolArray, str | None]:
    """(n,) which edges keep at least as much length as their legs are long; and why the outline allows none.

    Raises:
        PanelError: nothing is left of a leg behind its fold.
    """
    folded = np.ones(len(bed.corners), dtype=bool)
    if bed.turns.min() < NEARLY_STRAIGHT:
        corner = int(bed.turns.argmin())
        return ~folded, f"its outline does not turn inwards clearly at corner {corner}"
    while folded.any():
        lengths = plan_tray(bed, folded, rule).lengths
        short = np.asarray(lengths < np.where(folded, rule.length, 0.0))
        if not short.any():
            break
        if not (short & folded).any():
            return np.zeros_like(folded), "nothing is left of an edge between the reliefs beside it"
        folded = folded & ~short
    return folded, None


def _meetings(bed: Bed, level: Array) -> Array:
    """(n, 3) where the lines of neighbouring edges meet: each is told by its way out and how far it stands."""
    before, after = np.roll(bed.outward, 1, axis=0), bed.outward
    system = np.stack([before, after, np.broadcast_to(bed.normal, before.shape)], axis=1)
    sides = np.stack([np.roll(level, 1), level, dot(bed.corners, bed.normal[None])], axis=-1)
    return np.asarray(np.linalg.solve(system, sides[..., None])[..., 0])


def _profiles(bed: Bed, angles: Array, reach: Array, legs: Array, radius: float) -> Array:
    """(n, 7, 3) the corners of a fold and its leg in cross section, from the outermost line of each edge."""
    sine, cosine = np.sin(angles), np.cos(angles)
    away, onwards = np.stack([sine, cosine], axis=-1), np.stack([cosine, -sine], axis=-1)
    begin = np.stack([-reach, np.zeros_like(reach)], axis=-1)
    bent = begin - [0.0, radius] + radius * away
    tip = bent + legs[:, None] * onwards
    inside = [begin - [0.0, bed.thickness], bent - bed.thickness * away, tip - bed.thickness * away]
    places = np.stack([begin, bent, tip, *inside, np.zeros_like(begin)], axis=1)
    return np.asarray(places[..., :1] * bed.outward[:, None] + places[..., 1:] * bed.normal)


def _reliefs(bed: Bed, folded: BoolArray, corners: Array, profiles: Array) -> Array:
    """(n,) the radius at every corner at which a fold ends."""
    outermost, walls = bed.outer_corners, bed.walls
    radii = np.zeros(len(corners))
    own = np.arange(len(corners))
    following, before = np.roll(own, -1), np.roll(own, 1)
    # The edge beside each where it ends, or begins; the corner between them; the way there.
    for other, place, way in ((following, following, bed.along), (before, own, -bed.along)):
        beside = walls[other]
        ahead_of = np.where(folded[other][:, None], beside - walls, beside)
        apart = 0.5 * bed.thickness * np.linalg.norm(walls - beside, axis=-1) * folded[other]
        needed = (apart + np.einsum("npx,nx->np", profiles, ahead_of).max(axis=1)) / dot(beside, way)
        radius = np.maximum(bed.thickness, dot(corners[place] - outermost[place], way) + needed)
        np.maximum.at(radii, place, np.where(folded, radius, 0.0))
    return radii


def _check_opposite(bed: Bed, plan: TrayPlan) -> None:
    """Refuse legs that reach those of edges that are not beside theirs."""
    count = len(plan.corners)
    tips = [
        (plan.starts, plan.stops)[end] + plan.radius * (plan.away - plan.normal) + plan.legs[:, None] * plan.onwards
        for end in (0, 1)
    ]
    points = np.stack([tip + depth * plan.away for tip in tips for depth in (bed.outer, bed.outer - bed.thickness)])
    for one in np.flatnonzero(plan.folded).tolist():
        for other in np.flatnonzero(plan.folded).tolist():
            if (one - other) % count in (0, 1, count - 1):
                continue
            behind = -((points[:, one] - plan.wall_points[other]) @ plan.walls[other]).max()
            if behind < 2.0 * bed.thickness:
                raise PanelError(
                    bed.name,
                    f"its returns along edges {one} and {other} would meet inside of it; ask for shorter ones.",
                )
