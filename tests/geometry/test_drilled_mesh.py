"""Holes in meshes to look at: nothing else of the skin is lost, and their walls stand where they are drilled."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.features.catalogue import feature
from cadpanel.geometry.drilled_mesh import ROUND, drilled_mesh, hole_count, hole_rims
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.sheet_checks import other_face, sheet_depth
from cadpanel.geometry.skin_mesh import SkinMesh, skin_mesh
from tests.drilled import fixed
from tests.instances import random_polygon, random_shapes
from tests.trays import tray

NOTCH = np.array([(0, 0), (2000, 0), (2000, 1500), (1000, 400), (0, 1500)], dtype=np.float64)
CHAINS = ("planar-quadrilateral", "plane-cylinder-plane", "plane-cone-plane", "cone-spline-4")
SHAPES = [
    *(
        random_shapes(feature(name), 4, 1)[0]
        for name in ("planar-quadrilateral", "plane-cylinder-plane", "plane-cone-plane", "cone-spline-4")
    ),
    random_polygon(3, 6),
    PolygonShape(
        name="notch",
        feature="polygon",
        outline=np.column_stack([NOTCH, np.zeros(5)]),
        normal=np.array([0.0, 0.0, 1.0]),
    ),
    tray(),
]
BENT = SHAPES[1:4]
SHEET = SheetSettings()


def doubled_areas(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def square_mesh(scale):
    """A square of 40 in cells of 10, at a scale, away from its chart's middle."""
    places = scale * (np.array([130.0, -60.0]) + np.stack(np.meshgrid(*2 * [np.arange(-20.0, 21.0, 10.0)]), axis=-1))
    corner = np.arange(25).reshape(5, 5)
    here, right, up, far = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    triangles = np.stack([here, right, far, here, far, up], axis=-1).reshape(-1, 3)
    chart = places.reshape(-1, 2)
    return SkinMesh(
        points=np.column_stack([chart, np.zeros(25)]),
        triangles=triangles,
        chart=chart,
        ways=np.broadcast_to(np.eye(3)[:2], (25, 2, 3)),
        patches=np.zeros(len(triangles), dtype=np.intp),
    )


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize(("x", "y"), [(131.3, -59.3), (121.0, -67.0), (135.0, -55.0)])
def test_vertices_near_a_hole_go_and_all_others_stay(scale, x, y):
    """Those nearer to its middle than 1.4 radii, but for the border's; at any size, and anywhere on the chart."""
    mesh, radius = square_mesh(scale), scale * 8.0
    turns = 2.0 * np.pi * np.arange(ROUND) / ROUND
    middle = scale * np.array([x, y])
    rim = np.column_stack([middle + radius * np.stack([np.cos(turns), np.sin(turns)], axis=-1), np.zeros(ROUND)])
    down = np.array([0.0, 0.0, -3.0])
    made = drilled_mesh(mesh, mesh.points + down, np.stack([rim, rim + down])[:, None])
    assert made.other == pytest.approx(made.points + down)
    doubled = doubled_areas(made)[:, 2]
    assert (doubled > 0.0).all()
    hole = 0.5 * ROUND * np.sin(2.0 * np.pi / ROUND) * radius**2
    assert 0.5 * doubled.sum() == pytest.approx(1600.0 * scale**2 - hole)
    assert hole_count(made.triangles) == 1
    border = np.abs(mesh.chart - scale * np.array([130.0, -60.0])).max(axis=1) > 15.0 * scale
    stay = border | (np.linalg.norm(mesh.chart - middle, axis=1) > 1.4 * radius)
    wanted = np.concatenate([mesh.points[stay], rim])
    assert np.array(sorted(made.points.tolist())) == pytest.approx(np.array(sorted(wanted.tolist())))


def test_holes_are_counted_whatever_hangs_together():
    """Vertices that no triangle has count for nothing."""
    four = np.arange(4)
    after = np.roll(four, -1)
    ring = np.concatenate([np.stack([four, after, after + 4], axis=-1), np.stack([four, after + 4, four + 4], axis=-1)])
    disc = np.array([[0, 1, 2], [0, 2, 3]])
    assert hole_count(disc) == 0
    assert hole_count(ring) == 1
    assert hole_count(np.concatenate([ring, disc + 20])) == 1
    assert hole_count(np.concatenate([disc + 3, ring + 11, ring + 40])) == 2


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: f"{type(shape).__name__} {shape.feature}")
def test_triangles_run_counterclockwise_on_the_chart(shape):
    mesh = skin_mesh(shape)
    corners = mesh.chart[mesh.triangles]
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    assert (ux * vy - uy * vx > 0.0).all()


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: f"{type(shape).__name__} {shape.feature}")
def test_a_mesh_with_holes_has_the_skin_without_them(shape):
    found, holes = fixed(shape, SHEET, ShopSettings(fixings=(6.0, 400.0, 12.0), k_factor=0.5))
    assert len(holes) >= 4
    depth = sheet_depth(SHEET.thickness, SHEET.skin_side)
    whole, other = skin_mesh(shape), skin_mesh(other_face(shape, SHEET.thickness, SHEET.skin_side)).points
    rims = hole_rims(holes, depth)
    made = drilled_mesh(whole, other, rims)
    doubled, before = doubled_areas(made), doubled_areas(whole)
    share = ROUND / (2.0 * np.pi) * np.sin(2.0 * np.pi / ROUND)
    lost, area = (0.5 * np.linalg.norm(one, axis=1).sum() for one in (before, doubled))
    # On bends other triangles between the same points are a little larger.
    assert lost - area == pytest.approx(share * found.area, rel=1e-3, abs=(1e-4 if shape in BENT else 1e-9) * area)
    # Every side of every rim is a border of the mesh, and the sheet is on the right side of it.
    outward = (made.points - made.other)[made.triangles].mean(axis=1) * -np.sign(depth)
    assert (np.einsum("fx,fx->f", doubled, outward) > 0.0).all()
    sides = made.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    single = {tuple(side) for side in sides.tolist()} - {tuple(side) for side in sides[:, ::-1].tolist()}
    border = np.array(sorted(single))
    for near, far in zip(rims[0], rims[1], strict=True):
        apart = np.linalg.norm(made.points[border[:, 0], None] - near, axis=-1)
        on = border[apart.min(axis=1) < 1e-9]
        assert len(on) == ROUND
        assert np.linalg.norm(made.other[on[:, 0], None] - far, axis=-1).min(axis=1).max() < 1e-9
    assert len(np.unique(made.triangles)) == len(made.points)
