"""What a Python program makes of single shapes, or of several at once: flat patterns, solids and skins as they are.

Nothing is cut off them for joints, which is what tells these from the sheets of a delivery.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, overload

import numpy as np

from cadpanel.api_sheets import Panels, shapes_of
from cadpanel.fitting.result import FitResult
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.geometry.unroll import FlatPattern, neutral_offset, unroll_all
from cadpanel.kinds import checked
from cadpanel.setting import require

if TYPE_CHECKING:
    from cadpanel.brep.kernel.types import Shell, Solid


@overload
def unroll(
    shape: Panel, *, thickness: float = 3.0, skin_side: SkinSide = "outer", k_factor: float = 0.5
) -> FlatPattern: ...
@overload
def unroll(
    shape: FitResult | Sequence[Panel],
    *,
    thickness: float = 3.0,
    skin_side: SkinSide = "outer",
    k_factor: float = 0.5,
) -> list[FlatPattern]: ...
@checked
def unroll(
    shape: Panels, *, thickness: float = 3.0, skin_side: SkinSide = "outer", k_factor: float = 0.5
) -> FlatPattern | list[FlatPattern]:
    """One panel as a flat sheet seen from outside: outline, tangent lines and rulings, exactly; of several a list.

    Args:
        shape: one of a result's shapes, several, or the result; they are unrolled whole: nothing is cut off for joints.
        thickness: of the sheet, mm.
        skin_side: "outer" or "inner".
        k_factor: distance of the surface that keeps its lengths from the inner face of the bends, as a share of the
            thickness; flat panels have the middle of the sheet with 0.5.

    Raises:
        PanelError: a panel bends both ways, and the K-factor is not 0.5.
        SettingsError: the thickness, side or K-factor is none, or there is no panel in the list.
    """
    from cadpanel.delivery.settings import SheetSettings

    sheet = SheetSettings(thickness=thickness, skin_side=skin_side)
    require("K-factor", k_factor, least=0.0, most=1.0)
    shapes = shapes_of(shape)
    offsets = [neutral_offset(one, sheet.thickness, sheet.skin_side, k_factor) for one in shapes]
    found = unroll_all(shapes, np.array(offsets))
    return found if isinstance(shape, FitResult | Sequence) else found[0]


@overload
def build_solid(shape: Panel, thickness: float, skin_side: SkinSide = "outer") -> Solid: ...
@overload
def build_solid(shape: FitResult | Sequence[Panel], thickness: float, skin_side: SkinSide = "outer") -> list[Solid]: ...
@checked
def build_solid(shape: Panels, thickness: float, skin_side: SkinSide = "outer") -> Solid | list[Solid]:
    """The sheet of `thickness` mm on a panel's skin as an exact OCCT solid; of several panels a list.

    Args:
        shape: one of a result's shapes, several, or the result.
        thickness: of the sheet, mm.
        skin_side: "outer": the skin is the sheet's outer face; "inner": its inner one.

    Raises:
        PanelError: a sheet cannot be built.
        SettingsError: there is no panel in the list.
    """
    from cadpanel.brep.building.sheet import build_solid as build_one

    found = [build_one(one, thickness, skin_side) for one in shapes_of(shape)]
    return found if isinstance(shape, FitResult | Sequence) else found[0]


@overload
def build_skin(shape: Panel) -> Shell: ...
@overload
def build_skin(shape: FitResult | Sequence[Panel]) -> list[Shell]: ...
@checked
def build_skin(shape: Panels) -> Shell | list[Shell]:
    """A panel's skin as an open OCCT shell, its faces' normals outward; of several panels a list.

    Args:
        shape: one of a result's shapes, several, or the result.

    Raises:
        PanelError: a skin cannot be built.
        SettingsError: there is no panel in the list.
    """
    from cadpanel.brep.building.sheet import build_skin as build_one

    found = [build_one(one) for one in shapes_of(shape)]
    return found if isinstance(shape, FitResult | Sequence) else found[0]
