"""Surfaces that close to a ring are divided round it, where a panel does not have to go round."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeRevol, BRepPrimAPI_MakeTorus
from OCP.gp import gp_Ax1, gp_Ax2, gp_Circ, gp_Dir, gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location

from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import ReferenceFileError
from tests.cuts import assert_covers, middle, model_of, panels_of, reference_of
from tests.reference_shapes import kernel_face, ring
from tests.thorough import thorough

RADIUS, HEIGHT = 2000.0, 800.0


def belt(count, *, taper=0.0, uneven=0.0):
    """Faces round the z axis, of a cone or cylinder; with `uneven` their parameter runs unevenly round it."""

    def part(place):
        def surface(u, v):
            angle = 2.0 * np.pi * (place + v + uneven * v * (1.0 - v)) / count
            radius = RADIUS - taper * u
            return np.stack([radius * np.cos(angle), radius * np.sin(angle), HEIGHT * u + 0.0 * v], axis=-1)

        return kernel_face(surface, (0.0, 1.0), poles=30)

    return [part(place) for place in range(count)]


def side_of(solid):
    return shapes_of(solid.Shape(), TopAbs_FACE)[0]


@pytest.mark.parametrize("parts", [1, 2, 4])
@pytest.mark.parametrize("taper", [0.0, 300.0])
@pytest.mark.parametrize("count", [2, 7, 8])
def test_a_ring_of_faces_is_divided_round_into_equal_panels_that_meet_all_round(tmp_path, parts, taper, count):
    faces = belt(parts, taper=taper, uneven=0.3)
    reference = reference_of(tmp_path, *faces, divide=count)
    assert [panel.name for panel in reference.panels] == [f"S1-{place:02d}" for place in range(1, count + 1)]
    assert len(reference.seams) == count
    areas = [panel.weights.sum() for panel in reference.panels]
    np.testing.assert_allclose(areas, sum(map(area_of, faces)) / count, rtol=1e-3)
    assert {len(panel.edges) for panel in reference.panels} == {4}


@given(order=st.permutations([0, 1, 2, 3]), flips=st.lists(st.booleans(), min_size=4, max_size=4))
@settings(max_examples=8, deadline=None)
def test_order_and_side_of_a_rings_faces_change_nothing(order, flips):
    faces = belt(4)
    turned = [faces[index].Reversed() if flips[index] else faces[index] for index in order]
    for first, second in zip(
        panels_of(model_of(*faces), divide=6), panels_of(model_of(*turned), divide=6), strict=True
    ):
        assert first.name == second.name
        np.testing.assert_allclose(middle(first), middle(second), atol=1.0)


def test_a_ring_of_folds_is_divided_round():
    faces = [kernel_face(surface, poles=40) for surface in ring(4)]
    panels = panels_of(model_of(*faces), divide=6)
    assert_covers(panels, faces)
    assert [len(panel.faces) for panel in panels] == [1, 2, 1, 1, 2, 1]


def test_a_joint_a_hair_beside_a_cut_leaves_no_sliver():
    faces = belt(4, uneven=1e-4)
    panels = panels_of(model_of(*faces), divide=8)
    assert_covers(panels, faces)
    assert [len(panel.faces) for panel in panels] == [1] * 8


def test_a_cone_is_divided_into_sectors_up_to_its_apex(tmp_path):
    cone = side_of(BRepPrimAPI_MakeCone(2000.0, 0.0, 1000.0))
    reference = reference_of(tmp_path, cone, divide=5)
    assert len(reference.seams) == 5
    assert {len(panel.edges) for panel in reference.panels} == {3}


@pytest.mark.parametrize(
    ("solid", "count", "sentence"),
    [
        (
            BRepPrimAPI_MakeCylinder(RADIUS, HEIGHT),
            1,
            "closes to a ring, and a panel cannot go round: divide it into a number",
        ),
        (BRepPrimAPI_MakeCylinder(500.0, 6000.0), 4, "closed round its length, and a panel cannot go round: cut it b"),
        (BRepPrimAPI_MakeTorus(2000.0, 400.0), 4, "closed round its length, and a panel cannot go round: cut it both"),
    ],
)
def test_what_a_panel_would_have_to_go_round_is_refused(solid, count, sentence):
    with pytest.raises(ReferenceFileError, match=sentence):
        panels_of(model_of(side_of(solid)), divide=count)
    assert_covers(panels_of(model_of(side_of(solid)), grid=(4, 2)), [side_of(solid)])


def rows(*borders):
    """Faces of a roof edge all round, in three rows that are parted at the same or at other places, as parts of a turn.

    Args:
        borders: for each row where its faces begin.
    """
    arc = gp_Circ(gp_Ax2(gp_Pnt(6000.0, 0.0, 300.0), gp_Dir(0.0, -1.0, 0.0)), 300.0)
    profile = [
        BRepBuilderAPI_MakeEdge(gp_Pnt(5000.0, 0.0, -300.0), gp_Pnt(6000.0, 0.0, 0.0)).Edge(),
        BRepBuilderAPI_MakeEdge(arc, gp_Pnt(6000.0, 0.0, 0.0), gp_Pnt(6300.0, 0.0, 300.0)).Edge(),
        BRepBuilderAPI_MakeEdge(gp_Pnt(6300.0, 0.0, 300.0), gp_Pnt(6300.0, 0.0, 900.0)).Edge(),
    ]
    axis = gp_Ax1(gp_Pnt(), gp_Dir(0.0, 0.0, 1.0))

    def part(row, first, last):
        turned = gp_Trsf()
        turned.SetRotation(axis, 2.0 * np.pi * first)
        edge = profile[row].Moved(TopLoc_Location(turned))
        return shapes_of(BRepPrimAPI_MakeRevol(edge, axis, 2.0 * np.pi * (last - first)).Shape(), TopAbs_FACE)[0]

    return [
        part(row, first, last)
        for row, starts in enumerate(borders)
        for first, last in pairwise((*starts, 1.0 + starts[0]))
    ]


@pytest.mark.parametrize("starts", [(0.0,), (0.0, 0.5), (0.0, 0.1, 0.7), (0.2, 0.4, 0.6, 0.8)])
@pytest.mark.parametrize("count", [2, 8])
def test_a_ring_of_several_rows_is_divided_round_into_equal_panels(tmp_path, starts, count):
    faces = rows(starts, starts, starts)
    reference = reference_of(tmp_path, *faces, divide=count)
    assert len(reference.seams) == count
    areas = [panel.weights.sum() for panel in reference.panels]
    np.testing.assert_allclose(areas, sum(map(area_of, faces)) / count, rtol=1e-3)
    assert {len(panel.edges) for panel in reference.panels} == {4}


@given(order=st.permutations(range(9)), flips=st.lists(st.booleans(), min_size=9, max_size=9))
@settings(max_examples=6, deadline=None)
@thorough
def test_order_and_side_of_the_faces_of_rows_change_nothing(order, flips):
    faces = rows(*[(0.0, 0.1, 0.7)] * 3)
    turned = [faces[index].Reversed() if flips[index] else faces[index] for index in order]
    for first, second in zip(
        panels_of(model_of(*faces), divide=5), panels_of(model_of(*turned), divide=5), strict=True
    ):
        assert first.name == second.name
        np.testing.assert_allclose(middle(first), middle(second), atol=1.0)


def test_a_ring_of_rows_with_joints_of_their_own_is_divided_across_all_of_them():
    faces = rows((0.0, 0.3), (0.0, 0.4), (0.0, 0.3))
    panels = panels_of(model_of(*faces), divide=8)
    assert len(panels) == 8
    assert_covers(panels, faces)
    assert_covers(panels_of(model_of(*faces), grid=(1, 2)), faces)
