"""Pictures lie on the faces of their panels and reach their corners, or it is said which do not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.delivery.page.packing import packed, unpacked
from cadpanel.delivery.page.picture_checks import off_their_panels
from cadpanel.delivery.page.scene import PanelScene
from cadpanel.features.catalogue import feature
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import sheet_depth
from cadpanel.geometry.skin_mesh import skin_mesh
from tests.instances import NAMES, random_polygon, random_shapes
from tests.pages import delivery, scene
from tests.trays import THICKNESS, tray

DEPTH = sheet_depth(3.0, "outer")


def off(panel: PanelScene, shape: Panel, depth: float = DEPTH) -> bool:
    return list(off_their_panels(iter([(panel, shape)]), depth)) == [panel.name]


def test_what_comes_back_from_a_page_is_where_the_panels_are() -> None:
    shown = zip(unpacked(packed(scene())).panels, delivery().shapes, strict=True)
    assert list(off_their_panels(shown, DEPTH)) == []


@pytest.mark.parametrize("change", ["a vertex up", "all aside", "short of a corner", "too thick"])
def test_what_lies_elsewhere_is_named(change: str) -> None:
    panel, shape = scene().panels[0], delivery().shapes[0]
    points, other = panel.points.copy(), panel.other.copy()
    corner = shape.corners().reshape(-1, 3)[0]
    if change == "a vertex up":
        points[7] += [0.2, 0.2, 0.2]
    elif change == "all aside":
        points, other = points + 1.0, other + 1.0
    elif change == "short of a corner":
        near = np.linalg.norm(points - corner, axis=-1).argmin()
        points[near] = points[near - 3]
    else:
        other += 0.3 * (other - points) / 3.0
    assert not off(panel, shape)
    assert off(replace(panel, points=points, other=other), shape)


def shapes() -> list[Panel]:
    return [*(random_shapes(feature(name), 5, 1)[0] for name in NAMES), random_polygon(3, 6), tray()]


@pytest.mark.parametrize("shape", shapes(), ids=lambda shape: f"{shape.feature} {type(shape).__name__}")
def test_every_kind_of_panel_is_where_its_mesh_is(shape: Panel) -> None:
    depth = sheet_depth(THICKNESS, "outer")
    points, other = skin_mesh(shape).points, skin_mesh(shape.offset(depth)).points
    assert not off(replace(scene().panels[0], points=points, other=other), shape, depth)
    assert off(replace(scene().panels[0], points=points + 0.5, other=other), shape, depth)
