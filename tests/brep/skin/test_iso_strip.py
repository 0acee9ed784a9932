"""Faces side by side as lanes: they share a parameter, run one way, and are cut at equal parts into exact pieces."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.skin.iso_strip import COMMON, Lane, find_lanes
from cadpanel.brep.splitting.splitter import area_of
from tests.cuts import surface_of
from tests.known_faces import arc_face, bezier_surface, face_on
from tests.model_files import strip_faces

PARTS = np.linspace(0.0, 1.0, 5)
LENGTH, WIDTH = 4000.0, 500.0


def plate(index, *, along_v=False, backwards=False, length=LENGTH):
    """One of the plates of a flat strip along x, its parameters in whatever order."""
    poles = np.array([[(x, WIDTH * (index + k), 0.0) for k in (0, 1)] for x in (0.0, length)])
    poles = poles[::-1] if backwards else poles
    return face_on(bezier_surface(poles.swapaxes(0, 1) if along_v else poles))


def twisted(index, *, along_v=False, backwards=False):
    """The same, but wound about x, so that its normals turn faster along y than along x."""
    angles = 0.5 * (index + np.array([0.0, 1.0, 2.0]) / 2.0)
    section = np.stack([2000.0 * np.sin(angles), 2000.0 * np.cos(angles)], axis=1)
    poles = np.array([[(x, *place) for place in section] for x in (0.0, LENGTH / 3.0, LENGTH)])
    poles = poles[::-1] if backwards else poles
    return face_on(bezier_surface(poles.swapaxes(0, 1) if along_v else poles))


ways = st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=4)


@settings(max_examples=10)
@given(ways=ways)
def test_lanes_are_found_whatever_their_parameters_and_run_along_the_strip_from_one_end(ways):
    faces = [twisted(index, along_v=one, backwards=other) for index, (one, other) in enumerate(ways)]
    lanes = find_lanes(surface_of(*faces))
    assert lanes is not None
    assert len(lanes.lanes) == len(faces)
    assert len(lanes.joints) >= len(faces) - 1
    for part, x in ((0.0, 0.0), (1.0, LENGTH)):
        edges = lanes.edges(np.array([part]))
        np.testing.assert_allclose(edges[..., 0], x, atol=1e-9)
    order = lanes.order()
    assert order is not None
    assert [index for index, _ in order] in (list(range(len(faces))), list(range(len(faces)))[::-1])


@settings(max_examples=10)
@given(ways=ways, cuts=st.lists(st.floats(0.05, 0.95), min_size=1, max_size=3, unique=True))
def test_pieces_lie_between_their_cuts_and_keep_the_whole_area(ways, cuts):
    faces = [plate(index, along_v=one, backwards=other) for index, (one, other) in enumerate(ways)]
    lanes = find_lanes(surface_of(*faces, tolerance=0.1))
    assert lanes is not None
    parts = np.array([0.0, *sorted(cuts), 1.0])
    groups = lanes.cut(parts)
    assert [len(group) for group in groups] == [len(faces)] * (len(parts) - 1)
    for group, first, last in zip(groups, parts, parts[1:], strict=False):
        assert area_of_all(group) == pytest.approx((last - first) * LENGTH * WIDTH * len(faces), rel=1e-9)


def area_of_all(faces):
    return sum(map(area_of, faces))


def test_turning_all_lanes_round_turns_their_edges_and_their_reach_round():
    lanes = find_lanes(surface_of(*strip_faces()))
    assert lanes is not None
    back = lanes.turned()
    np.testing.assert_allclose(back.edges(PARTS), lanes.edges(1.0 - PARTS))
    np.testing.assert_allclose(back.middles(PARTS), lanes.edges(1.0 - PARTS).mean(axis=0))
    np.testing.assert_allclose(back.reach()[-1] - back.reach()[::-1], lanes.reach(), atol=1e-6)
    np.testing.assert_allclose(back.at_lengths(PARTS), 1.0 - lanes.at_lengths(1.0 - PARTS), atol=1e-6)


def test_reach_width_and_even_lengths_of_a_flat_strip_are_plain():
    lanes = find_lanes(surface_of(plate(0), plate(1)))
    assert lanes is not None
    np.testing.assert_allclose(lanes.reach(), np.linspace(0.0, LENGTH, len(lanes.reach())), atol=1e-9)
    np.testing.assert_allclose(lanes.at_lengths(PARTS), PARTS, atol=1e-12)
    assert lanes.width == pytest.approx(2.0 * WIDTH)


def test_parts_by_length_are_reached_where_the_long_edges_have_come_that_far():
    lanes = find_lanes(surface_of(twisted(0), twisted(1)))
    assert lanes is not None
    for part in (0.2, 0.5, 0.9):
        along = np.linspace(0.0, float(lanes.at_lengths(np.array([part]))[0]), 400)
        walked = np.linalg.norm(np.diff(lanes.edges(along), axis=1), axis=-1).sum(axis=1).mean()
        assert walked == pytest.approx(part * lanes.reach()[-1], rel=1e-5)


def test_a_strip_runs_the_way_in_which_its_normals_turn_slowly_however_short_it_is():
    assert axis_of(arc_face(300.0, 0.0, 120.0, length=100.0)) == 1  # along it, though the arc is six times as long
    assert axis_of(plate(0, length=600.0)) == 0
    assert axis_of(plate(0, length=400.0)) == 1


def axis_of(face):
    lanes = find_lanes(surface_of(face))
    assert lanes is not None
    return lanes.lanes[0].axis


@pytest.mark.parametrize(("off", "common"), [(0.5 * COMMON, True), (2.0 * COMMON, False)])
def test_borders_that_share_no_parameter_are_no_lanes(off, common):
    """The second plate is drawn so that equal parts of its border lie beside those of the first."""
    bent = [[(x, y, 0.0) for y in (WIDTH, 2.0 * WIDTH)] for x in (0.0, 0.5 * LENGTH + 2.0 * off, LENGTH)]
    assert (find_lanes(surface_of(plate(0), face_on(bezier_surface(bent)))) is not None) == common


def test_trimmed_faces_and_plates_that_meet_end_to_end_are_no_lanes():
    apart = [[(x, y, 0.0) for y in (0.0, WIDTH)] for x in (LENGTH, 2.0 * LENGTH)]
    assert find_lanes(surface_of(plate(0), face_on(bezier_surface(apart)))) is None


def test_a_tube_has_no_long_edges_and_a_reversed_lane_begins_at_the_other_end():
    tube = find_lanes(surface_of(arc_face(300.0, 0.0, 360.0, length=2000.0)))
    assert tube is not None
    assert tube.outer == ()
    assert tube.order() is None
    lane = Lane(patch=patch_of(TopoDS.Face_s(plate(0))), axis=0, forward=False)
    np.testing.assert_allclose(lane.border(0.0, np.array([0.0, 1.0]))[:, 0], [LENGTH, 0.0])
    np.testing.assert_allclose(lane.end(0.0, np.array([0.0, 1.0]))[:, 1], [0.0, WIDTH])
    assert lane.turned().own(PARTS).tolist() == PARTS.tolist()
