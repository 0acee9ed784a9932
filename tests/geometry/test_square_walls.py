"""Walls square to the sheet: inside of those that lean, touching them where they lean in most, on every feature."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.bevels import edge_bevels
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.unroll import unroll, unroll_all
from cadpanel.geometry.volume import sheet_volume
from tests.chains import CHAINS, FEATURES
from tests.flat_panels import panels
from tests.joined import leaning
from tests.shapes import random_panel

DEPTHS = (-3.0, 20.0)
LENGTH = 1e-8  # mm


def along_end(shape: PanelShape, end: int) -> tuple[Array, Array]:
    """Points of a skin's end and its normals there, from the corners and, between them, from the flat pattern."""
    pattern, corners = unroll(shape), shape.corners()[end]
    points, normals = [corners], [shape.normals]
    for bend in pattern.bends:
        patch = shape.patches[bend.patch]
        assert isinstance(patch, ConePatch)
        frame = axis_frame(shape.points[bend.patch], shape.directions[bend.patch], shape.normals[bend.patch], patch)
        shares = np.linspace(0.0, 1.0, 33)
        radials = frame.radials(shares * patch.sweep)
        lines = pattern.rulings(bend, shares)[:, end]
        curves = pattern.curves
        # Heights along the generatrix, from where the ruling's point lies in the plane.
        row = bend.at_ends[0]
        theta, rho = curves.sine[row] * shares * patch.sweep, curves.level_radius[row]
        along, right = curves.along[row], np.array([curves.along[row, 1], -curves.along[row, 0]])
        foot = curves.origin[row] + (rho * shares * patch.sweep * np.sinc(theta / np.pi))[:, None] * right
        foot -= (0.5 * rho * theta * shares * patch.sweep * np.sinc(0.5 * theta / np.pi) ** 2)[:, None] * along
        ways = np.sin(theta)[:, None] * right + np.cos(theta)[:, None] * along
        heights = ((lines - foot) * ways).sum(axis=-1)
        cosine, sine = np.cos(frame.half_angle), np.sin(frame.half_angle)
        points.append(frame.center + rho * radials + heights[:, None] * (cosine * frame.axis + sine * radials))
        normals.append(frame.normals(shares * patch.sweep))
    return np.concatenate(points), np.concatenate(normals)


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("name", sorted(CHAINS))
def test_ends_keep_behind_their_planes_on_both_faces_and_touch_them(name: str, depth: float) -> None:
    for shape in panels(name, 3)[:2]:
        assert isinstance(shape, PanelShape)
        square = shape.squared(depth)
        for end, outward in ((0, -1.0), (1, 1.0)):
            points, normals = along_end(square, end)
            out = outward * shape.cut_normals[end]
            near = (points - shape.cut_points[end]) @ out
            far = near + depth * normals @ out
            assert np.ptp(near) < LENGTH
            reach = max(near.max(), far.max())
            assert -1e-3 * abs(depth) < reach < LENGTH  # the farthest place may lie between the points
            on_other = along_end(square.offset(depth), end)[0]
            assert np.abs(on_other - (points + depth * normals)).max() < LENGTH


@pytest.mark.parametrize("name", sorted(FEATURES))
def test_square_sheets_lie_flat_as_they_are_and_are_square(name: str) -> None:
    for shape in panels(name, 4)[:2]:
        square = shape.squared(-3.0)
        square.check()
        square.check_sheet(square.offset(-3.0), 3.0)
        offsets = np.array([0.0, -1.5, -3.0])
        sizes = flat_sizes(unroll_all(3 * [square], offsets))
        areas = [square.offset(float(offset)).area() for offset in offsets]
        assert [size.area for size in sizes] == pytest.approx(areas, rel=1e-9)
        assert not np.any(list(edge_bevels(square, square.offset(-3.0)).values()))
        assert sheet_volume(square, 3.0) <= sheet_volume(shape, 3.0) * (1.0 + 1e-12)


@pytest.mark.parametrize("depth", DEPTHS)
def test_leaning_sides_of_flat_patches_become_square_where_the_shorter_face_ends(depth: float) -> None:
    for chain in ("plane", "plane-cone-plane"):
        panel = random_panel(3, chain=chain)
        planes = {f"side {side}": leaning(panel, f"side {side}", 8.0, lean) for side, lean in ((0, 0.2), (1, -0.1))}
        shape = panel.cut_back(planes, depth)
        square = shape.squared(depth)
        for edge in ("side 0", "side 1"):
            kept, was = square.edge(edge), shape.edge(edge)
            far = shape.offset(depth).edge(edge)
            reach = [float((one.corners[0] - kept.corners[0]) @ was.outward) for one in (was, far)]
            assert min(reach) == pytest.approx(0.0, abs=LENGTH)
            assert max(reach) > 0.01


def test_a_polygon_keeps_inside_of_both_faces_and_its_edges_keep_their_ways() -> None:
    outline = np.array([[0.0, 0.0, 0.0], [900.0, 0.0, 0.0], [1000.0, 800.0, 0.0], [0.0, 700.0, 0.0]])
    slides = np.array([[0.2, 0.1, 1.0], [-0.1, 0.1, 1.0], [-0.1, -0.2, 1.0], [0.2, -0.2, 1.0]])
    shape = PolygonShape(
        name="A", feature="planar-polygon", outline=outline, normal=np.array([0.0, 0.0, 1.0]), posts=slides
    )
    for depth in DEPTHS:
        square, other = shape.squared(depth), shape.offset(depth)
        for i in range(4):
            spans = [np.roll(one, -1, axis=0)[i] - one[i] for one in (outline, square.outline)]
            assert np.linalg.norm(np.cross(*spans)) < LENGTH * np.linalg.norm(spans[0]) * np.linalg.norm(spans[1])
            out = np.cross(spans[0], shape.normal) / np.linalg.norm(spans[0])
            reach = [float(out @ (one.outline[i] - square.outline[i])) for one in (shape, other)]
            leans = 0.5 * (slides[i] + slides[(i + 1) % 4]) @ out
            assert reach[0] == pytest.approx(max(0.0, -depth * leans), abs=LENGTH)
        assert square.posts is None
    with pytest.raises(PanelError, match=r"only 0 mm of edge \d are left"):
        shape.squared(9000.0)


@pytest.mark.parametrize("outer", [0.1, 0.2, 0.3])
def test_where_an_outline_hardly_turns_both_walls_stand_back_as_the_one_that_leans_more(outer: float) -> None:
    flat = [[0.0, 0.0], [500.0, -1e-9], [1000.0, 0.0], [1000.0, 800.0], [0.0, 800.0]]
    outline = np.column_stack([flat, np.zeros(5)])
    slides = np.column_stack([np.zeros(5), [-outer, -0.2, outer - 0.4, 0.0, 0.0], np.ones(5)])
    shape = PolygonShape(
        name="A", feature="planar-polygon", outline=outline, normal=np.array([0.0, 0.0, 1.0]), posts=slides
    )
    first, second = 5.0 * (outer + 0.2), 5.0 * (0.6 - outer)
    assert shape.squared(-10.0).outline[:3, 1] == pytest.approx([first, max(first, second), second], abs=1e-6)
    assert shape.squared(10.0).outline == pytest.approx(outline, abs=LENGTH)


@pytest.mark.parametrize("depth", DEPTHS)
def test_the_corners_of_the_other_face_lie_along_the_normals_of_the_skin(depth: float) -> None:
    square = random_panel(3, chain="cone").squared(depth)
    assert square.offset(depth).corners() == pytest.approx(square.corners() + depth * square.normals, abs=LENGTH)
