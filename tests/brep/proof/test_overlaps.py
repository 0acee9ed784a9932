"""Sheets that a plane parts are parted by their edges alone; the kernel is asked about the others."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.proof.certificate import certify
from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.proof.overlaps import unparted
from cadpanel.geometry.vectors import unit
from tests.certified import Delivery
from tests.joined import quadrilaterals
from tests.known_panels import sampled
from tests.shapes import folded_panel, moved, random_panel


def facts(shapes, thickness=3.0):
    return [inspect(shape.name, build_solid(shape, thickness)) for shape in shapes]


def test_sheets_that_touch_are_parted_and_those_that_reach_into_each_other_are_not():
    def row(gap):
        return facts([folded_panel(), moved(folded_panel(name="B"), (1000.0 + gap, 0.0, 0.0))])

    assert unparted(row(0.0)) == []
    assert unparted(row(5.0)) == []
    assert unparted(row(-1e-9)) == []
    assert unparted(row(-1e-5)) == [(0, 1)]
    assert unparted([]) == []


def test_flat_sheets_between_square_walls_share_volume_at_a_kink():
    # Whichever neighbours fold towards their sheets collide there; the walls have not been told of each other.
    found = unparted(facts(quadrilaterals(2, sags=(-50.0, -50.0))))
    assert {(0, 1), (0, 2), (1, 3), (2, 3)} >= set(found)
    assert unparted(facts(quadrilaterals(2, sags=(50.0, 50.0)))) != []


@pytest.mark.parametrize("seed", range(4))
def test_the_farthest_place_of_a_solid_in_any_direction_lies_on_an_edge(seed):
    shape = random_panel(seed, half_angle=0.05)
    solid = facts([shape])[0]
    directions = np.random.default_rng(seed).normal(size=(50, 3))
    greatest = solid.pieces.reach(directions)[1].max(axis=1)
    for face in (shape, shape.offset(-3.0)):
        assert ((sampled(face, "A").points @ directions.T).max(axis=0) <= greatest + 1e-8).all()


def nested(distance):
    """Two folds, one in the other, so far apart: no plane parts them."""
    fold = folded_panel(name="A", sweep=1.5)
    return [fold, replace(moved(fold, distance * unit(fold.normals[0] + fold.normals[-1])), name="B")]


@pytest.mark.parametrize(("distance", "shared"), [(10.0, False), (2.0, True)])
def test_folds_inside_each_other_are_left_to_the_kernel(tmp_path, distance, shared):
    delivery = Delivery(tmp_path, nested(distance))
    assert unparted(facts(nested(distance))) == [(0, 1)]
    found = certify(delivery.panels_step, delivery.skins_step, delivery.expected, joint=0.0)
    assert found.overlap is not None
    assert (found.overlap > 1.0) == shared
    assert found.holds == (not shared)
    assert not shared or found.failures[0].startswith("Panels 'A' and 'B' share ")
