"""Folded flat panels as exact solids: valid, closed, as large as formulas say, with walls and folds of known kinds."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.proof.inspection import inspect
from cadpanel.geometry.kink import edge_angles
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.geometry.volume import sheet_volume
from tests.trays import THICKNESS, tray


@pytest.mark.parametrize("skin_side", ["outer", "inner"])
@pytest.mark.parametrize("edges", [None, ("edge 1",), ("edge 0", "edge 2"), ("edge 3", "edge 0")])
def test_solids_and_skins_are_exact(skin_side: SkinSide, edges: tuple[str, ...] | None) -> None:
    shape = tray(skin_side=skin_side, edges=edges)
    built = build_panel(shape, THICKNESS, skin_side)
    solid, skin = inspect("solid", built.solid), inspect("skin", built.skin)
    assert solid.valid
    assert solid.closed
    assert skin.valid
    assert solid.volume == pytest.approx(sheet_volume(shape, THICKNESS, skin_side), rel=1e-12)
    assert skin.areas.sum() == pytest.approx(shape.area(), rel=1e-12)
    kinds = Counter(patch.kind for patch in shape.patches)
    assert +Counter(skin.face_kinds) == kinds
    assert +Counter(solid.face_kinds) == kinds + kinds + Counter(shape.plan.wall_kinds)
    smooth = edge_angles(solid.straight_edges, solid.edge_surfaces)
    assert int((smooth < 1e-9).sum()) == int((smooth < 0.1).sum()) == shape.plan.seams
    apart = np.linalg.norm(skin.vertices[:, None] - shape.vertices(), axis=-1)
    assert len(skin.vertices) == len(shape.vertices())
    assert apart.min(axis=1).max() < 1e-9
