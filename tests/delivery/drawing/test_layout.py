"""Parts on one sheet stand in rows and do not cover each other."""

import numpy as np
import pytest

from cadpanel.delivery.drawing.entities import Contour, extents, moved
from cadpanel.delivery.drawing.layout import in_rows


def boxes(seed, count):
    random = np.random.default_rng(seed)
    sizes, places = random.uniform(1.0, 5.0, (count, 2)), random.uniform(-9.0, 9.0, (count, 2))
    corner = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    return [
        (Contour("CUT", np.column_stack([place + corner * size, np.zeros(4)])),)
        for size, place in zip(sizes, places, strict=True)
    ]


@pytest.mark.parametrize("count", [1, 2, 7, 40])
def test_no_two_parts_cover_each_other_and_all_keep_their_order(count):
    drawings = boxes(1, count)
    laid = [extents(moved(one, shift)) for one, shift in zip(drawings, in_rows(drawings), strict=True)]
    for i, (low, high) in enumerate(laid):
        for other_low, other_high in laid[i + 1 :]:
            assert (low >= other_high).any() or (other_low >= high).any()
    tops = [round(float(high[1]), 6) for _, high in laid]
    assert tops == sorted(tops, reverse=True) or count < 3


def test_forty_parts_are_about_as_wide_as_high():
    drawings = boxes(2, 40)
    laid = [extents(moved(one, shift)) for one, shift in zip(drawings, in_rows(drawings), strict=True)]
    width, height = np.max([high for _, high in laid], axis=0) - np.min([low for low, _ in laid], axis=0)
    assert 0.5 < width / height < 2.0
