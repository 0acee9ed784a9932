"""Flat patterns are held against the kernel's own areas, volumes and edges."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.proof.flat_checks import ExpectedFlat, FlatFacts, check_flats
from cadpanel.brep.proof.inspection import inspect
from cadpanel.delivery.records.from_shape import patch_models
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.unroll import unroll
from tests.chains import FEATURES
from tests.flat_panels import panels
from tests.shapes import random_panel

THICKNESS = 3.0


def flat(shape, share=0.5, side="outer"):
    """A panel built, looked at, and what its flat pattern says."""
    built = build_panel(shape, THICKNESS, side)
    own, way = built.straightened.shape, -1.0 if side == "outer" else 1.0
    pattern, skin = unroll(own, way * share * THICKNESS), unroll(own)
    planes = [(one.point, one.normal) for one in patch_models(own) if isinstance(one, PlanePatchModel)]
    far = np.array(planes).reshape(-1, 2, 3)
    far[:, 0] += way * THICKNESS * far[:, 1]
    (size,), (skin_size,) = flat_sizes([pattern]), flat_sizes([skin])
    expected = ExpectedFlat(area=size.area, share=share, depth=way * THICKNESS, skin_pieces=np.array(skin_size.pieces))
    return FlatFacts(expected, far, inspect("A-01", built.solid), inspect("A-01", built.skin))


@pytest.mark.parametrize("name", sorted(FEATURES))
def test_flat_patterns_of_every_feature_hold(name):
    failures: list[str] = []
    errors = check_flats([flat(shape) for shape in panels(name, 5)[:1]], failures)
    assert failures == []
    assert errors[0] <= 1e-11
    assert errors[1] <= 1e-8


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("side", ["outer", "inner"])
@pytest.mark.parametrize("chain", ["plane-cone-plane", "cone", "cone-plane-cone"])
def test_every_surface_in_the_sheet_can_be_the_one_that_is_unrolled(share, side, chain):
    failures: list[str] = []
    check_flats([flat(random_panel(3, chain=chain, mitre=0.5), share, side)], failures)
    assert failures == []


def test_an_area_that_is_a_hair_too_large_is_told():
    good = flat(random_panel(4))
    for factor, told in ((1.0 + 1e-10, 0), (1.0 + 2e-9, 1)):
        failures: list[str] = []
        expected = replace(good.expected, area=good.expected.area * factor)
        check_flats([good._replace(expected=expected)], failures)
        assert len(failures) == told
    assert failures[0].startswith("Panel 'A-01': its flat pattern has an area of ")


def test_an_edge_that_is_a_hair_too_long_or_missing_is_told():
    good = flat(random_panel(4))
    for pieces in (good.expected.skin_pieces + np.eye(8)[2] * 2e-6, good.expected.skin_pieces[:-1]):
        failures: list[str] = []
        check_flats([good._replace(expected=replace(good.expected, skin_pieces=pieces))], failures)
        (failure,) = failures
        assert "longer or shorter when it is flat" in failure


def test_another_share_of_the_thickness_is_told():
    good = flat(random_panel(4))
    failures: list[str] = []
    check_flats([good._replace(expected=replace(good.expected, share=0.49))], failures)
    assert len(failures) == 1
