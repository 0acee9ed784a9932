"""Flat panels with folded edges as panels: their skins, parallel skins and areas. Millimetres and radians."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.panel import CutPlane, Panel, PanelEdge, Straightened
from cadpanel.geometry.patches import ConePatch, Patch, PlanePatch
from cadpanel.geometry.returns import ReturnRule
from cadpanel.geometry.sheet_checks import SkinSide, sheet_depth
from cadpanel.geometry.tray_plan import Bed, TrayPlan, foldable, plan_tray
from cadpanel.geometry.vectors import cross

ROUND_A_CHAIN = ("end 0", "side 1", "end 1", "side 0")


@dataclass(frozen=True, slots=True, kw_only=True)
class TrayShape:
    """A flat panel with folded edges.

    Attributes:
        flat: the panel before it was folded: its corners are where the planes of its walls meet.
        returns: names of the edges that are folded.
        plan: where everything lies on the skin.
        lift: of this parallel skin, mm along the normals.
    """

    flat: Panel
    returns: tuple[str, ...]
    plan: TrayPlan
    lift: float = 0.0

    def __repr__(self) -> str:
        return f"<TrayShape '{self.name}': {self.feature}, {len(self.returns)} returns>"

    @property
    def name(self) -> str:
        """The panel's stable name."""
        return self.flat.name

    @property
    def feature(self) -> str:
        """Name of its shape feature."""
        return self.flat.feature

    @property
    def square(self) -> bool:
        """Its walls stand square to its sheet."""
        return True

    @property
    def four_sided(self) -> bool:
        """Whether it has two ends and two sides."""
        return self.flat.four_sided

    @property
    def edges(self) -> tuple[str, ...]:
        """Names of its edges, counterclockwise."""
        return edges_round(self.flat)

    @property
    def radius(self) -> float:
        """Of its folds on this skin, mm."""
        return self.plan.radius + self.lift

    @property
    def patches(self) -> tuple[Patch, ...]:
        """Its flat part, and of each fold a cylinder and the plane of the leg."""
        found: list[Patch] = [PlanePatch()]
        for edge in np.flatnonzero(self.plan.folded).tolist():
            sweep = float(self.plan.angles[edge])
            found += [ConePatch(radius=self.radius, half_angle=0.0, sweep=sweep, kind="cylinder"), PlanePatch()]
        return tuple(found)

    def corners(self) -> Array:
        """Where the planes of its walls meet on this skin, mm, in rows as before it was folded."""
        return self.flat.corners()

    def vertices(self) -> Array:
        """(v, 3) where the edges of this skin's faces meet, mm."""
        plan, lift, folded = self.plan, self.lift * self.plan.normal, self.plan.folded
        ends = np.concatenate([plan.starts, plan.stops])
        bent = ends + np.tile(plan.radius * (plan.away - plan.normal), (2, 1))
        tips = bent + np.tile(plan.legs[:, None] * plan.onwards, (2, 1))
        chosen, away = np.tile(folded, 2), np.tile(self.lift * plan.away, (2, 1))
        met = np.concatenate([(plan.reliefs > 0.0), np.ones(len(folded), dtype=bool)])
        return np.concatenate([(ends + lift)[met], (bent + away)[chosen], (tips + away)[chosen]])

    def surfaces(self) -> tuple[Array, Array]:
        """Of each face of this skin a point and the axis or normal, (f, 3) each; in the order of its patches."""
        plan, at = self.plan, np.flatnonzero(self.plan.folded)
        bent = plan.starts + plan.radius * (plan.away - plan.normal) + self.lift * plan.away
        axes = plan.starts - plan.radius * plan.normal
        points, ways = [plan.corners[0] + self.lift * plan.normal], [plan.normal]
        for edge in at.tolist():
            points += [axes[edge], bent[edge]]
            ways += [plan.along[edge], plan.away[edge]]
        return np.array(points), np.array(ways)

    def wall(self, edge: str) -> tuple[Array, Array]:
        """A point (3,) on and the normal of the plane in which the outermost face at an edge stands.

        Raises:
            ValueError: the panel has no such edge.
        """
        place = self.edges.index(edge)
        return self.plan.wall_points[place], self.plan.walls[place]

    def rulings(self) -> tuple[Array, Array, Array]:
        """Those of its flat part."""
        return self.flat.rulings()

    def cuts(self) -> tuple[Array, Array]:
        """Those of its flat part."""
        return self.flat.cuts()

    def area(self) -> float:
        """Area of this skin, mm2."""
        plan = self.plan
        first = plan.corners - plan.corners[0]
        flat = 0.5 * float((cross(first, np.roll(first, -1, axis=0)) @ plan.normal).sum())
        reliefs = 0.5 * float((plan.reliefs**2 * plan.openings).sum())
        strips = plan.lengths * (self.radius * plan.angles + plan.legs)
        return flat - reliefs + float(strips[plan.folded].sum())

    def offset(self, distance: float) -> TrayShape:
        """The parallel skin."""
        return replace(self, flat=self.flat.offset(distance), lift=self.lift + distance)

    def edge(self, edge: str) -> PanelEdge:
        """What is left of an edge between reliefs, where the flat part ends; see `Panel.edge`."""
        if edge not in self.edges:
            raise ValueError(f"panel '{self.name}' has no edge '{edge}'")
        plan, place = self.plan, self.edges.index(edge)
        corners = np.stack([plan.starts[place], plan.stops[place]]) + self.lift * plan.normal
        return PanelEdge(corners=corners, outward=plan.outward[place], normal=plan.normal)

    def arcs(self) -> CurvePieces:
        """Those before it was folded: none."""
        return self.flat.arcs()

    def cut_back(self, planes: Mapping[str, CutPlane], depth: float) -> TrayShape:  # noqa: ARG002 - see `Panel`
        """Not to be had: panels are cut before they are folded.

        Raises:
            PanelError: always.
        """
        raise PanelError(self.name, "it is folded already and cannot be cut back; cut it first.")

    def squared(self, depth: float) -> TrayShape:  # noqa: ARG002 - see `Panel`
        """The panel itself."""
        return self

    def straightened(self) -> Straightened[TrayShape]:
        """The panel itself: it has no cones."""
        return Straightened(shape=self, patches=(), largest_move=0.0)

    def check(self) -> None:
        """See `Panel.check`: its flat part is checked; what is folded was when it was."""
        self.flat.check()

    def check_sheet(self, away: TrayShape, thickness: float) -> None:
        """See `Panel.check_sheet`: folds have an inner radius, so that any thickness will do."""


