"""Scales are those of drawings, and words are as long as their letters."""

import numpy as np
import pytest

from cadpanel.delivery.pages.paper import Box, standard_scale, width_of

BOX = Box(left=10.0, bottom=20.0, width=200.0, height=100.0)


@pytest.mark.parametrize(
    ("size", "scale"),
    [((150.0, 90.0), 1), ((200.0, 100.0), 1), ((201.0, 10.0), 2), ((10.0, 1001.0), 15), ((250_000.0, 1.0), 2000)],
)
def test_a_part_is_drawn_to_the_largest_usual_scale_at_which_it_fits(size, scale):
    assert standard_scale(np.array(size), BOX) == 1.0 / scale


def test_letters_that_are_bold_or_more_are_wider():
    assert width_of("NW-01", 5.0, bold=True) > width_of("NW-01", 5.0) > width_of("NW-0", 5.0)


def test_a_box_knows_its_middle():
    assert BOX.middle.tolist() == [110.0, 70.0]
