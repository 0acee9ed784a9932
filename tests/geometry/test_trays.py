"""Flat panels folded round their edges: legs stand where walls stood, and keep off each other at corners."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.returns import ReturnRule
from cadpanel.geometry.sheet_checks import SkinSide, check_buildable, sheet_depth
from cadpanel.geometry.skin_mesh import skin_mesh
from cadpanel.geometry.trays import foldable_edges, folded_tray, is_flat
from cadpanel.geometry.unroll import unroll
from cadpanel.geometry.unroll_trays import of_corner
from tests.shapes import random_panel
from tests.trays import RULE, THICKNESS, flat, tray

SIDES: list[SkinSide] = ["outer", "inner"]


@pytest.mark.parametrize("skin_side", SIDES)
def test_the_outer_face_of_each_leg_lies_in_the_plane_of_its_wall_and_is_as_long_as_asked(skin_side: SkinSide) -> None:
    shape = tray(skin_side=skin_side)
    check_buildable(shape, THICKNESS, skin_side)
    depth, outer = sheet_depth(THICKNESS, skin_side), 0.0 if skin_side == "outer" else THICKNESS
    corners, moved = shape.flat.corners()[0], shape.flat.offset(depth).corners()[0]
    level = shape.offset(outer)
    points, ways = level.surfaces()
    outermost = level.corners()[0]
    for edge, (point, way) in enumerate(zip(points[2::2], ways[2::2], strict=True)):
        for corner in (corners[edge], corners[(edge + 1) % 4], moved[edge], moved[(edge + 1) % 4]):
            assert (corner - point) @ way == pytest.approx(0.0, abs=1e-9)
        off = (level.vertices() - outermost[edge]) @ shape.plan.onwards[edge]
        beside = np.abs((level.vertices() - point) @ way) < 1e-9
        assert off[beside].max() == pytest.approx(RULE.length, abs=1e-9)
    # Nothing of the sheet is beyond any wall, so that joints are as wide as they were.
    for lift in (0.0, depth):
        for point, way in (shape.wall(name) for name in shape.edges):
            assert ((shape.offset(lift).vertices() - point) @ way).max() < 1e-9


def test_an_edge_shorter_than_its_leg_stays_flat_and_its_neighbours_end_before_it() -> None:
    shape = flat((0.0, 0.0, 0.0, 0.0))
    near = shape.outline[0] + 0.033 * (shape.outline[1] - shape.outline[0])
    slender = replace(shape, outline=np.concatenate([shape.outline[:1], near[None], shape.outline[2:]]), posts=None)
    edges, why = foldable_edges(slender, RULE, THICKNESS, "outer")
    assert (edges, why) == (("edge 1", "edge 2", "edge 3"), None)
    made = folded_tray(slender, edges, RULE, THICKNESS, "outer")
    point, way = made.wall("edge 0")
    assert ((made.vertices() - point) @ way).max() < 1e-9
    assert made.plan.reliefs[2:].min() >= THICKNESS


def test_outlines_that_turn_outwards_or_hardly_at_all_are_left_flat_and_say_why() -> None:
    shape = flat((0.0,) * 4)
    middle = 0.5 * (shape.outline[0] + shape.outline[1])
    straight = replace(shape, outline=np.insert(shape.outline, 1, middle, axis=0), posts=None)
    edges, why = foldable_edges(straight, RULE, THICKNESS, "outer")
    assert (edges, why) == ((), "its outline does not turn inwards clearly at corner 1")


def test_what_cannot_be_folded_is_refused_with_a_remedy() -> None:
    shape = flat((0.9,) * 4, scale=0.1)
    with pytest.raises(PanelError, match="would meet inside of it; ask for shorter ones"):
        folded_tray(shape, ("edge 0", "edge 2"), ReturnRule(length=75.0, inner_radius=2.5), THICKNESS, "outer")
    with pytest.raises(PanelError, match="behind its fold at edge 0; ask for one of at least"):
        folded_tray(flat((0.0,) * 4), ("edge 0",), ReturnRule(length=7.0, inner_radius=2.5), THICKNESS, "outer")
    with pytest.raises(PanelError, match="folded already"):
        tray().cut_back({}, -THICKNESS)


def test_flat_panels_are_told_from_bent_ones() -> None:
    assert is_flat(flat((0.0,) * 3))
    assert is_flat(random_panel(1, chain="plane"))
    assert not is_flat(random_panel(1, chain="plane-cone"))


@pytest.mark.parametrize("edges", [None, ("edge 1",), ("edge 0", "edge 2")])
def test_a_mesh_to_look_at_covers_the_whole_skin(edges: tuple[str, ...] | None) -> None:
    shape = tray(edges=edges)
    for level in (shape, shape.offset(-THICKNESS)):
        mesh = skin_mesh(level)
        first, second, third = (mesh.points[mesh.triangles[:, corner]] for corner in range(3))
        turned = np.cross(second - first, third - first)
        out = np.cross(mesh.ways[:, 0], mesh.ways[:, 1])
        assert 0.5 * np.linalg.norm(turned, axis=-1).sum() == pytest.approx(level.area(), rel=5e-4)
        assert np.abs(np.linalg.norm(out, axis=-1) - 1.0).max() < 1e-12
        away = np.linalg.norm(level.vertices()[:, None] - mesh.points, axis=-1)
        assert away.min(axis=1).max() < 1e-9
        assert away.min(axis=0).max() < 0.8 * np.linalg.norm(np.ptp(level.vertices(), axis=0))
        assert (np.einsum("fx,fx->f", turned, out[mesh.triangles[:, 0]]) > 0.0).all()


def test_legs_that_face_each_other_come_as_near_as_two_sheets_and_no_nearer() -> None:
    shape = flat((0.9,) * 4, scale=0.1)
    fits, meets = 20.0, 75.0
    while meets - fits > 1e-3:
        length = 0.5 * (fits + meets)
        rule = ReturnRule(length=length, inner_radius=2.5)
        try:
            made, fits = folded_tray(shape, ("edge 0", "edge 2"), rule, THICKNESS, "outer"), length
        except PanelError:
            meets = length
    vertices = np.concatenate([made.offset(lift).vertices() for lift in (0.0, sheet_depth(THICKNESS, "outer"))])
    near = []
    for name in made.edges:
        point, way = made.wall(name)
        behind = (point - vertices) @ way
        near.append(behind[behind > 1.5 * THICKNESS].min())
    assert min(near) == pytest.approx(2.0 * THICKNESS, abs=0.01)


@pytest.mark.parametrize("edges", [None, ("edge 0",), ("edge 0", "edge 1")])
def test_a_face_ends_in_corners_of_its_own_between_which_its_edges_run(edges: tuple[str, ...] | None) -> None:
    for lift in (0.0, -THICKNESS):
        shape = tray(edges=edges).offset(lift)
        vertices = shape.vertices()
        apart = np.linalg.norm(vertices[:, None] - vertices, axis=-1)
        assert (apart[~np.eye(len(vertices), dtype=bool)] > 0.1).all()
        for name in shape.edges:
            ends = shape.edge(name).corners
            assert np.linalg.norm(ends[:, None] - vertices, axis=-1).min(axis=1) == pytest.approx(0.0, abs=1e-9)


def test_a_plane_with_two_ends_is_folded_like_a_polygon_with_the_same_corners() -> None:
    chain = random_panel(1, chain="plane").squared(sheet_depth(THICKNESS, "outer"))
    rows = chain.corners()
    polygon = replace(
        flat((0.0,) * 4), outline=np.concatenate([rows[0], rows[1, ::-1]]), normal=chain.normals[0], posts=None
    )
    around = tuple(f"edge {place}" for place in range(4))
    of_chain, of_polygon = (
        folded_tray(one, edges, RULE, THICKNESS, "outer")
        for one, edges in ((chain, ("end 0", "side 1", "end 1", "side 0")), (polygon, around))
    )
    assert of_chain.vertices() == pytest.approx(of_polygon.vertices(), abs=1e-6)
    assert of_chain.area() == pytest.approx(of_polygon.area())


def test_the_thinnest_sheets_have_reliefs_as_wide_as_they_are_thick() -> None:
    thin, rule = 0.1, ReturnRule(length=30.0, inner_radius=2.5)
    panel = flat((0.0,) * 4)
    shape = folded_tray(panel, foldable_edges(panel, rule, thin, "outer")[0], rule, thin, "outer")
    assert shape.plan.reliefs == pytest.approx(thin)
    assert shape.plan.wall_kinds.count("cylinder") == 4
    assert len(shape.vertices()) == 8 + 8 + 8
    assert [edge for edge in unroll(shape).edges if of_corner(edge)].count("corner 0") == 1 + 2 + 2
    reliefs = 0.5 * thin**2 * 4.0 * np.sin(shape.plan.openings / 4.0)
    mesh = skin_mesh(shape)
    of_flat = mesh.triangles[mesh.patches == 0]
    first, second, third = (mesh.points[of_flat[:, corner]] for corner in range(3))
    area = 0.5 * np.linalg.norm(np.cross(second - first, third - first), axis=-1).sum()
    x, y = shape.plan.corners - shape.plan.corners[0], np.roll(shape.plan.corners, -1, axis=0) - shape.plan.corners[0]
    whole = 0.5 * np.linalg.norm(np.cross(x, y).sum(axis=0))
    assert whole - area == pytest.approx(reliefs.sum(), rel=1e-4)