def edges_round(shape: Panel) -> tuple[str, ...]:
    """Names of a flat panel's edges, counterclockwise seen from outside."""
    return ROUND_A_CHAIN if shape.four_sided else tuple(f"edge {i}" for i in range(shape.corners().shape[1]))


def folded_tray(
    flat: Panel, returns: tuple[str, ...], rule: ReturnRule, thickness: float, skin_side: SkinSide
) -> TrayShape:
    """A flat panel with returns along some edges.

    Raises:
        PanelError: nothing is left of a leg behind its fold, or legs would meet.
    """
    folded = np.array([edge in returns for edge in edges_round(flat)])
    return TrayShape(flat=flat, returns=returns, plan=plan_tray(_bed(flat, thickness, skin_side), folded, rule))


def foldable_edges(
    flat: Panel, rule: ReturnRule, thickness: float, skin_side: SkinSide
) -> tuple[tuple[str, ...], str | None]:
    """The edges of a flat panel that are long enough for a return; and why its outline allows none.

    Raises:
        PanelError: nothing is left of a leg behind its fold, or legs would meet.
    """
    folded, why = foldable(_bed(flat, thickness, skin_side), rule)
    return tuple(edge for edge, own in zip(edges_round(flat), folded.tolist(), strict=True) if own), why


def is_flat(shape: Panel) -> bool:
    """Whether a panel is one plane with straight edges."""
    return [type(patch) for patch in shape.patches] == [PlanePatch]


def _bed(flat: Panel, thickness: float, skin_side: SkinSide) -> Bed:
    depth = sheet_depth(thickness, skin_side)
    corners = _round(flat.corners())
    _, _, normals = flat.rulings()
    return Bed(
        name=flat.name,
        corners=corners,
        posts=(_round(flat.offset(depth).corners()) - corners) / depth,
        normal=normals[0],
        thickness=thickness,
        skin_side=skin_side,
    )


def _round(rows: Array) -> Array:
    """(n, 3) corners counterclockwise, of those in rows."""
    return rows[0] if len(rows) == 1 else np.concatenate([rows[0], rows[1, ::-1]])
