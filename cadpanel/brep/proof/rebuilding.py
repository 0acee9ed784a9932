"""The sheets that a report's numbers make, built anew to be held against those in the files."""

from __future__ import annotations

from collections.abc import Iterable

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.proof.inspection import boundary_of
from cadpanel.brep.proof.rebuilt import Rebuilt
from cadpanel.errors import PanelError


def rebuild(sheets: Iterable[Sheet]) -> list[Rebuilt | PanelError]:
    """The boundaries of sheets and of their skins; why there is none where the numbers make none."""
    found: list[Rebuilt | PanelError] = []
    for sheet in sheets:
        try:
            built = build_panel(sheet.shape, sheet.thickness, sheet.skin_side, sheet.holes)
        except PanelError as error:
            found.append(error)
        else:
            found.append(Rebuilt(solid=boundary_of(built.solid), skin=boundary_of(built.skin)))
    return found
