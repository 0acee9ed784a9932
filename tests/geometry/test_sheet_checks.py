"""On which side of a sheet its skin is, told by where the other face lies and back."""

import pytest

from cadpanel.geometry.limits import THICKEST_SHEET, THINNEST_SHEET
from cadpanel.geometry.sheet_checks import SkinSide, sheet_depth, skin_side_of

BOTH: list[SkinSide] = ["outer", "inner"]


@pytest.mark.parametrize("skin_side", BOTH)
@pytest.mark.parametrize("thickness", [THINNEST_SHEET, 0.2, 3.0, THICKEST_SHEET])
def test_the_side_of_the_skin_is_found_again_from_the_depth_however_thin_the_sheet(thickness, skin_side):
    depth = sheet_depth(thickness, skin_side)
    assert abs(depth) == thickness
    assert skin_side_of(depth) == skin_side
