"""What stands in the files is built anew from the report's numbers, and held against that."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.proof.parallel import rebuild
from cadpanel.brep.proof.rebuilding import rebuild as built_here
from cadpanel.errors import PanelError
from cadpanel.geometry.vectors import unit
from tests.certified import SEAMS, THICKNESS, Delivery, expected, strip
from tests.instances import random_polygon


def told(shape):
    return replace(expected(shape), sheet=Sheet(shape=shape, thickness=THICKNESS, skin_side="outer"))


@pytest.fixture(scope="module")
def delivery(tmp_path_factory):
    delivery = Delivery(tmp_path_factory.mktemp("rebuilt"), strip())
    delivery.expected = [told(shape) for shape in strip()]
    return delivery


def test_what_was_built_from_the_same_numbers_holds(delivery):
    assert delivery.certify().holds


@pytest.mark.parametrize("by", [1e-4, 0.5, 50.0])
def test_a_solid_whose_far_face_was_sheared_sideways_fails(tmp_path, by):
    """Its volume, its skin, and the planes of both large faces are what they were; its walls are not."""
    shape = random_polygon(7, 5)
    delivery = Delivery(tmp_path, [shape])
    delivery.expected = [told(shape)]
    assert delivery.certify([]).holds
    aside = by / THICKNESS * unit(shape.outline[1] - shape.outline[0])
    posts = np.tile(shape.normal, (5, 1)) if shape.posts is None else shape.posts
    delivery.solids[shape.name] = build_solid(replace(shape, posts=posts + aside), THICKNESS)
    delivery.write()
    (said,) = delivery.certify([]).failures
    assert said.startswith(f"Panel '{shape.name}': its solid is not what the numbers in the report make: it has")


def test_a_sheet_on_the_other_side_or_of_another_thickness_fails(delivery):
    own = delivery.expected[0].sheet
    for sheet in (replace(own, skin_side="inner"), replace(own, thickness=4.0)):
        wrong = [replace(delivery.expected[0], sheet=sheet), *delivery.expected[1:]]
        whole, delivery.expected = delivery.expected, wrong
        said = delivery.certify(SEAMS).failures
        delivery.expected = whole
        assert said
        assert all(one.startswith("Panel 'P0': its solid is not what") for one in said)


def test_numbers_that_make_no_sheet_are_told(delivery):
    thick = replace(delivery.expected[1].sheet, thickness=5000.0)
    whole = delivery.expected
    delivery.expected = [whole[0], replace(whole[1], sheet=thick), whole[2]]
    said = delivery.certify().failures
    delivery.expected = whole
    assert [one for one in said if one.startswith("Panel 'P1': no sheet can be built from the numbers in the report (")]


def test_who_builds_them_changes_nothing(delivery):
    sheets = [panel.sheet for panel in delivery.expected] * 7
    here = built_here(sheets)
    for one, other in zip(rebuild(delivery.panels_step, sheets), here, strict=True):
        assert not isinstance(one, PanelError)
        assert not isinstance(other, PanelError)
        assert np.array_equal(one.solid.edges, other.solid.edges)
        assert np.array_equal(one.skin.vertices, other.skin.vertices)
