"""Holes in meshes to look at: nothing else of the skin is lost, and their walls stand where they are drilled."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.features.catalogue import feature
from cadpanel.geometry.drilled_mesh import ROUND, drilled_mesh, hole_rims
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.sheet_checks import other_face, sheet_depth
from cadpanel.geometry.skin_mesh import skin_mesh
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
