"""Sheets whose walls lean are exact solids of their formula's volume, as those with square walls are."""

from dataclasses import replace

import pytest

from tests.built import assert_written_as_it_is, check_exact
from tests.instances import random_polygon
from tests.joined import leaning
from tests.shapes import random_panel

ROUNDING = 1e-11
EDGES = ("end 0", "end 1", "side 0", "side 1")


@pytest.mark.parametrize("skin_side", ["outer", "inner"])
@pytest.mark.parametrize("chain", ["plane-cone-plane", "plane", "plane-cone-cone-plane"])
@pytest.mark.parametrize("seed", range(3))
def test_a_chain_between_leaning_walls_is_exact(seed, chain, skin_side):
    shape = random_panel(seed, chain=chain)
    cut = shape.cut_back({edge: leaning(shape, edge, 8.0, 0.1 * (i - 1), 0.01) for i, edge in enumerate(EDGES)}, -5.0)
    check_exact(cut, 5.0, skin_side, relative=ROUNDING)


@pytest.mark.parametrize("skin_side", ["outer", "inner"])
@pytest.mark.parametrize("corners", [3, 5])
def test_a_polygon_between_leaning_walls_is_exact(corners, skin_side):
    shape = random_polygon(2, corners)
    cut = shape.cut_back(
        {f"edge {i}": leaning(shape, f"edge {i}", 5.0, 0.3 - 0.1 * i) for i in range(1, corners)}, -8.0
    )
    check_exact(cut, 8.0, skin_side, relative=ROUNDING)


@pytest.mark.parametrize("skin_side", ["outer", "inner"])
@pytest.mark.parametrize("chain", ["cone", "cone-plane-cone"])
def test_a_cone_between_planes_at_its_sides_is_exact(tmp_path, chain, skin_side):
    shape = random_panel(4, chain=chain)
    planes = {f"side {side}": leaning(shape, f"side {side}", 8.0, 0.2 - 0.3 * side, 0.01) for side in (0, 1)}
    depth = -5.0 if skin_side == "outer" else 5.0
    cut = shape.cut_back({edge: replace(plane, jointed=True) for edge, plane in planes.items()}, depth)
    assert None not in cut.side_planes
    check_exact(cut, 5.0, skin_side, relative=ROUNDING)
    assert_written_as_it_is(tmp_path / "panel.step", cut)
