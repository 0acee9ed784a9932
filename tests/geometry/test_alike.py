"""Two panels between rulings are alike where their numbers differ by rounding, and by nothing more."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.geometry.alike import alike
from tests.instances import random_polygon
from tests.shapes import folded_panel

ROUNDING, MORE = 1e-13, 1e-8


def changed(shape, by):
    """The panel with each of its numbers changed by so much, one after the other."""
    for name in ("points", "directions", "normals", "cut_normals", "side_leans"):
        numbers = getattr(shape, name).copy()
        numbers[0] += by
        yield replace(shape, **{name: numbers})
    yield replace(shape, cut_points=shape.cut_points + by * shape.cut_normals)
    (place, cone), *_ = [(place, patch) for place, patch in enumerate(shape.patches) if patch.kind == "cone"]
    for name in ("radius", "half_angle", "sweep"):
        other = replace(cone, **{name: getattr(cone, name) + by})
        yield replace(shape, patches=(*shape.patches[:place], other, *shape.patches[place + 1 :]))


def test_rounding_of_any_number_is_nothing_and_more_of_any_is_something():
    shape = folded_panel(half_angle=0.2)
    assert all(alike(shape, other) for other in changed(shape, ROUNDING))
    assert not any(alike(shape, other) for other in changed(shape, MORE))


def test_a_point_elsewhere_on_its_cut_plane_cuts_the_same():
    shape = folded_panel(half_angle=0.2)
    along = np.cross(shape.cut_normals, shape.normals[[0, 0]])
    assert alike(shape, replace(shape, cut_points=shape.cut_points + 30.0 * along))


@pytest.mark.parametrize("change", [{"feature": "another"}, {"square": True}, {"lift": 0.1}])
def test_what_is_built_another_way_is_not_alike(change):
    shape = folded_panel(half_angle=0.2)
    assert not alike(shape, replace(shape, **change))


def test_other_kinds_of_panels_are_never_said_to_be():
    polygon = random_polygon(7, 5)
    assert not alike(polygon, polygon)
    assert not alike(folded_panel(), polygon)
