from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cadpanel.errors import PanelError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import PanelReference, RawPanel
from tests.reference_shapes import Lip, moved, polygon_face, raw_panel, sampled_face, sheet_of, shuffled

CUTS = ((0.0, 3.0), (0.0, 1.0, 2.0, 3.0), (0.0, 0.4, 1.0, 1.5, 2.0, 2.7, 3.0))
CLOSE = 1e-6  # mm
# An end that runs in one edge over flange and blend is met to this, mm, where its curvature jumps between two samples.
INTERPOLATED = 2.0
seeds = st.integers(min_value=0, max_value=2**32 - 1)
lips = st.builds(
    Lip,
    fold=st.floats(60.0, 130.0),
    twist=st.floats(-25.0, 25.0),
    taper=st.floats(-0.5, 0.5),
    flange=st.floats(150.0, 600.0),
    radius=st.floats(100.0, 400.0),
)


def one(panel: RawPanel) -> PanelReference:
    return assemble([panel], "test.step").panels[0]


def assert_same(first: PanelReference, second: PanelReference, tolerance: float = CLOSE) -> None:
    np.testing.assert_allclose(first.corners, second.corners, atol=tolerance)
    np.testing.assert_allclose(first.ends, second.ends, atol=tolerance)
    np.testing.assert_allclose(first.sides, second.sides, atol=tolerance)
    for one_, other in zip(first.edge_normals[:2], second.edge_normals[:2], strict=True):
        np.testing.assert_allclose(one_, other, atol=max(tolerance, 1e-4) / 20.0)


def assert_handed(panel: PanelReference) -> None:
    """Ends run from side 0 to side 1, sides from end 0 to end 1, and t x n = b."""
    for end in range(2):
        for side in range(2):
            np.testing.assert_allclose(panel.ends[end][-side], panel.sides[side][-end], atol=CLOSE)
    along = (panel.corners[1] - panel.corners[0]).mean(axis=0)
    across = (panel.corners[:, 1] - panel.corners[:, 0]).mean(axis=0)
    assert np.cross(along, panel.weights @ panel.normals) @ across > 0.0


@given(lip=lips, seed=seeds)
@settings(max_examples=40, deadline=None)
def test_order_and_direction_of_faces_and_edges_change_nothing(lip, seed):
    panel = raw_panel(lip)
    straight, mixed = one(panel), one(shuffled(panel, np.random.default_rng(seed)))
    assert_same(straight, mixed)
    order = [np.lexsort(reference.points.T) for reference in (straight, mixed)]
    np.testing.assert_allclose(straight.normals[order[0]], mixed.normals[order[1]], atol=1e-12)


@given(lip=lips)
@settings(max_examples=25, deadline=None)
def test_panel_is_laid_out_right_handed_with_normals_outside(lip):
    panel = one(raw_panel(lip))
    assert_handed(panel)
    assert panel.length > 0.9 * lip.length
    middle = np.average(panel.points, axis=0, weights=panel.weights)
    # Outside of a fold the normals point away from its inside, which is where the middle of its points lies.
    assert np.average(np.einsum("md,md->m", panel.normals, panel.points - middle), weights=panel.weights) > 0.0
    np.testing.assert_allclose(np.linalg.norm(panel.normals, axis=1), 1.0, atol=1e-12)
    for normals in panel.edge_normals:
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12)


@pytest.mark.parametrize("cuts", CUTS)
@given(lip=lips, seed=seeds)
@settings(max_examples=10, deadline=None)
def test_one_face_and_three_and_six_are_the_same_panel(cuts, lip, seed):
    assert_same(
        one(raw_panel(lip)),
        one(shuffled(raw_panel(lip, cuts=cuts), np.random.default_rng(seed))),
        tolerance=INTERPOLATED,
    )


@given(lip=lips, seed=seeds, distance=st.sampled_from([0.0, 1e3, 1e6, 1e9]))
@settings(max_examples=25, deadline=None)
def test_moving_the_panel_moves_its_reference(lip, seed, distance):
    random = np.random.default_rng(seed)
    rotation = Rotation.random(random_state=random).as_matrix()
    shift = distance * random.normal(size=3)
    panel = raw_panel(lip)
    still, there = one(panel), one(moved(panel, rotation, shift))
    corners = still.corners @ rotation.T + shift
    # Which end comes first follows the axes of space, so it may be the other one after a turn.
    turned = np.linalg.norm(there.corners[0, 0] - corners[0, 0]) > 1.0
    tolerance = CLOSE + 1e-9 * distance
    np.testing.assert_allclose(there.corners, corners[::-1, ::-1] if turned else corners, atol=tolerance)
    outside = rotation @ still.edge_normals[int(turned)][-int(turned)]
    assert there.edge_normals[0][0] @ outside == pytest.approx(1.0, abs=1e-6)


