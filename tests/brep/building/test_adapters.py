"""The same solids in cadquery and build123d."""

import pytest

from cadpanel.brep.building.adapters import to_build123d_compound, to_build123d_part, to_cadquery_shape, to_workplane
from cadpanel.brep.building.sheet import build_skin, build_solid
from cadpanel.geometry.volume import sheet_volume
from tests.shapes import random_panel


@pytest.fixture(scope="module")
def panel():
    return random_panel(1)


def test_a_solid_becomes_a_cadquery_solid(panel):
    solid = to_cadquery_shape(build_solid(panel, 3.0))
    assert solid.ShapeType() == "Solid"
    assert solid.isValid()
    assert solid.Volume() == pytest.approx(sheet_volume(panel, 3.0), rel=1e-9)


def test_a_skin_becomes_a_cadquery_shell(panel):
    assert to_cadquery_shape(build_skin(panel)).ShapeType() == "Shell"


def test_a_workplane_selects_the_cones(panel):
    assert to_workplane(build_solid(panel, 3.0)).faces("%CONE").size() == 2


def test_a_solid_becomes_a_build123d_part(panel):
    part = to_build123d_part(build_solid(panel, 3.0), "A-01")
    assert part.label == "A-01"
    assert part.volume == pytest.approx(sheet_volume(panel, 3.0), rel=1e-9)


def test_solids_become_a_named_build123d_compound(panel):
    solid = build_solid(panel, 3.0)
    compound = to_build123d_compound([("A", solid), ("B", solid)], "lip")
    assert compound.label == "lip"
    assert [child.label for child in compound.children] == ["A", "B"]
