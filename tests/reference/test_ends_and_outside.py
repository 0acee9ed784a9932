"""Panels with neighbours on all sides: which edges are ends, and which face is the outer one, all over a skin."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cadpanel.reference.assemble import assemble
from cadpanel.reference.ends_and_outside import CLEARLY_FOLDED
from cadpanel.reference.model import RawPanel
from tests.reference_shapes import (
    moved,
    polygon_face,
    raw_grid,
    raw_honeycomb,
    sheet_of,
    shuffled,
)

pytestmark = pytest.mark.each_value_once

CLOSE = 1e-6  # mm
few = settings(max_examples=4)
seeds = st.integers(0, 2**32 - 1)


def barrel(degrees):
    """A vault that is rolled across by so many degrees, straight along."""
    angle = np.radians(degrees)

    def surface(u, v):
        turn = angle * (u - 0.5)
        return np.stack([6000.0 / angle * np.sin(turn), 8000.0 * (v - 0.5), 6000.0 / angle * np.cos(turn)], axis=-1)

    return surface


SKINS = {
    "barrel": barrel(90.0),
    "shallow barrel, no panel of which is clearly folded": barrel(8.0),
    "hollow barrel": sheet_of(lambda u, _: 1500.0 * (u - 0.5) ** 2),
    "square dome": sheet_of(lambda u, v: -500.0 * ((u - 0.5) ** 2 + (v - 0.5) ** 2), 6000.0, 6000.0),
    "square saddle": sheet_of(lambda u, v: 500.0 * ((u - 0.5) ** 2 - (v - 0.5) ** 2), 6000.0, 6000.0),
    "twisted": sheet_of(lambda u, v: 1000.0 * (u - 0.5) * (v - 0.5)),
    "flat": sheet_of(lambda u, _: 0.0 * u),
    "flat and square": sheet_of(lambda u, _: 0.0 * u, 6000.0, 6000.0),
    "flat but for one column": sheet_of(
        lambda u, _: -8000.0 * np.clip(u - 0.25, 0.0, 0.25) * np.maximum(u - 0.25, 0.0)
    ),
}
POSES = {
    "as drawn": np.eye(3),
    "upside down": np.diag([1.0, -1.0, -1.0]),
    "at 45 degrees": Rotation.from_euler("x", 45.0, degrees=True).as_matrix(),
    "askew": Rotation.random(random_state=3).as_matrix(),
}
every_skin = pytest.mark.parametrize("skin", SKINS)
every_pose = pytest.mark.parametrize("pose", POSES)


def placed(panels, pose):
    return [moved(panel, POSES[pose], np.array([100.0, -200.0, 300.0])) for panel in panels]


def read_anyhow(panels, seed):
    """The reference of the panels in another order, with other starting corners and normals here and there turned."""
    random = np.random.default_rng(seed)
    return assemble([shuffled(panels[k], random) for k in random.permutation(len(panels))], "grid.step")


def assert_ends_meet_ends(reference):
    """Ends meet ends and sides meet sides, end 1 the next end 0, side 1 the next side 0."""
    for seam in reference.seams:
        assert (seam.edges[0] // 2, sum(seam.edges) % 2, seam.reversed) == (seam.edges[1] // 2, 1, False)


def assert_one_face_is_outside(reference, least=0.9):
    for seam in reference.seams:
        first, second = (reference.panels[p].edge_normals[e] for p, e in zip(seam.panels, seam.edges, strict=True))
        assert np.sum(first * (second[::-1] if seam.reversed else second), axis=1).min() > least


def assert_seams_close(reference):
    for seam in reference.seams:
        first, second = (reference.panels[p].edges[e] for p, e in zip(seam.panels, seam.edges, strict=True))
        np.testing.assert_allclose(first, second[::-1] if seam.reversed else second, atol=1.0)


def assert_same(first, second):
    """Panels of one name have the same corners in the same places, and the same normals."""
    by_name = {panel.name: panel for panel in second.panels}
    assert len(first.seams) == len(second.seams)
    for panel in first.panels:
        other = by_name[panel.name]
        np.testing.assert_allclose(panel.corners, other.corners, atol=CLOSE)
        for one, two in zip(panel.edge_normals, other.edge_normals, strict=True):
            np.testing.assert_allclose(one, two, atol=1e-6)


@every_skin
@every_pose
@few
@given(seed=seeds)
def test_a_grid_is_the_same_however_it_is_filed(skin, pose, seed):
    panels = placed(raw_grid(SKINS[skin], 4, 3), pose)
    reference = assemble(panels, "grid.step")
    assert len(reference.seams) == 4 * 2 + 3 * 3
    assert_ends_meet_ends(reference)
    assert_one_face_is_outside(reference)
    assert_seams_close(reference)
    assert_same(reference, read_anyhow(panels, seed))


@pytest.mark.parametrize("skin", [skin for skin in SKINS if "barrel" in skin or "column" in skin])
@every_pose
def test_ends_lie_across_the_fold(skin, pose):
    reference = assemble(placed(raw_grid(SKINS[skin], 4, 3), pose), "grid.step")
    along = POSES[pose][:, 1]
    for panel in reference.panels:
        way = np.diff(panel.corners, axis=0)[0].mean(axis=0)
        assert abs(way @ along) == pytest.approx(np.linalg.norm(way), rel=1e-3)


@pytest.mark.parametrize(("skin", "hollow"), [("barrel", 1.0), ("hollow barrel", -1.0), ("square dome", 1.0)])
@every_pose
def test_the_outer_face_is_the_convex_one(skin, hollow, pose):
    for panel in assemble(placed(raw_grid(SKINS[skin], 4, 3), pose), "grid.step").panels:
        assert hollow * (panel.weights @ panel.normals) @ POSES[pose][:, 2] > 0.0


@pytest.mark.parametrize(("pose", "up"), [("as drawn", 1.0), ("upside down", -1.0), ("at 45 degrees", 1.0)])
def test_the_outer_face_of_a_flat_skin_is_above(pose, up):
    for panel in assemble(placed(raw_grid(SKINS["flat"], 3, 3), pose), "grid.step").panels:
        assert panel.normals @ POSES[pose][:, 2] * up == pytest.approx(1.0)


def turned_in_the_middle(strongest):
    """Three panels in a row, all bent along v by 10 degrees; the middle one is bent along u by so many degrees, too."""
    bend = np.radians(10.0)

    def surface(u, v):
        x, y = 2000.0 * 3.0 * (u - 0.5), 2000.0 * (v - 0.5)
        rise = 2000.0 * np.radians(strongest) / 2.0
        inside = np.clip(3.0 * u - 1.0, 0.0, 1.0) - 0.5
        slope = np.radians(strongest) / 2.0 * (np.maximum(1.0 / 3.0 - u, 0.0) + np.maximum(u - 2.0 / 3.0, 0.0)) * 6000.0
        return np.stack([x, y, -2000.0 * bend / 2.0 * (v - 0.5) ** 2 - rise * inside**2 - slope], axis=-1)

    return raw_grid(surface, 3, 1)


def directions(reference):
    """For each panel the axis that it runs along from end to end: 0 for x, 1 for y."""
    ways = {panel.name: np.diff(panel.corners, axis=0)[0].mean(axis=0) for panel in reference.panels}
    return [int(np.abs(ways[name]).argmax()) for name in sorted(ways)]


@few
@given(seed=seeds)
def test_a_panel_that_is_clearly_folded_keeps_its_own_ends_against_its_neighbours_wish(seed):
    clear = 10.0 + 1.5 * np.degrees(CLEARLY_FOLDED)
    assert directions(read_anyhow(turned_in_the_middle(clear), seed)) == [0, 1, 0]


@few
@given(seed=seeds)
def test_a_panel_that_is_folded_a_little_more_the_other_way_follows_its_neighbours(seed):
    unclear = 10.0 + 0.5 * np.degrees(CLEARLY_FOLDED)
    assert directions(read_anyhow(turned_in_the_middle(unclear), seed)) == [0, 0, 0]


@few
@given(seed=seeds)
def test_between_neighbours_that_disagree_the_order_of_the_file_does_not_decide(seed):
    """One corner of the grid is rolled across, the other along, and the rest is flat."""
    skin = sheet_of(lambda u, v: -3000.0 * np.clip(u - 0.5, 0.0, 1.0) ** 2 - 3000.0 * np.clip(0.5 - v, 0.0, 1.0) ** 2)
    panels = raw_grid(skin, 4, 4)
    reference = assemble(panels, "grid.step")
    assert len(set(directions(reference))) == 2
    assert_same(reference, read_anyhow(panels, seed))


def canonical(reference):
    """Per panel its corners from the least one on, and per seam the middles of both edges, in an order of their own."""
    loops = {}
    for panel in reference.panels:
        corners = panel.corners.reshape(-1, 3)
        first = np.lexsort(np.round(corners, 3).T)[0]
        loops[panel.name] = np.roll(corners, -first, axis=0)
    seams = sorted(tuple(sorted(reference.panels[p].name for p in seam.panels)) for seam in reference.seams)
    return loops, seams


@every_pose
@pytest.mark.parametrize("skin", ["square dome", "square saddle", "flat and square"])
@few
@given(seed=seeds)
def test_hexagons_run_counterclockwise_about_outer_normals_however_they_are_filed(skin, pose, seed):
    panels = placed(raw_honeycomb(SKINS[skin], 1), pose)
    reference = read_anyhow(panels, seed)
    assert len(reference.seams) == 12
    assert all(seam.reversed for seam in reference.seams)
    assert_one_face_is_outside(reference)
    assert_seams_close(reference)
    for panel in reference.panels:
        assert (len(panel.edges), panel.four_sided, panel.corners.shape, panel.turning) == (6, False, (6, 3), None)
        around = panel.corners - panel.corners.mean(axis=0)
        assert np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0) @ (panel.weights @ panel.normals) > 0.0
        np.testing.assert_allclose(
            [edge[-1] for edge in panel.edges], np.roll([edge[0] for edge in panel.edges], -1, axis=0), atol=CLOSE
        )
    (loops, seams), (others, same) = canonical(reference), canonical(assemble(panels, "grid.step"))
    assert seams == same
    for name, corners in loops.items():
        np.testing.assert_allclose(corners, others[name], atol=CLOSE)


@few
@given(seed=seeds)
def test_a_four_sided_panel_and_a_polygon_meet_along_any_edge(seed):
    """A triangle on the long side of a rectangle, and one on its short side."""
    skin = sheet_of(lambda u, v: -200.0 * (u - 0.5) ** 2 + 0.0 * v)
    square = np.array([[0.3, 0.3], [0.6, 0.3], [0.6, 0.7], [0.3, 0.7]])
    panels = [
        RawPanel(name="four", faces=(polygon_face(skin, square),)),
        RawPanel(name="right", faces=(polygon_face(skin, np.array([square[1], [0.9, 0.5], square[2]])),)),
        RawPanel(name="above", faces=(polygon_face(skin, np.array([square[2], [0.4, 0.9], square[3]])),)),
    ]
    reference = read_anyhow(panels, seed)
    names = {panel.name: panel for panel in reference.panels}
    assert [len(names[name].edges) for name in ("four", "right", "above")] == [4, 3, 3]
    met = {}
    for seam in reference.seams:
        for panel, edge, other in zip(seam.panels, seam.edges, seam.panels[::-1], strict=True):
            if reference.panels[panel].name == "four":
                met[reference.panels[other].name] = edge
    # The rectangle is rolled across u: its ends run along u, its sides along v.
    assert met["right"] in (2, 3)
    assert met["above"] in (0, 1)
    assert_seams_close(reference)
    assert_one_face_is_outside(reference)
