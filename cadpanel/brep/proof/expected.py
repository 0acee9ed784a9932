"""What the files of a delivery must hold: the numbers that the proof is told. Millimetres."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.flat_checks import ExpectedFlat
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import SkinSide

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
class Sheet:
    """What a sheet is built from: the panel, its thickness in mm, and the side of the sheet on which the skin is."""

    shape: Panel
    thickness: float
    skin_side: SkinSide


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
        placed: where the origin of its coordinates lies in both files, mm.
        sheet: what both files hold of it, to be built anew; None to leave that alone.

    Corners come in rows: along end 0 and end 1 of a chain, or round a polygon.
    """

    name: str
    volume: float
    kinds: tuple[PatchKind, ...]
    corners: Array
    far_planes: Array = field(default_factory=lambda: np.empty((0, 2, 3)))
    fitted: Fitted | None = None
    flat: ExpectedFlat | None = None
    placed: tuple[float, float, float] = (0.0, 0.0, 0.0)
    sheet: Sheet | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedSeam:
    """Two edges that face each other.

    Attributes:
        panels: names of the two panels.
        edges: which edge of each, for example "end 1" or "side 0".
        gap: the gap along the whole seam that the report states, mm; None to measure only.
        across: (3,) a way across the joint, from the first panel to the second: that between them lies a layer of space
            square to it is then seen in the files; None where only the walls tell.
        clear: the least and the largest clear width of the joint that the report states, mm; None to measure only.
    """

    panels: tuple[str, str]
    edges: tuple[str, str]
    gap: float | None = None
    across: Array | None = None
    clear: tuple[float, float] | None = None

    @property
    def called(self) -> str:
        """As sentences call it."""
        return f"Seam '{self.panels[0]}' to '{self.panels[1]}'"
