"""A chain's walls stand in the planes that were given, on both faces of the sheet, and the panel stays buildable."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.chain_cutting import side_in_plane
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.panel import CutPlane
from cadpanel.geometry.sheet_checks import check_buildable, other_face, skin_side_of
from cadpanel.geometry.vectors import cross
from tests.joined import leaning
from tests.shapes import folded_panel, random_panel

CLOSE = 1e-9
EDGES = ("end 0", "end 1", "side 0", "side 1")


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("depth", [-3.0, 20.0])
@pytest.mark.parametrize("lean", [-0.1, 0.1])
def test_walls_of_flat_sides_and_of_ends_stand_in_their_planes(seed, depth, lean):
    shape = random_panel(seed)
    planes = {edge: leaning(shape, edge, 10.0, lean, 0.01) for edge in EDGES}
    cut = shape.cut_back(planes, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    for face in (cut, cut.offset(0.5 * depth), cut.offset(depth)):
        for edge in EDGES:
            assert planes[edge].beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)


@pytest.mark.parametrize("half_angle", [-0.05, 0.05])
@pytest.mark.parametrize("depth", [-20.0, 3.0])
@pytest.mark.parametrize("side", [0, 1])
def test_the_side_of_a_cone_keeps_behind_its_plane_and_square_to_the_sheet(half_angle, depth, side):
    shape = folded_panel(chain="c", half_angle=half_angle, radius=900.0, widths=(), turns=())
    edge = f"side {side}"
    plane = leaning(shape, edge, 10.0, 0.05, 0.01)
    cut = shape.cut_back({edge: plane}, depth)
    check_buildable(cut, abs(depth), "outer" if depth < 0.0 else "inner")
    corners = np.concatenate([face.edge(edge).corners for face in (cut, cut.offset(depth))])
    assert plane.beyond(corners).max() == pytest.approx(0.0, abs=CLOSE)
    assert plane.beyond(corners).min() < 0.0
    assert cut.side_leans.tolist() == [0.0, 0.0]
    # The other side, and the cone, are as they were.
    other = f"side {1 - side}"
    assert cut.edge(other).corners == pytest.approx(shape.edge(other).corners, abs=CLOSE)


CHAINS_BETWEEN_ROUND_SIDES = ("cone", "cone-plane-cone")


@pytest.mark.parametrize("chain", CHAINS_BETWEEN_ROUND_SIDES)
@pytest.mark.parametrize("concave", [False, True])
@pytest.mark.parametrize("depth", [-3.0, 20.0])
@pytest.mark.parametrize("lean", [-0.15, 0.1])
def test_walls_of_cylinders_lean_with_planes_along_their_axes(chain, concave, depth, lean):
    """Along a ruling, with a joint or without."""
    shape = random_panel(3, chain=chain, half_angle=0.0, concave=concave)
    for jointed in (False, True):
        planes = {edge: replace(leaning(shape, edge, 10.0, lean), jointed=jointed) for edge in EDGES[2:]}
        cut = shape.cut_back(planes, depth)
        check_buildable(cut, abs(depth), skin_side_of(depth))
        assert cut.side_planes == (None, None)
        for face in (cut, cut.offset(0.5 * depth), cut.offset(depth)):
            for edge, plane in planes.items():
                assert plane.beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)


@pytest.mark.parametrize("chain", CHAINS_BETWEEN_ROUND_SIDES)
@pytest.mark.parametrize("concave", [False, True])
@pytest.mark.parametrize("half_angle", [0.0, 0.1])
@pytest.mark.parametrize("depth", [-3.0, 20.0])
def test_walls_of_bends_stand_in_their_planes_where_there_is_a_joint_and_else_behind(chain, concave, half_angle, depth):
    """Where no ruling holds the planes, as they are turned against all of them."""
    shape = random_panel(3, chain=chain, half_angle=half_angle, concave=concave)
    planes = {edge: leaning(shape, edge, 10.0, 0.1, 0.005) for edge in EDGES[2:]}
    ruled = shape.cut_back(planes, depth)
    check_buildable(ruled, abs(depth), skin_side_of(depth))
    for edge, plane in planes.items():
        corners = np.concatenate([face.edge(edge).corners for face in (ruled, ruled.offset(depth))])
        assert plane.beyond(corners).max() == pytest.approx(0.0, abs=CLOSE)
    jointed = {edge: replace(plane, jointed=True) for edge, plane in planes.items()}
    cut = shape.cut_back(jointed, depth)
    check_buildable(cut, abs(depth), skin_side_of(depth))
    assert cut.side_planes == tuple(jointed.values())
    for face in (cut, cut.offset(0.5 * depth), cut.offset(depth)):
        for edge, plane in planes.items():
            assert plane.beyond(face.edge(edge).corners) == pytest.approx(0.0, abs=CLOSE)
    # The ruling is that through the outermost of four corners.
    for side, outward in ((0, -1.0), (1, 1.0)):
        corners = np.concatenate([face.edge(f"side {side}").corners for face in (cut, cut.offset(depth))])
        beside = outward * ((corners - cut.points[-side]) @ cut.binormals()[-side])
        assert beside.max() == pytest.approx(0.0, abs=CLOSE)


def at_share(shape, side, share):
    """The plane through the axis of a cylinder's only bend, at a share of its sweep from a side, looking out of it."""
    (patch,) = shape.patches
    frame = axis_frame(shape.points[0], shape.directions[0], shape.normals[0], patch)
    (radial,) = frame.radials(np.array([patch.sweep * (1.0 - share if side else share)]))
    out = (1.0 if side else -1.0) * cross(frame.axis, radial)
    return CutPlane(point=frame.center, normal=out)


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("cut", [lambda *of: of[0].cut_back({f"side {of[1]}": of[2]}, -3.0), side_in_plane])
def test_a_side_moves_in_by_less_than_all_of_its_bend_and_out_by_less_than_a_quarter(side, cut):
    shape = folded_panel(chain="c", radius=900.0, sweep=1.0, widths=(), turns=())
    for share in (-0.24, 0.5, 0.99):
        (patch,) = cut(shape, side, at_share(shape, side, share), -3.0).patches
        assert patch.sweep == pytest.approx(1.0 - share)
    for share in (-0.26, 1.01, 1.1):
        with pytest.raises(PanelError, match=f"its neighbour at side {side} lies too far away"):
            cut(shape, side, at_share(shape, side, share), -3.0)


def test_what_is_not_named_stays():
    shape = random_panel(2)
    cut = shape.cut_back({"end 1": leaning(shape, "end 1", 10.0, 0.0)}, -3.0)
    assert cut.corners()[0] == pytest.approx(shape.corners()[0], abs=CLOSE)
    assert other_face(cut, 3.0, "outer").corners()[0] == pytest.approx(
        other_face(shape, 3.0, "outer").corners()[0], abs=CLOSE
    )
    assert cross(cut.directions, shape.directions) == pytest.approx(np.zeros((4, 3)), abs=1e-12)


def test_a_plane_that_misses_a_round_side_is_refused():
    shape = folded_panel(chain="c", radius=900.0, widths=(), turns=())
    plane = leaning(shape, "side 1", -600.0, 0.0)
    with pytest.raises(PanelError, match="its neighbour at side 1 lies too far away"):
        shape.cut_back({"side 1": plane}, -3.0)
