"""What the files of a delivery must hold: the numbers that the proof is told. Millimetres."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.proof.flat_checks import ExpectedFlat
from cadpanel.brep.proof.hole_checks import ExpectedHoles
from cadpanel.brep.step.properties import PartData
from cadpanel.geometry.panel import CutPlane
from cadpanel.geometry.plane_sides import planes_of
from cadpanel.geometry.trays import TrayShape

PatchKind = Literal["plane", "cone", "cylinder"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """A panel before it was cut back from its seams.

    Attributes:
        corners: in rows, as the panel's own, mm.
        cuts: (2, 2, 3) a point on and the normal of the planes that cut its ends; (0, 2, 3) of a polygon.
    """

    corners: Array
    cuts: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedPanel:
    """What a panel in the files must be.

    Attributes:
        name: its product name in both files.
        volume: analytic volume of the sheet, mm3.
        kinds: kinds of its patches in the order of the walk, as built.
        corners: (2, k + 1, 3) corners of the skin at end 0 and end 1, or (1, n, 3) those of a polygon, mm.
        far_planes: (m, 2, 3) a point on and the normal of the plane in which each flat patch's far face must lie, mm.
        fitted: the panel before it was cut back; None where it was not.
        flat: what its flat pattern says; None to leave it alone.
        said, said_of_skin: what either file must say of it besides; None to leave that alone.
        placed: where the origin of its coordinates lies in both files, mm.
        square: whether the walls of its sheet stand square to it; at the ends of round patches they are neither planes
            nor round then.
        holes: through its sheet; None where it has none.
        folded: patches beyond the fit's at side 0 and at side 1: those of returns.
        tray: where it is a flat panel with folded edges, the panel; its kinds are those of all its faces, its corners
            where the planes of its walls meet.
        sheet: what both files hold of it, to be built anew; None where the caller has no numbers for that.

    Corners come in rows: along end 0 and end 1 of a chain, or round a polygon.
    """

    name: str
    volume: float
    kinds: tuple[PatchKind, ...]
    corners: Array
    far_planes: Array = field(default_factory=lambda: np.empty((0, 2, 3)))
    fitted: Fitted | None = None
    flat: ExpectedFlat | None = None
    said: PartData | None = None
    said_of_skin: PartData | None = None
    placed: tuple[float, float, float] = (0.0, 0.0, 0.0)
    square: bool = False
    holes: ExpectedHoles | None = None
    folded: tuple[int, int] = (0, 0)
    tray: TrayShape | None = None
    sheet: Sheet | None = None

    @property
    def vertices(self) -> Array:
        """(v, 3) of its skin, mm."""
        return self.corners.reshape(-1, 3) if self.tray is None else self.tray.vertices()

    @property
    def walls(self) -> tuple[str, ...]:
        """Kinds of the walls of its sheet: two ends and two sides, or one at each edge of a polygon; and of holes."""
        return (*self._outer_walls, *(() if self.holes is None else self.holes.walls))

    @property
    def smooth_edges(self) -> int:
        """Straight edges of its solid whose two faces are tangent: between patches, and in holes."""
        own = 2 * len(self.kinds) - 2 if self.tray is None else self.tray.plan.seams
        return own + (0 if self.holes is None else self.holes.smooth_edges)

    def side_plane(self, edge: str) -> CutPlane | None:
        """The plane in which a side stands that follows no ruling; None of all other edges."""
        if self.sheet is None or not edge.startswith("side"):
            return None
        return planes_of(self.sheet.shape)[int(edge[-1])]

    @property
    def bent_sides(self) -> int:
        """How many of its sides are neither lines nor arcs of ellipses."""
        return sum(self.side_plane(side) is not None for side in ("side 0", "side 1"))

    @property
    def _outer_walls(self) -> tuple[str, ...]:
        if self.tray is not None:
            return self.tray.plan.wall_kinds
        if len(self.corners) == 1:
            return int(self.corners.shape[1]) * ("plane",)
        if not self.square:
            return 4 * ("plane",)
        ends = tuple("plane" if kind == "plane" else "other" for kind in self.kinds)
        bent = self.bent_sides
        return (*ends, *ends, *(2 - bent) * ("plane",), *bent * ("other",))


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedSeam:
    """Two edges that face each other.

    Attributes:
        panels: names of the two panels.
        edges: which edge of each, for example "end 1" or "side 0".
        gap: the gap along the whole seam that the report states, mm; None to measure only.
        across: (3,) a way across the joint, from the first panel to the second: that between them lies a layer of space
            square to it is then seen in the files; None where only the walls tell.
        joint: clear width that was asked for, mm; None where it is that of all.
        clear: the least and the largest clear width of the joint that the report states, mm; None to measure only.
    """

    panels: tuple[str, str]
    edges: tuple[str, str]
    gap: float | None = None
    across: Array | None = None
    joint: float | None = None
    clear: tuple[float, float] | None = None

    @property
    def called(self) -> str:
        """As sentences call it."""
        return f"Seam '{self.panels[0]}' to '{self.panels[1]}'"
