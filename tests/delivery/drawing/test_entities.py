"""What a drawing is made of, and the box about it."""

import numpy as np
import pytest

from cadpanel.delivery.drawing.entities import Contour, Line, Text, extents, moved


def test_the_box_takes_in_the_tops_of_arcs():
    disc = Contour("CUT", np.array([[1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]]))
    low, high = extents([disc])
    assert low == pytest.approx([-1.0, -1.0])
    assert high == pytest.approx([1.0, 1.0])


def test_everything_moves_alike():
    drawing = (
        Contour("CUT", np.array([[0.0, 0.0, 0.5], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]])),
        Line("BEND", np.zeros(2), np.array([1.0, 2.0])),
        Text("MARK", "word", np.array([1.0, 1.0]), 0.2),
        Text("INFO", "word", np.array([1.0, 1.0]), 0.2, left=True),
    )
    shift = np.array([10.0, -20.0])
    for before, after in zip(extents(drawing), extents(moved(drawing, shift)), strict=True):
        assert after - before == pytest.approx(shift)
    contour = moved(drawing, shift)[0]
    assert isinstance(contour, Contour)
    assert contour.vertices[:, 2] == pytest.approx([0.5, 0.0, 0.0])


def test_text_to_the_right_of_its_place_reaches_farther_than_text_about_it():
    about, right = (extents([Text("MARK", "word", np.zeros(2), 1.0, left=left)]) for left in (False, True))
    assert right[0][0] == pytest.approx(0.0)
    assert about[0][0] == pytest.approx(-about[1][0])
