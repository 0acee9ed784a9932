"""Flat patterns to look at keep to the outline that is cut."""

import numpy as np
import pytest

from cadpanel.delivery.page.flats import flat_lines, packed_flats
from tests.pages import delivery


def test_outlines_have_the_area_that_is_cut_and_bends_run_from_edge_to_edge():
    for part in delivery().parts:
        outline, bends = flat_lines(part.pattern)
        x, y = outline.T
        area = 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
        assert area == pytest.approx(part.blank.area, rel=1e-3)
        assert len(bends) == 3  # two lines where patches meet, and the middle of the bend
        assert np.linalg.norm(bends[:, 1] - bends[:, 0], axis=1).min() > 0.5 * part.blank.height


def test_text_is_in_tenths_of_a_millimetre():
    part = delivery().parts[0]
    (packed,) = packed_flats([part.pattern])
    outline, _ = flat_lines(part.pattern)
    assert np.reshape(packed["outline"], (-1, 2)) / 10.0 == pytest.approx(outline, abs=0.051)
