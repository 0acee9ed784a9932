"""Straight edges that go on from each other become one polyline; not what turns, or is labelled otherwise."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepAdaptor import BRepAdaptor_Curve

from cadpanel.brep.curves.polyline_joining import MEET, joined
from cadpanel.brep.files.model import Label, ModelCurve
from tests.drawn import circle, line

MOST = 0.1


def arc(count, radius=5000.0, turn=0.4):
    angles = np.linspace(0.0, turn, count + 1)
    return np.stack([radius * np.sin(angles), radius - radius * np.cos(angles), 0.0 * angles], axis=1)


def drawn(points, flips=(), layers=()):
    """One edge a segment, some drawn the other way round, on layers."""
    found = []
    for k, (first, last) in enumerate(pairwise(points)):
        ends = (last, first) if k in flips else (first, last)
        found.append(ModelCurve(label=Label(layer=layers[k] if layers else ""), edge=line(*ends)))
    return found


def corners(edge):
    curve = BRepAdaptor_Curve(edge)
    places = np.arange(curve.FirstParameter(), curve.LastParameter() + 0.5)
    return np.array([curve.Value(place).Coord() for place in places.tolist()])


@settings(max_examples=15)
@given(count=st.integers(2, 12), flips=st.sets(st.integers(0, 11)))
def test_segments_of_a_fine_polyline_are_joined_whichever_way_each_is_drawn(count, flips):
    points = arc(count, turn=0.01 * count)
    ((number, curve),) = joined(drawn(points, flips), MOST)
    assert number == 1
    found = corners(curve.edge)
    assert len(found) == count + 1
    if not np.allclose(found[0], points[0]):
        found = found[::-1]
    np.testing.assert_allclose(found, points, atol=MEET)


@pytest.mark.parametrize(("gap", "pieces"), [(0.5 * MEET, 1), (2.0 * MEET, 2)])
def test_segments_apart_are_joined_up_to_a_hair(gap, pieces):
    edges = [line((0, 0, 0), (100, 0, 0)), line((100.0 + gap, 0, 0), (200, 0, 0))]
    assert len(joined([ModelCurve(label=Label(), edge=edge) for edge in edges], MOST)) == pieces


@pytest.mark.parametrize(("turn", "pieces"), [(0.9, 1), (1.1, 2)])
def test_segments_that_turn_are_joined_while_a_smooth_curve_past_the_turn_keeps_close(turn, pieces):
    """An eighth of the shorter segment times the turn: 100 mm / 8 * 0.008 rad are 0.1 mm."""
    angle = 0.008 * turn
    points = [(0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (100.0 + 300.0 * np.cos(angle), 300.0 * np.sin(angle), 0.0)]
    assert len(joined(drawn(points), MOST)) == pieces


def test_other_curves_and_other_labels_part_and_keep_their_places_in_the_file():
    points = arc(4, turn=0.04)
    ring = ModelCurve(label=Label(), edge=circle((0.0, 0.0, 500.0), 20.0))
    curves = [*drawn(points[:3]), ring, *drawn(points[2:])]
    found = joined(curves, MOST)
    assert [number for number, _ in found] == [1, 3, 4]
    assert found[1][1].edge.IsSame(ring.edge)
    assert [number for number, _ in joined(drawn(points, layers=("a", "a", "b", "b")), MOST)] == [1, 3]


def test_a_segment_alone_and_no_curves_stay_as_they_are():
    (single,) = drawn(arc(1))
    assert joined([single], MOST) == [(1, single)]
    assert joined([], MOST) == []
