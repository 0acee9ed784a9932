"""Returns stand where the walls stood, are as long as asked, and lie flat by their bend allowance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.returns import SIDES, ReturnRule, foldable_sides, leg_behind, tangent_length, with_returns
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.sheet_checks import SkinSide, check_buildable, sheet_depth
from cadpanel.geometry.unroll import neutral_offset, unroll
from tests.joined import leaning
from tests.shapes import CHAINS, folded_panel, random_panel

RULE = ReturnRule(length=35.0, inner_radius=4.0)
BOTH: list[SkinSide] = ["outer", "inner"]


@pytest.mark.parametrize("skin_side", BOTH)
@pytest.mark.parametrize("lean", [0.0, 0.15, -0.1])
@pytest.mark.parametrize("chain", ["plane", "plane-cone-plane"])
def test_the_outer_face_of_a_leg_lies_in_the_plane_in_which_the_wall_stood(
    chain: str, lean: float, skin_side: SkinSide
) -> None:
    depth, outer = sheet_depth(3.0, skin_side), 0.0 if skin_side == "outer" else 3.0
    panel = random_panel(2, chain=chain)
    shape = panel.cut_back({side: leaning(panel, side, 8.0, lean) for side in SIDES}, depth)
    made = with_returns(shape, SIDES, RULE, 3.0, skin_side)
    check_buildable(made, 3.0, skin_side)
    was, now = shape.offset(outer), made.offset(outer)
    for place, outward in ((0, -1.0), (1, 1.0)):
        leans = shape.normals[-place] + shape.side_leans[place] * shape.binormals()[-place]
        wall = np.cross(shape.directions[-place], leans)
        wall *= outward / np.linalg.norm(wall) * np.sign(wall @ shape.binormals()[-place])
        legs = now.corners()[:, :2] if place == 0 else now.corners()[:, -2:]
        assert np.abs((legs - was.points[-place]) @ wall).max() < 1e-9
        assert np.abs(now.normals[-place] - wall).max() < 1e-12
        # The leg's edge is as far from the outermost line as asked, square to it.
        way = now.points[-place] - was.points[-place]
        along = way @ shape.directions[-place]
        assert math.sqrt(way @ way - along**2) == pytest.approx(RULE.length, abs=1e-9)
        inner = made.patches[-2 if place else 1]
        assert inner.kind == "cylinder"


def test_the_flat_pattern_grows_by_legs_and_bend_allowances() -> None:
    for skin_side in BOTH:
        shape = folded_panel(chain="p", widths=(500.0,), turns=(0.0,))
        made = with_returns(shape, SIDES, RULE, 3.0, skin_side)
        for k_factor in (0.33, 0.5):
            (size,) = flat_sizes([unroll(made, neutral_offset(made, 3.0, skin_side, k_factor))])
            allowance = 0.5 * math.pi * (4.0 + k_factor * 3.0)
            assert size.edges["end 0"] == pytest.approx(500.0 - 4.0 * 7.0 + 2.0 * (35.0 + allowance), abs=1e-9)


@pytest.mark.parametrize("chain", sorted(CHAINS))
def test_only_flat_sides_are_folded(chain: str) -> None:
    shape = random_panel(1, chain=chain)
    kinds = CHAINS[chain]
    flat = tuple(side for side, kind in zip(SIDES, (kinds[0], kinds[-1]), strict=True) if kind == "p")
    assert foldable_sides(shape) == flat
    made = with_returns(shape, foldable_sides(shape), RULE, 3.0, "outer")
    assert isinstance(made, PanelShape)
    assert len(made.patches) == len(kinds) + 2 * len(foldable_sides(shape))


def test_a_leg_of_which_nothing_is_left_is_refused_with_the_length_that_would_do() -> None:
    shape = folded_panel(chain="p", widths=(500.0,), turns=(0.0,))
    assert tangent_length(RULE, 3.0, 0.5 * math.pi) == pytest.approx(7.0)
    with pytest.raises(PanelError, match="leaves 2 mm behind its fold at side 1; ask for one of at least 10 mm"):
        with_returns(shape, ["side 1"], ReturnRule(length=9.0, inner_radius=4.0), 3.0, "outer")
    with pytest.raises(PanelError, match="leaves 0 mm behind its fold at side 1; ask for one of at least 10 mm"):
        with_returns(shape, ["side 1"], ReturnRule(length=6.0, inner_radius=4.0), 3.0, "outer")
    with_returns(shape, ["side 1"], ReturnRule(length=10.0, inner_radius=4.0), 3.0, "outer")
    # As much as the sheet is thick is enough.
    assert leg_behind("N-01", "side 1", ReturnRule(length=10.0, inner_radius=4.0), 3.0, 7.0) == 3.0
