"""What a sheet is built from, by whichever interpreter builds it: nothing of the kernel is in it."""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.geometry.fixings import Hole
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import SkinSide


@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """What a sheet is built from: the panel, its thickness in mm, on which side of the sheet the skin is, and holes."""

    shape: Panel
    thickness: float
    skin_side: SkinSide
    holes: tuple[Hole, ...] = ()
