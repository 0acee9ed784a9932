"""Flat patterns to look at keep to the outline that is cut."""

import numpy as np
import pytest

from cadpanel.delivery.page.flats import flat_lines, like_flats, packed_flats
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


def test_holes_are_shown_and_a_page_that_has_others_is_told_from_it():
    pattern = delivery().parts[0].pattern
    holes = np.array([[100.0, 50.0, 6.5], [200.0, 50.0, 6.5]])
    drilled, whole = packed_flats([pattern], [holes]), packed_flats([pattern], [holes[:0]])
    assert drilled[0]["holes"] == [1000, 500, 65, 2000, 500, 65]
    assert "holes" not in whole[0]
    assert like_flats(drilled, drilled)
    assert like_flats(packed_flats([pattern], [holes + 0.06]), drilled)  # rounded otherwise
    for other in (whole, packed_flats([pattern], [holes[1:]]), packed_flats([pattern], [holes + 0.2]), None, [None]):
        assert not like_flats(other, drilled)
    assert not like_flats(drilled, whole)
    assert not like_flats([{**drilled[0], "holes": ["1000", 500, 65, 2000, 500, 65]}], drilled)
