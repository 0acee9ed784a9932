"""Laws of joints: how wide they are, and what does not change them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from cadpanel.geometry.joints import cut_to_seams, seam_planes, walls_of
from cadpanel.geometry.sheet_checks import check_buildable
from tests.joined import hexagons, quadrilaterals, seams, turned

pytestmark = pytest.mark.each_value_once

CLOSE = 1e-8  # mm
GRIDS = {"quadrilaterals": quadrilaterals(), "skew": quadrilaterals(skew=0.3), "hexagons": hexagons()}
# How far panels may be set back where four meet in a corner, in mm.
SET_BACK = {"quadrilaterals": 0.4, "skew": 0.7, "hexagons": CLOSE}
every_grid = pytest.mark.parametrize("name", GRIDS)
every_sheet = pytest.mark.parametrize("depth", [-3.0, -20.0, 20.0])


def faces(panel, depth):
    return panel, panel.offset(depth)


@every_grid
@every_sheet
@pytest.mark.parametrize("joint", [10.0, 20.0])
def test_a_joint_is_as_wide_as_was_asked_for_along_the_whole_seam_on_both_faces(name, depth, joint):
    panels = GRIDS[name]
    cut = cut_to_seams(panels, seams(panels), joint, depth)
    for seam, found in zip(seams(panels), cut.joints, strict=True):
        assert found.recut == pytest.approx(0.0, abs=CLOSE)
        for place, sign in ((0, -1.0), (1, 1.0)):
            for face in faces(cut.shapes[seam.panels[place]], depth):
                off = found.plane.beyond(face.edge(seam.edges[place]).corners)
                assert off == pytest.approx(sign * 0.5 * joint, abs=CLOSE)


@every_grid
@every_sheet
def test_without_a_joint_neighbours_touch_and_no_sheet_reaches_into_another(name, depth):
    panels = GRIDS[name]
    cut = cut_to_seams(panels, seams(panels), 0.0, depth)
    for shape in cut.shapes:
        check_buildable(shape, abs(depth), "outer" if depth < 0.0 else "inner")
    for seam, found in zip(seams(panels), cut.joints, strict=True):
        for place, sign in ((0, -1.0), (1, 1.0)):
            corners = [face.edge(seam.edges[place]).corners for face in faces(cut.shapes[seam.panels[place]], depth)]
            off = sign * found.plane.beyond(np.concatenate(corners))
            assert off.min() >= -CLOSE
            assert off.max() <= SET_BACK[name]


@every_grid
def test_free_edges_stay_where_they_are(name):
    panels = GRIDS[name]
    cut = cut_to_seams(panels, seams(panels), 20.0, -3.0)
    joined = {(panel, edge) for seam in seams(panels) for panel, edge in zip(seam.panels, seam.edges, strict=True)}
    for i, panel in enumerate(panels):
        for edge in {f"edge {k}" for k in range(len(panel.outline))} - {own for place, own in joined if place == i}:
            was = panel.edge(edge)
            for face in faces(cut.shapes[i], -3.0):
                across = (face.edge(edge).corners - was.corners[0]) @ was.outward
                assert across == pytest.approx(0.0, abs=CLOSE)


@every_grid
@pytest.mark.parametrize("joint", [0.0, 10.0])
def test_moving_the_input_moves_the_result(name, joint):
    rotation, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    rotation *= np.sign(np.linalg.det(rotation))
    shift = np.array([3000.0, -4000.0, 500.0])
    panels = GRIDS[name]
    there = cut_to_seams([turned(panel, rotation, shift) for panel in panels], seams(panels), joint, -3.0)
    for panel, moved in zip(cut_to_seams(panels, seams(panels), joint, -3.0).shapes, there.shapes, strict=True):
        assert moved.corners() == pytest.approx(panel.corners() @ rotation.T + shift, abs=1e-7)


@every_grid
@pytest.mark.parametrize("joint", [0.0, 10.0])
def test_the_order_of_the_panels_and_of_the_two_sides_of_a_seam_change_nothing(name, joint):
    panels = GRIDS[name]
    found = {panel.name: panel for panel in cut_to_seams(panels, seams(panels), joint, -20.0).shapes}
    mixed = [panels[i] for i in np.random.default_rng(2).permutation(len(panels))]
    swapped = [replace(seam, panels=seam.panels[::-1], edges=seam.edges[::-1]) for seam in seams(mixed)]
    for panel in cut_to_seams(mixed, swapped, joint, -20.0).shapes:
        assert panel.corners() == pytest.approx(found[panel.name].corners(), abs=CLOSE)
        far = panel.offset(-20.0).corners()
        assert far == pytest.approx(found[panel.name].offset(-20.0).corners(), abs=CLOSE)


def test_the_sheet_is_the_same_whichever_of_its_faces_is_the_skin():
    panels = hexagons()
    inner: Any = [panel.offset(-20.0) for panel in cut_to_seams(panels, seams(panels), 0.0, -20.0).shapes]
    outer = cut_to_seams(inner, seams(inner), 10.0, 20.0)
    same = cut_to_seams(panels, seams(panels), 10.0, -20.0)
    for one, other in zip(outer.shapes, same.shapes, strict=True):
        assert one.offset(20.0).corners() == pytest.approx(other.corners(), abs=1e-6)


def test_panels_without_seams_stay_as_they_are():
    panels = quadrilaterals(1)
    assert cut_to_seams(panels, [], 20.0, -3.0).shapes == tuple(panels)


@pytest.mark.parametrize(("joint", "jointed"), [(0.0, False), (0.1, True), (8.0, True)])
def test_walls_stand_half_a_joint_behind_their_plane_and_say_whether_there_is_one(joint, jointed):
    panels = hexagons()
    found = seams(panels)
    planes = seam_planes(panels, found)
    walls = walls_of(len(panels), found, planes, joint)
    for seam, plane in zip(found, planes, strict=True):
        own, other = (walls[panel][edge] for panel, edge in zip(seam.panels, seam.edges, strict=True))
        assert (own.jointed, other.jointed) == (jointed, jointed)
        assert own.normal == pytest.approx(-other.normal)
        assert plane.beyond(np.array([own.point, other.point])) == pytest.approx([-0.5 * joint, 0.5 * joint])
