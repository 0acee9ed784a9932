"""A panel that is too small for its joint is named, with a width that all panels have room for."""

import re
from itertools import pairwise

import numpy as np
import pytest

from cadpanel.geometry.joint_widths import HALVINGS, widest_joint
from cadpanel.geometry.joints import cut_to_seams
from cadpanel.geometry.sheet_checks import check_buildable
from tests.joined import polygon, quadrilaterals, seams


def row(width=40.0):
    """Three rectangles side by side, the middle one so many mm wide."""
    places = np.array([0.0, 1000.0, 1000.0 + width, 2000.0 + width])
    return [
        polygon(f"P{i}", np.array([[a, 0.0, 0.0], [b, 0.0, 0.0], [b, 500.0, 0.0], [a, 500.0, 0.0]]))
        for i, (a, b) in enumerate(pairwise(places.tolist()))
    ]


@pytest.mark.parametrize("joint", [41.0, 500.0, 1000.0])
def test_the_narrowest_panel_is_named_and_the_width_that_is_said_can_be_built(joint):
    panels = row()
    found = widest_joint(panels, seams(panels), joint, 3.0, "outer")
    assert found is not None
    assert found.panel == "P1"
    said = re.search(r"at most ([\d.]+) mm", found.reason)
    assert said is not None
    width = float(said.group(1))
    assert 38.0 <= width <= 39.9
    for shape in cut_to_seams(panels, seams(panels), width, -3.0).shapes:
        check_buildable(shape, 3.0)


def test_where_there_is_room_or_no_joint_would_help_nothing_is_said():
    panels = quadrilaterals()
    assert widest_joint(panels, seams(panels), 20.0, 3.0, "outer") is None
    flat = [polygon("P", np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.05, 0.0], [0.0, 0.05, 0.0]]))]
    assert widest_joint(flat, [], 20.0, 3.0, "outer") is None


@pytest.mark.parametrize("width", [0.104, 0.125, 0.34, 0.9, 3.0])
def test_of_a_width_that_is_said_two_digits_are_kept_and_nothing_is_added(width):
    """The middle panel is that wide, and 0.1 mm of it has to be left."""
    panels = row(width)
    found = widest_joint(panels, seams(panels), 8.0 * width, 3.0, "outer")
    assert found is not None
    said = re.search(r"at most ([\d.]+) mm", found.reason)
    assert said is not None
    room = width - 0.1
    least = 8.0 * width / 2**HALVINGS
    assert float(said.group(1)) <= room
    assert float(said.group(1)) >= 0.9 * (room - least)


def test_where_there_is_hardly_any_room_no_joint_at_all_is_said():
    panels = row(0.1001)
    found = widest_joint(panels, seams(panels), 1000.0, 3.0, "outer")
    assert found is not None
    assert "at most 0 mm" in found.reason