def test_faces_that_meet_in_a_t_junction_are_one_panel():
    lip = Lip()
    halves = [sampled_face(lip, (0.0, 1.0), v_range) for v_range in ((0.0, 0.4), (0.4, 1.0))]
    pieces = RawPanel(name="lip", faces=(halves[1], sampled_face(lip, (1.0, 3.0)), halves[0]))
    assert_same(one(pieces), one(raw_panel(lip)), tolerance=INTERPOLATED)


def test_long_side_of_a_wide_fold_is_not_taken_for_an_end():
    panel = one(raw_panel(Lip(length=400.0, twist=0.0)))
    assert panel.length == pytest.approx(400.0, rel=0.01)


def test_nearly_flat_cylinder_of_ten_degrees_passes():
    panel = one(raw_panel(Lip(fold=10.0, radius=3000.0, flange=1.0, twist=0.0), cuts=(1.0, 2.0)))
    assert panel.length == pytest.approx(2000.0, rel=0.01)


def test_sharp_fold_between_two_planes_has_no_corner_at_the_fold():
    fold = Lip(radius=1e-3, twist=0.0)
    panel = RawPanel(name="fold", faces=(sampled_face(fold, (0.0, 1.0)), sampled_face(fold, (2.0, 3.0))))
    assert one(panel).length == pytest.approx(2000.0)


def test_faces_apart_are_refused_and_touching_ones_pass():
    lip = Lip()
    faces = sampled_face(lip, (0.0, 1.0)), sampled_face(lip, (1.0, 2.0))
    apart = moved(RawPanel(name="x", faces=faces[1:]), np.eye(3), np.array([0.0, 40.0, 0.0])).faces
    with pytest.raises(PanelError, match=r"only 1 of its 2 faces touch each other along an edge.* 40 mm away"):
        one(RawPanel(name="lip", faces=(faces[0], *apart)))
    assert one(RawPanel(name="lip", faces=faces)).length > 0.0


def test_hole_is_refused():
    cells = [
        sampled_face(Lip(), u, v)
        for u in ((0.0, 1.0), (1.0, 2.0), (2.0, 3.0))
        for v in ((0.0, 0.3), (0.3, 0.7), (0.7, 1.0))
    ]
    with pytest.raises(PanelError, match="its outline has 2 loops"):
        one(RawPanel(name="lip", faces=tuple(cells[:4] + cells[5:])))
    assert one(RawPanel(name="lip", faces=tuple(cells))).length > 0.0


def test_round_outline_is_refused():
    def disc(u, v):
        return np.stack([u * np.cos(2.0 * np.pi * v), u * np.sin(2.0 * np.pi * v), 0.1 * u**2], axis=-1) * 1000.0

    face = sampled_face(disc, (0.1, 1.0))
    rim = replace(face, edges=face.edges[1:2], edge_normals=face.edge_normals[1:2])
    with pytest.raises(PanelError, match="its outline has 0 corners where a panel has 3 or more"):
        one(RawPanel(name="disc", faces=(rim,)))


def test_closed_surface_is_refused():
    face = sampled_face(Lip(), (0.0, 3.0))
    with pytest.raises(PanelError, match="it is a closed surface without an outline"):
        one(RawPanel(name="ball", faces=(replace(face, edges=(), edge_normals=()),)))


def test_face_without_area_is_refused_by_its_place():
    panel = raw_panel(Lip(), cuts=(0.0, 1.0, 2.0, 3.0))
    empty = np.empty((0, 3))
    line = replace(panel.faces[1], points=empty, normals=empty, weights=np.empty(0))
    with pytest.raises(PanelError, match="face 2 of 3 has no area"):
        one(replace(panel, faces=(panel.faces[0], line, panel.faces[2])))


def flat_panel(*corners):
    """A flat panel with these corners (x, y), one edge of it between every two."""
    face = polygon_face(ROOF, np.array(corners))
    return assemble([RawPanel(name="flat", faces=(face,))], "roof.step").panels[0]


ROOF = sheet_of(lambda x, y: 0.0 * (x + y), width=6000.0, length=6000.0)


@pytest.mark.parametrize("rise", [0.1, 0.2, 0.45])
def test_obtuse_corners_of_a_flat_panel_are_corners(rise):
    kite = ((0.0, 0.0), (1.0, -rise), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0))
    assert len(flat_panel(*kite).edges) == 5


@pytest.mark.parametrize("slant", [10.0, 22.0, 28.0])
def test_a_slanted_parallelogram_has_four_corners(slant):
    reach = 1.0 / np.tan(np.radians(slant))
    assert flat_panel((0.0, 0.0), (3.0, 0.0), (3.0 + reach, 1.0), (reach, 1.0)).four_sided
