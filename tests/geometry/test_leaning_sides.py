"""The wall at a cylinder's side leans as the plane of its joint does, and every parallel skin ends on it."""

import numpy as np
import pytest

from cadpanel.geometry.edge_planes import turned_round
from cadpanel.geometry.leaning_sides import parallel_walk, risen
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.sheet_checks import check_buildable
from cadpanel.geometry.vectors import cross
from cadpanel.geometry.volume import sheet_volume
from tests.joined import leaning
from tests.shapes import folded_panel, walk

CLOSE = 1e-9
LEANS = np.tan(np.radians([-30.0, -10.0, -1.0, 0.0, 5.0, 10.0]))
"""Those of walls between panels that kink by up to 20 degrees, and by 60."""


def _rolled(radius: float):
    return folded_panel(chain="c", radius=radius, sweep=np.sign(radius), widths=(), turns=())


@pytest.mark.parametrize("radius", [900.0, -900.0])
@pytest.mark.parametrize("depth", [-20.0, 3.0])
@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("lean", LEANS)
def test_both_faces_and_all_between_end_on_the_plane(radius, depth, side, lean):
    shape = _rolled(radius)
    edge = f"side {side}"
    plane = leaning(shape, edge, 10.0, lean)
    cut = shape.cut_back({edge: plane}, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    for face in (cut, cut.offset(0.3 * depth), cut.offset(0.5 * depth).offset(0.5 * depth)):
        assert plane.beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)
    square = cut.squared(depth)
    corners = [face.edge(edge).corners for face in (square, square.offset(depth))]
    assert plane.beyond(np.concatenate(corners)).max() == pytest.approx(0.0, abs=CLOSE)
    across = corners[1][0] - corners[0][0]
    assert cross(across, square.normals[-side]) == pytest.approx(np.zeros(3), abs=CLOSE)


@pytest.mark.parametrize("depth", [-20.0, 3.0])
def test_a_wall_leans_about_the_axis_alone_and_keeps_behind_a_plane_that_crosses_it(depth):
    shape = _rolled(900.0)
    plane = leaning(shape, "side 1", 10.0, 0.1, 0.01)
    cut = shape.cut_back({"side 1": plane}, depth)
    beyond = np.array([plane.beyond(face.edge("side 1").corners) for face in (cut, cut.offset(depth))])
    assert beyond.max() == pytest.approx(0.0, abs=CLOSE)
    # Along the joint it tapers as the plane turns; from face to face it does not.
    assert beyond[0] == pytest.approx(beyond[1], abs=CLOSE)


@pytest.mark.parametrize(("radius", "depth"), [(900.0, -3.0), (-900.0, -20.0), (60.0, -20.0)])
def test_two_sheets_on_either_side_of_a_plane_fill_the_whole_one(radius, depth):
    shape = _rolled(radius)
    plane = leaning(shape, "side 1", 0.2 * abs(radius), 0.4)
    parts = [shape.cut_back(walls, depth) for walls in ({"side 1": plane}, {"side 0": turned_round(plane)})]
    volumes = [sheet_volume(part, -depth, "outer") for part in (*parts, shape)]
    assert sum(volumes[:2]) == pytest.approx(volumes[2], rel=1e-12)


@pytest.mark.parametrize("chain", ["ccc", "pcp", "cp"])
@pytest.mark.parametrize("radius", [60.0, -60.0])
@pytest.mark.parametrize("distance", [-9.0, 7.0])
@pytest.mark.parametrize("leans", [(0.25, -0.5), (0.0, 0.3), (-0.4, 0.0)])
def test_a_parallel_skin_is_a_walk_of_its_own_whose_sides_lie_in_the_walls(chain, radius, distance, leans):
    flats = chain.count("p")
    shape = folded_panel(
        chain=chain, radius=radius, sweep=0.8 * np.sign(radius), widths=(80.0, 50.0)[:flats], turns=(0.0,) * flats
    )
    rulings, given = (shape.points, shape.normals, shape.binormals()), np.array(leans)
    found = parallel_walk(rulings, shape.patches, given, distance)
    # Every parallel surface is met where it is: walked from the first ruling it comes to the last one.
    widths = np.linalg.norm(np.diff(found.points, axis=0), axis=-1)
    steps = [(widths[i], 0.0) for i, kind in enumerate(chain) if kind == "p"]
    walked = walk(found.patches, steps, found.points[0], shape.directions[0], found.normals[0])
    assert walked[0] == pytest.approx(found.points, abs=CLOSE)
    assert walked[2] == pytest.approx(found.normals, abs=CLOSE)
    for patch, own in zip(shape.patches, found.patches, strict=True):
        if isinstance(patch, ConePatch) and isinstance(own, ConePatch):
            assert own.radius == patch.radius + distance
    inner = slice(1, -1)
    assert found.points[inner] == pytest.approx(shape.points[inner] + distance * shape.normals[inner], abs=CLOSE)
    for side in (0, 1):
        normal, binormal = shape.normals[-side], shape.binormals()[-side]
        wall, gone = normal + leans[side] * binormal, found.points[-side] - shape.points[-side]
        assert cross(gone, wall) == pytest.approx(np.zeros(3), abs=1e-7)
        assert distance * (gone @ wall) > 0.0
        across = cross(shape.directions[-side], found.normals[-side])
        assert (wall @ across) / (wall @ found.normals[-side]) == pytest.approx(found.leans[side], abs=CLOSE)
        patch = shape.patches[-side]
        if isinstance(patch, ConePatch):
            axis = shape.points[-side] - patch.radius * normal
            assert np.linalg.norm(found.points[-side] - axis) == pytest.approx(abs(patch.radius + distance))
        else:
            assert gone @ normal == pytest.approx(distance)


@pytest.mark.parametrize("radius", [100.0, -100.0])
def test_a_wall_comes_to_a_parallel_skin_until_it_leads_away_from_the_axis(radius):
    """It leans by 45 degrees, so it is nearest to the axis at half of the way there."""
    nearest = 100.0 * np.sqrt(0.5)
    just, past = (np.sign(radius) * nearest * (1.0 + hair) - radius for hair in (1e-7, -1e-7))
    found = risen(radius, np.ones(2), np.array([just, past]))
    assert found[0] == pytest.approx(-0.5 * radius, abs=0.1)
    assert np.isnan(found[1])
