"""Panels as flat parts: what is bought, and what a press or roller is set to."""

import math

import numpy as np
import pytest

from cadpanel.delivery.records.flat_parts import flat_parts, press_hits
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.patches import ConePatch
from tests.flat_panels import panels
from tests.flat_parts import parts_of
from tests.known_panels import end_curve
from tests.shapes import folded_panel, random_panel


def test_a_known_fold_is_told_in_the_shops_numbers():
    (part,) = parts_of([folded_panel(radius=200.0, sweep=1.0, widths=(150.0, 250.0))], ShopSettings(facet_height=0.5))
    (bend,) = part.bends
    assert (bend.direction, bend.half_angle, bend.patch) == ("down", 0.0, 1)
    assert bend.radius == pytest.approx((197.0, 197.0))
    assert bend.sweep == pytest.approx(math.degrees(1.0))
    assert bend.lengths == pytest.approx((198.5, 198.5))
    assert bend.angles == pytest.approx((math.degrees(1.0), math.degrees(1.0)))
    assert bend.hits == math.ceil(1.0 / (2.0 * math.acos(1.0 - 0.5 / 197.0)))
    assert (part.blank.width, part.blank.height) == pytest.approx((1000.0, 150.0 + 250.0 + 198.5))
    assert part.blank.area == pytest.approx(1000.0 * 598.5)
    assert part.blank.edges["end 0"] == pytest.approx(598.5)


@pytest.mark.parametrize(
    ("radius", "side", "inner"), [(200, "outer", 197), (200, "inner", 200), (-200, "outer", 200), (-200, "inner", 197)]
)
def test_the_inner_radius_is_that_of_the_face_inside_of_the_bend(radius, side, inner):
    shape = folded_panel(radius=float(radius), sweep=math.copysign(1.0, radius))
    ((bend,),) = (part.bends for part in flat_parts([shape], SheetSettings(skin_side=side), ShopSettings()))
    assert bend.radius == pytest.approx((inner, inner))
    assert bend.direction == ("down" if radius > 0 else "up")


@pytest.mark.parametrize("seed", range(5))
def test_the_angle_at_an_end_is_that_between_the_flanges_edges(seed):
    shape = random_panel(seed, mitre=0.5)
    ((bend,),) = (part.bends for part in parts_of([shape]))
    corners = shape.corners()
    for end in (0, 1):
        first, last = corners[end, 1] - corners[end, 0], corners[end, 3] - corners[end, 2]
        cosine = first @ last / np.linalg.norm(first) / np.linalg.norm(last)
        assert bend.angles[end] == pytest.approx(math.degrees(math.acos(cosine)), abs=1e-6)


def test_a_bend_of_more_than_half_a_turn_keeps_its_angle():
    (part,) = parts_of([folded_panel(chain="c", sweep=4.0, widths=(), turns=())])
    assert part.bends[0].angles == pytest.approx(2 * (math.degrees(4.0),))


@pytest.mark.parametrize("seed", range(3))
def test_the_hits_keep_facets_within_their_height_and_no_fewer_do(seed):
    shape = random_panel(seed)
    (patch,) = (patch for patch in shape.patches if isinstance(patch, ConePatch))
    for height in (0.1, 0.5, 2.0):
        ((bend,),) = (part.bends for part in parts_of([shape], ShopSettings(facet_height=height)))
        sag = [bend.radius[1] * (1.0 - math.cos(0.5 * abs(patch.sweep) / hits)) for hits in (bend.hits, bend.hits - 1)]
        assert sag[0] <= height < sag[1]


def test_a_facet_higher_than_the_radius_is_one_hit():
    assert press_hits(0.4, 3.0, 0.5) == 1
    assert press_hits(100.0, 0.0001, 0.5) == 1
    assert press_hits(100.0, 4.0 * math.acos(1.0 - 0.5 / 100.0), 0.5) == 2


def test_the_smallest_sheet_that_will_do_is_taken():
    shape = folded_panel(widths=(150.0, 250.0))
    for stock, taken in (
        (((600.0, 1000.0), (2000.0, 4000.0)), "600x1000"),
        (((2000.0, 4000.0), (1000.0, 600.0)), "1000x600"),
        (((598.0, 3000.0),), None),
        ((), None),
    ):
        (part,) = parts_of([shape], ShopSettings(stock=stock))
        assert part.blank.stock == taken


def test_flat_panels_have_blanks_and_no_bends():
    for part in parts_of(panels("polygon of 5", 1)):
        assert part.bends == ()
        assert part.blank.area < part.blank.width * part.blank.height
        assert list(part.blank.edges) == [f"edge {edge}" for edge in range(5)]


def test_bent_lengths_are_those_of_the_middle_of_the_sheet():
    shape = random_panel(4)
    ((bend,),) = (part.bends for part in parts_of([shape]))
    for end in (0, 1):
        points = end_curve(shape.offset(-1.5), end).follow(np.linspace(1.0, 2.0 - 1e-12, 4001)[None])[0][0]
        assert bend.lengths[end] == pytest.approx(np.linalg.norm(np.diff(points, axis=0), axis=-1).sum(), abs=1e-4)
