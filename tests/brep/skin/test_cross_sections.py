"""Sections across a strip: as long as the strip is across, and turned as far as it bends, on either way of walking."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.brep.skin.cross_sections import CrossSection, Sections, sections_of
from tests.cuts import surface_of
from tests.known_faces import arc_face, flat

PARTS = np.array([0.25, 0.5, 0.75])
LENGTH = 3000.0


@settings(max_examples=8)
@given(stops=st.lists(st.integers(1, 16), min_size=1, max_size=3, unique=True), radius=st.floats(300.0, 3000.0))
def test_sections_of_a_bent_sheet_are_arcs_of_its_radius_and_turn_as_far(stops, radius):
    stops = [0.0, *(10.0 * stop for stop in sorted(stops))]
    faces = [arc_face(radius, first, last, LENGTH) for first, last in pairwise(stops)]
    found = sections_of(surface_of(*faces), PARTS, "roof.step", 1.0)
    bend = np.radians(stops[-1])
    assert found.lanes is not None
    assert found.strip_length == pytest.approx(LENGTH)
    for section, part in zip(found.sections, PARTS, strict=True):
        assert section.length[-1] == pytest.approx(radius * bend, rel=1e-4)
        assert section.turn[-1] == pytest.approx(bend, rel=1e-6)
        # It turns evenly on the way, and keeps to its plane and to its radius.
        np.testing.assert_allclose(section.turn, section.length / radius, atol=1e-4)
        np.testing.assert_allclose(section.points[:, 0], part * LENGTH, atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(section.points[:, 1:], axis=1), radius, rtol=1e-9)
        np.testing.assert_allclose(section.at(section.length[[0, -1]]), section.points[[0, -1]])
    lengths, turns = found.mean
    assert (lengths[-1], turns[-1]) == pytest.approx((radius * bend, bend), rel=1e-4)


def test_a_folded_strip_of_planes_turns_at_its_folds_alone():
    corner = (800.0 + 600.0 * np.cos(0.3), 600.0 * np.sin(0.3))
    first = flat([(0, 0, 0), (LENGTH, 0, 0), (LENGTH, 800, 0), (0, 800, 0)])
    second = flat([(0, 800, 0), (LENGTH, 800, 0), (LENGTH, *corner), (0, *corner)])
    found = sections_of(surface_of(first, second), PARTS, "roof.step", 1.0)
    for section in found.sections:
        assert section.length[-1] == pytest.approx(1400.0, rel=1e-6)
        assert section.turn[-1] == pytest.approx(0.3, abs=1e-9)
        before = section.turn[section.length < 799.0], section.turn[section.length > 801.0]
        assert sorted(float(np.ptp(one)) for one in before) == pytest.approx([0.0, 0.0], abs=1e-9)


def test_sections_along_planes_are_those_along_parameter_lines():
    """The same sheet with its faces trimmed by a hair at one end has no lanes."""
    whole = arc_face(1000.0, 0.0, 90.0, LENGTH)
    trimmed = flat([(0, 0, 0), (LENGTH, 0, 0), (LENGTH + 1.0, 900, 0), (0, 900, 0)])
    along_lanes = sections_of(surface_of(whole), PARTS, "roof.step", 1.0)
    along_planes = sections_of(surface_of(trimmed), PARTS, "roof.step", 1.0)
    assert along_lanes.lanes is not None
    assert along_planes.lanes is None
    for section in along_planes.sections:
        assert section.length[-1] == pytest.approx(900.0, rel=1e-4)
        assert section.turn.max() == 0.0


def test_the_mean_of_sections_is_taken_at_equal_parts_of_their_lengths():
    def section(length, turn):
        along = np.linspace(0.0, 1.0, 11)
        points = np.stack([length * along, 0.0 * along, 0.0 * along], axis=1)
        return CrossSection(points=points, length=length * along, turn=turn * along)

    found = Sections(parts=np.array([0.3, 0.6]), sections=(section(100.0, 0.2), section(300.0, 0.6)), strip_length=1.0)
    lengths, turns = found.mean
    np.testing.assert_allclose(turns, 0.4 * lengths / 200.0, atol=1e-12)
    assert (lengths[-1], turns[-1]) == pytest.approx((200.0, 0.4))
