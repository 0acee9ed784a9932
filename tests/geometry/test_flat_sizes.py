"""Areas, lengths and blanks of flat patterns, of many at once as of each alone."""

import pytest

from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.unroll import unroll
from tests.shapes import folded_panel


def test_a_rectangle_and_what_is_rolled_from_it_have_its_area_its_edges_and_its_blank():
    flat = folded_panel(chain="p", widths=(600.0,), turns=(0.0,), length=900.0)
    rolled = folded_panel(chain="c", widths=(), turns=(), radius=300.0, sweep=2.0, length=900.0)
    other = folded_panel(chain="pp", widths=(100.0, 250.0), turns=(0.0, 0.0), length=700.0)
    sizes = flat_sizes([unroll(shape) for shape in (flat, rolled, other)])
    for size, (width, length) in zip(sizes, [(600.0, 900.0), (600.0, 900.0), (350.0, 700.0)], strict=True):
        assert size.area == pytest.approx(width * length, rel=1e-12)
        assert size.edges == pytest.approx({"end 0": width, "side 1": length, "end 1": width, "side 0": length})
        assert (size.blank.length, size.blank.width) == pytest.approx((length, width))
        assert sum(size.pieces) == pytest.approx(2.0 * (width + length))
