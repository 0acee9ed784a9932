"""Sides of cones that stand in planes: no farther from their seam at one end than at the other, on both faces."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.errors import PanelError
from cadpanel.geometry.bevels import edge_bevels
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.panel import CutPlane
from cadpanel.geometry.plane_sides import SideCurve, end_spans, side_curve, side_curves, side_tangents
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.sheet_checks import check_buildable, skin_side_of
from cadpanel.geometry.skin_mesh import skin_mesh
from cadpanel.geometry.unroll import unroll_all
from cadpanel.geometry.vectors import cross
from tests.joined import leaning
from tests.shapes import folded_panel

CLOSE = 1e-9
SHARES = np.linspace(0.0, 1.0, 33)


def frustum(*, half_angle: float = 0.15, radius: float = 900.0, sweep: float = 1.4) -> PanelShape:
    """A cone, one end cut aslant."""
    return folded_panel(
        chain="c",
        half_angle=half_angle,
        radius=radius,
        sweep=np.copysign(sweep, radius),
        widths=(),
        turns=(),
        cut_normals=((1.0, 0.0, 0.0), (1.0, 0.1, -0.1)),
    )


def jointed(shape: PanelShape, side: int, back: float, kink: float, turn: float = 0.0) -> CutPlane:
    """Half a joint back from the plane that halves a kink of so many degrees."""
    return replace(leaning(shape, f"side {side}", back, np.tan(np.radians(0.5 * kink)), turn), jointed=True)


def cut_frustum(depth: float, kink: float = 25.0) -> PanelShape:
    shape = frustum()
    planes = {f"side {side}": jointed(shape, side, 10.0, kink - 35.0 * side) for side in (0, 1)}
    return shape.cut_back(planes, depth)


def curves_of(shape: PanelShape) -> list[SideCurve]:
    """Both, of sides that stand in planes."""
    return [curve for curve in side_curves(shape) if curve is not None]


@given(
    half_angle=st.sampled_from([-0.2, -0.01, 0.0, 0.05, 0.2]),
    radius=st.sampled_from([-900.0, 500.0, 20_000.0]),
    back=st.sampled_from([1.0, 5.0, 15.0]),
    kink=st.floats(-40.0, 40.0),
    turn=st.sampled_from([-0.01, 0.0, 0.01]),
    depth=st.sampled_from([-8.0, -1.0, 3.0]),
    side=st.sampled_from([0, 1]),
)
def test_a_side_with_a_joint_stands_in_its_plane_on_every_face(half_angle, radius, back, kink, turn, depth, side):
    shape = frustum(half_angle=half_angle, radius=radius)
    plane = jointed(shape, side, back, kink, turn)
    cut = shape.cut_back({f"side {side}": plane}, depth)
    check_buildable(cut, abs(depth), skin_side_of(depth))
    if cut.side_planes[side] is None:
        # A ruling holds the plane as well: on cylinders, and where nothing widens.
        ruled = np.concatenate([face.corners()[:, -side] for face in (cut, cut.offset(depth))])
        assert -0.01 <= plane.beyond(ruled).min() <= plane.beyond(ruled).max() <= CLOSE
        return
    for face in (cut, cut.offset(0.5 * depth), cut.offset(depth)):
        curve = side_curve(face, side)
        assert curve is not None
        points = curve.points(curve.heights[0] + SHARES * np.ptp(curve.heights))
        assert plane.beyond(points) == pytest.approx(np.zeros(33), abs=CLOSE)
        assert points[[0, -1]] == pytest.approx(face.corners()[:, -side], abs=CLOSE)
        off = np.einsum("ex,ex->e", face.corners()[:, -side] - face.cut_points, face.cut_normals)
        assert off == pytest.approx(np.zeros(2), abs=CLOSE)
        # Nothing of the sheet lies outside of the ruling.
        inwards = 1.0 if side == 0 else -1.0
        assert (inwards * ((points - face.points[-side]) @ face.binormals()[-side]) >= -CLOSE).all()


@pytest.mark.parametrize("depth", [-3.0, 8.0])
def test_the_flat_pattern_keeps_area_and_lengths(depth):
    cut = cut_frustum(depth)
    for face in (cut, cut.offset(depth)):
        (pattern,) = unroll_all([face], np.zeros(1))
        ends = pattern.curves.points(np.tile([[0.0, 1.0]], (4, 1)))
        assert ends[:, 1] == pytest.approx(np.roll(ends[:, 0], -1, axis=0), abs=CLOSE)
        (size,) = flat_sizes([pattern])
        assert size.area == pytest.approx(face.area(), rel=1e-12)
        for side, curve in enumerate(curves_of(face)):
            fine = curve.points(curve.heights[0] + np.linspace(0.0, 1.0, 2001) * np.ptp(curve.heights))
            assert size.edges[f"side {side}"] == pytest.approx(np.linalg.norm(np.diff(fine, axis=0), axis=1).sum())
        (bend,) = pattern.bends
        lines = pattern.rulings(bend, np.array([0.0, 0.5, 1.0]))
        assert (np.linalg.norm(np.diff(lines, axis=1), axis=-1) > 900.0).all()


def test_rulings_between_sides_in_planes_meet_in_the_flat_apex():
    (pattern,) = unroll_all([cut_frustum(-3.0)], np.zeros(1))
    (bend,) = pattern.bends
    lines = pattern.rulings(bend, np.array([0.0, 0.3, 0.6, 1.0]))
    starts, ways = lines[:, 0], np.diff(lines, axis=1)[:, 0]
    apart = np.linalg.solve(np.stack([ways[0], -ways[3]], axis=1), starts[3] - starts[0])
    apex = starts[0] + apart[0] * ways[0]
    off = apex - starts
    assert np.abs(ways[:, 0] * off[:, 1] - ways[:, 1] * off[:, 0]).max() < 1e-6 * np.linalg.norm(ways, axis=1).max()
    turns = np.arctan2(*off.T[::-1])
    assert np.diff(turns) / (turns[-1] - turns[0]) == pytest.approx([0.3, 0.3, 0.4], abs=1e-9)


@pytest.mark.parametrize("side", [0, 1])
def test_of_several_cones_the_one_at_the_side_keeps_its_area_and_its_plane(side):
    shape = folded_panel(chain="cpc", half_angle=0.15, radius=900.0, sweep=1.0)
    cut = shape.cut_back({f"side {side}": jointed(shape, side, 10.0, 25.0)}, -3.0)
    (pattern,) = unroll_all([cut], np.zeros(1))
    (size,) = flat_sizes([pattern])
    assert size.area == pytest.approx(cut.area(), rel=1e-10)
    assert np.abs(np.roll(pattern.curves.start, -1, axis=0) - pattern.curves.stop).max() < CLOSE
    (curve,) = curves_of(cut)
    points = curve.points(curve.heights[0] + np.linspace(0.0, 1.0, 4001) * np.diff(curve.heights))
    along = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    assert size.edges[f"side {side}"] == pytest.approx(along, rel=1e-8)


def test_the_mesh_lies_on_the_skin_and_ends_at_its_sides():
    cut = cut_frustum(-3.0)
    mesh = skin_mesh(cut)
    beyond = np.array([(mesh.points - cut.corners()[0, -side]) @ cut.edge(f"side {side}").outward for side in (0, 1)])
    assert beyond.max() == pytest.approx(0.0, abs=CLOSE)
    assert (np.abs(beyond) <= CLOSE).sum(axis=1).tolist() == [9, 9]
    corners = mesh.points[mesh.triangles]
    areas = np.linalg.norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=-1)
    assert 0.5 * areas.sum() == pytest.approx(cut.area(), rel=0.01)


def test_a_wall_is_bevelled_between_what_it_is_at_its_corners():
    cut = cut_frustum(-3.0)
    found = edge_bevels(cut, cut.offset(-3.0))
    for side, curve in enumerate(curves_of(cut)):
        angles = curve.angles(curve.heights[0] + SHARES * np.ptp(curve.heights))
        bevels = np.arcsin(curve.frame.normals(angles) @ cut.edge(f"side {side}").outward)
        assert found[f"side {side}"] == pytest.approx((bevels.min(), bevels.max()))
        assert np.ptp(bevels) > 1e-4


def test_what_tells_how_far_a_panel_reaches_holds_its_sides():
    cut = cut_frustum(-3.0)
    arcs, random = cut.arcs(), np.random.default_rng(0)
    directions = random.normal(size=(64, 3))
    told = arcs.reach(directions)[0].min(axis=1)
    for curve in curves_of(cut):
        points = curve.points(curve.heights[0] + SHARES * np.ptp(curve.heights))
        assert (told <= (directions @ points.T).min(axis=1) + 1e-6).all()


def test_planes_that_leave_nothing_or_miss_are_refused():
    narrow = frustum(sweep=0.3)
    for side in (0, 1):
        narrow = narrow.walled(side, jointed(frustum(sweep=0.3), side, 150.0, 0.0))
    with pytest.raises(PanelError, match="nothing is left of it between the walls at its sides"):
        narrow.check()
    with pytest.raises(PanelError, match="side 1"):
        frustum().cut_back({"side 1": jointed(frustum(), 1, -2_000.0, 0.0)}, -3.0)


def test_a_panel_may_be_narrow_between_the_walls_at_its_sides():
    narrow = frustum(sweep=0.3)
    for side in (0, 1):
        narrow = narrow.walled(side, jointed(frustum(sweep=0.3), side, 100.0, 0.0))
    narrow.check()
    assert (np.diff(end_spans(narrow)[:, 0], axis=-1) < 0.15).all()


@pytest.mark.parametrize("side", [0, 1])
def test_a_side_need_not_go_on_in_its_plane_beyond_the_panels_ends(side):
    """Towards the apex, where a cone is narrower than the plane is far from its axis."""
    shape = frustum(half_angle=0.4, radius=400.0)
    walled = shape.walled(side, jointed(shape, side, 120.0, 0.0))
    walled.check()
    curve = side_curve(walled, side)
    assert curve is not None
    assert np.isnan(curve.angles(curve.heights[0] - np.ptp(curve.heights) * SHARES)).any()


@pytest.mark.parametrize("depth", [-8.0, 3.0])
def test_a_square_wall_keeps_behind_the_plane_and_touches_it_with_its_shorter_face(depth):
    cut = cut_frustum(depth)
    square = cut.squared(depth)
    check_buildable(square, abs(depth), skin_side_of(depth))
    for side, (near, far) in enumerate(zip(curves_of(square), curves_of(square.offset(depth)), strict=True)):
        heights = near.heights[0] + SHARES * np.ptp(near.heights)
        points, others = near.points(heights), far.points(heights)
        assert others - points == pytest.approx(depth * near.frame.normals(near.angles(heights)), abs=CLOSE)
        edge = cut.edge(f"side {side}")
        beyond = [(row - edge.corners[0]) @ edge.outward for row in (points, others)]
        assert max(row.max() for row in beyond) == pytest.approx(0.0, abs=CLOSE)


@pytest.mark.parametrize("half_angle", [0.3, 0.0, -0.3])
def test_a_side_lies_in_the_triangle_of_its_chord_and_the_tangents_at_its_corners(half_angle):
    shape = frustum(half_angle=half_angle)
    shape = shape.walled(0, jointed(shape, 0, 10.0, 30.0, 0.1)).walled(1, jointed(shape, 1, 10.0, -20.0, 0.2))
    for curve in curves_of(shape):
        tangents = side_tangents(curve)
        start, meet = tangents.centers
        stop = meet + tangents.cosine_axes[1]
        assert start + tangents.cosine_axes[0] == pytest.approx(meet)
        low, high = curve.heights
        step = 1e-3 * np.sign(high - low)
        points = curve.points(np.array([low, low + step, high - step, high]))
        assert np.array([start, stop]) == pytest.approx(points[[0, 3]], abs=CLOSE)
        for way, near in ((meet - start, points[:2]), (stop - meet, points[2:])):
            along = np.diff(near, axis=0)[0]
            assert (along @ way) / np.linalg.norm(along) / np.linalg.norm(way) == pytest.approx(1.0, abs=1e-9)


def test_a_side_that_runs_straight_has_one_tangent():
    """In a plane along a cylinder's axis."""
    shape = frustum(half_angle=0.0)
    for curve in curves_of(shape.walled(0, jointed(shape, 0, 10.0, 0.0))):
        tangents = side_tangents(curve)
        assert len(tangents) == 1
        assert tangents.centers + tangents.cosine_axes == pytest.approx(curve.points(curve.heights[1:]))


@pytest.mark.parametrize("side", [0, 1])
def test_of_several_cones_each_side_is_that_of_the_nearest(side):
    shape = folded_panel(chain="cpc", radius=900.0, half_angle=0.1, sweep=0.6, widths=(200.0,), turns=(0.0,))
    plane = jointed(shape, side, 10.0, 20.0)
    cut = shape.walled(side, plane)
    curve = side_curve(cut, side)
    assert curve is not None
    points = curve.points(curve.heights[0] + SHARES * np.ptp(curve.heights))
    assert plane.beyond(points) == pytest.approx(np.zeros(33), abs=CLOSE)
    expected = shape.corners()
    expected[:, -side] = points[[0, -1]]
    assert cut.corners() == pytest.approx(expected, abs=CLOSE)
    assert np.linalg.norm(points - shape.corners()[:, -side].mean(axis=0), axis=1).min() < 50.0
    assert (abs(curve.corners) if side == 0 else abs(curve.corners - 0.6)) == pytest.approx([0.01, 0.01], abs=0.05)
