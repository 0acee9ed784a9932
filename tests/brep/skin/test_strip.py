"""The long edges of a strip, and planes across it: square to it, through both edges, equally far along."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.TopoDS import TopoDS

from cadpanel.brep.skin.strip import Strip, find_strip
from cadpanel.errors import ReferenceFileError
from tests.cuts import surface_of
from tests.known_faces import arc_face, flat
from tests.model_files import strip_faces

PARTS = np.linspace(0.1, 0.9, 5)
seeds = st.integers(0, 2**32 - 1)


def found(*faces, tolerance=1.0):
    return find_strip(surface_of(*faces, tolerance=tolerance), "roof.step", tolerance)


def rectangle(length, width, turn=0.0):
    corners = np.array([(0.0, 0.0), (length, 0.0), (length, width), (0.0, width)])
    c, s = np.cos(turn), np.sin(turn)
    return flat([(c * x - s * y, s * x + c * y, 0.0) for x, y in corners])


@settings(max_examples=10)
@given(length=st.floats(1000.0, 9000.0), share=st.floats(0.1, 0.9), turn=st.floats(-np.pi, np.pi))
def test_a_rectangle_runs_along_its_longer_side_from_where_its_axis_begins(length, share, turn):
    strip = found(rectangle(length, share * length, turn))
    assert strip.length == pytest.approx(length, rel=1e-9)
    assert strip.girth >= share * length * (1.0 - 1e-9)
    way = np.mean([edge[-1] - edge[0] for edge in strip.edges], axis=0)
    assert way[np.abs(way).argmax()] > 0.0
    np.testing.assert_allclose(np.linalg.norm(strip.points(PARTS)[1] - strip.points(PARTS)[0], axis=1), share * length)


def test_a_short_bent_strip_runs_the_way_in_which_it_does_not_bend():
    assert found(arc_face(500.0, 0.0, 150.0, length=200.0)).length == pytest.approx(200.0)


def test_order_and_side_of_the_faces_change_nothing():
    faces = strip_faces()
    strip = found(*faces)
    other = found(*(TopoDS.Face_s(face.Reversed()) for face in faces[::-1]))
    ends, others = (sorted(np.round([edge[0] for edge in one.edges], 6).tolist()) for one in (strip, other))
    assert ends == others
    assert other.length == pytest.approx(strip.length)


@settings(max_examples=20)
@given(seed=seeds)
def test_planes_pass_through_both_edges_square_to_the_way_along_them(seed):
    """Edges that wander: their chords have any direction."""
    random = np.random.default_rng(seed)
    x = np.linspace(0.0, 4000.0, 60)

    def edge(side):
        sway = 200.0 * np.sin(x / 900.0 + random.uniform(0.0, 6.0))
        return np.stack([x, side + sway, 100.0 * np.cos(x / 700.0)], axis=1)

    strip = Strip(edges=(edge(0.0), edge(800.0)), girth=1000.0)
    cuts = strip.planes(PARTS)
    for points in strip.points(PARTS):
        np.testing.assert_allclose(np.sum((points - cuts.origins) * cuts.normals, axis=1), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(cuts.normals, axis=1), 1.0)
    assert (cuts.normals[:, 0] > 0.5).all()
    # What the middle line passes as it goes on.
    assert (np.diff(cuts.places) >= 0.0).all()
    assert cuts.places[[0, -1]].tolist() == [0.0, len(PARTS) + 1.0]
    behind = np.einsum("qkd,kd->qk", cuts.line[:, None] - cuts.origins, cuts.normals) > 0.0
    assert (np.abs(behind.sum(axis=1) - cuts.places) <= 1.0 + 1e-9).all()


def straight(x):
    return np.stack([x, 0.0 * x, 0.0 * x], axis=1)


def test_points_stand_at_equal_parts_of_each_edge():
    uneven, even = np.linspace(0.0, 1.0, 30) ** 2 * 1000.0, np.linspace(0.0, 500.0, 20)
    edges = straight(uneven), straight(even)
    strip = Strip(edges=edges, girth=50.0)
    np.testing.assert_allclose(strip.points(PARTS)[0][:, 0], 1000.0 * PARTS)
    np.testing.assert_allclose(strip.points(PARTS)[1][:, 0], 500.0 * PARTS)
    assert strip.length == pytest.approx(750.0)


def test_edges_that_meet_give_a_plane_no_direction_but_the_way_on():
    line = straight(np.linspace(0.0, 1000.0, 20))
    cuts = Strip(edges=(line, line + np.array([0.0, 1.0, 0.0])), girth=100.0).planes(np.array([0.5]))
    np.testing.assert_allclose(cuts.normals, [(1.0, 0.0, 0.0)], atol=1e-12)


def test_a_triangle_is_no_strip():
    with pytest.raises(ReferenceFileError, match=r"of 'roof.step' has 3 sides where a strip has 4\.$"):
        found(flat([(0, 0, 0), (3000, 0, 0), (0, 2000, 0)]))
