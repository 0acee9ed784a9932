from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cadpanel.errors import PanelError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import PanelReference, RawPanel
from tests.reference_shapes import Lip, flipped, moved, raw_panel, sampled_face, with_edges

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


def shuffled(panel: RawPanel, seed: int) -> RawPanel:
    """Shuffle a panel's faces and edges, walk some edges backwards and turn some normals over."""
    random = np.random.default_rng(seed)
    faces = []
    for index in random.permutation(len(panel.faces)):
        face = panel.faces[index]
        face = with_edges(face, random.permutation(4).tolist(), (random.random(4) < 0.5).tolist())
        faces.append(flipped(face) if random.random() < 0.5 else face)
    return replace(panel, faces=tuple(faces))


def assert_same(first: PanelReference, second: PanelReference, tolerance: float = CLOSE) -> None:
    np.testing.assert_allclose(first.corners, second.corners, atol=tolerance)
    np.testing.assert_allclose(first.ends, second.ends, atol=tolerance)
    np.testing.assert_allclose(first.sides, second.sides, atol=tolerance)
    np.testing.assert_allclose(first.end_normals, second.end_normals, atol=max(tolerance, 1e-4) / 20.0)


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
    straight, mixed = one(panel), one(shuffled(panel, seed))
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
    np.testing.assert_allclose(np.linalg.norm(panel.end_normals, axis=2), 1.0, atol=1e-12)


@pytest.mark.parametrize("cuts", CUTS)
@given(lip=lips, seed=seeds)
@settings(max_examples=10, deadline=None)
def test_one_face_and_three_and_six_are_the_same_panel(cuts, lip, seed):
    assert_same(one(raw_panel(lip)), one(shuffled(raw_panel(lip, cuts=cuts), seed)), tolerance=INTERPOLATED)


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
    outside = rotation @ still.end_normals[int(turned)][-int(turned)]
    assert there.end_normals[0][0] @ outside == pytest.approx(1.0, abs=1e-6)


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


def square(height):
    """Return a surface of 2 m by 2 m with the given height over x and y from -1 to 1."""

    def surface(u, v):
        x, y = 2.0 * u - 1.0, 2.0 * v - 1.0
        return np.stack([1000.0 * x, 1000.0 * y, 1000.0 * height(x, y)], axis=-1)

    return surface


@pytest.mark.parametrize(
    "height",
    [
        lambda x, y: np.sqrt(9.0 - x**2 - y**2),
        lambda x, y: np.sqrt(9.0 - x**2 - (0.5 * y) ** 2 - 0.75 * y**2),
        lambda x, y: 0.3 * (x**2 - y**2),
        lambda x, y: 0.3 * x * y,
        lambda x, y: 0.25 * (x**2 + 0.8 * y**2),
    ],
)
def test_sphere_and_saddle_are_refused_by_name(height):
    panel = RawPanel(name="dome", faces=(sampled_face(square(height), (0.0, 1.0)),))
    with pytest.raises(PanelError, match=r"Panel 'dome': in 'test.step', it curves both ways like a sphere or"):
        one(panel)


@pytest.mark.parametrize("aspect", [1.0, 2.0, 3.0])
def test_sphere_is_refused_whatever_its_aspect(aspect):
    def surface(u, v):
        east, north = np.radians(20.0) * aspect * (u - 0.5), np.radians(20.0) * (v - 0.5)
        return 3000.0 * np.stack([np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)], axis=-1)

    with pytest.raises(PanelError, match="like a sphere or a saddle"):
        one(RawPanel(name="globe", faces=(sampled_face(surface, (0.0, 1.0)),)))


def test_cylinder_over_the_same_square_passes():
    panel = RawPanel(name="vault", faces=(sampled_face(square(lambda x, _: np.sqrt(9.0 - x**2)), (0.0, 1.0)),))
    assert one(panel).length == pytest.approx(2000.0)


def test_flat_sheet_is_refused():
    with pytest.raises(PanelError, match="it is flat"):
        one(RawPanel(name="flat", faces=(sampled_face(square(lambda x, _: 0.0 * x), (0.0, 1.0)),)))


def test_sheet_that_bends_to_and_fro_is_not_called_flat():
    def wave(u, v):
        return np.stack([2000.0 * v, 500.0 * u, 200.0 * np.sin(2.0 * np.pi * u / 3.0)], axis=-1)

    with pytest.raises(PanelError, match=r"bends to and fro like an S .* divide it where the bend changes sides"):
        one(raw_panel(wave))


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


def test_outline_with_a_notch_is_refused_with_its_corners():
    cells = [sampled_face(Lip(), u, v) for u in ((0.0, 1.0), (1.0, 3.0)) for v in ((0.0, 0.6), (0.6, 1.0))]
    with pytest.raises(PanelError, match=r"its outline has 6 corners \(at "):
        one(RawPanel(name="lip", faces=tuple(cells[1:])))


def test_round_outline_is_refused():
    def disc(u, v):
        return np.stack([u * np.cos(2.0 * np.pi * v), u * np.sin(2.0 * np.pi * v), 0.1 * u**2], axis=-1) * 1000.0

    face = sampled_face(disc, (0.1, 1.0))
    rim = replace(face, edges=face.edges[1:2], edge_normals=face.edge_normals[1:2])
    with pytest.raises(PanelError, match="its outline has 0 corners where a panel has 4"):
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
