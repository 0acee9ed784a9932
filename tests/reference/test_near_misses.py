"""Sides that lie along others without a seam are told of, and panels that cover each other are refused."""

from itertools import pairwise

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import RawPanel
from tests.reference_shapes import moved, polygon_face, raw_grid, raw_strip, ring, sampled_face, sheet_of, strip

ROOF = sheet_of(lambda x, y: 0.0 * (x + y), width=4000.0, length=4000.0)


def tile(name, x, y, width=1000.0, length=1000.0, height=0.0):
    """A flat panel from (x, y) on."""

    def surface(u, v):
        return np.stack([x + width * u, y + length * v, height + 0.0 * u + 0.0 * v], axis=-1)

    return RawPanel(name=name, faces=(sampled_face(surface, (0.0, 1.0)),))


def notes(*panels, tolerance=1.0):
    return assemble(panels, "roof.step", tolerance).notes


@pytest.mark.parametrize(
    "panels", [raw_strip(strip(5)), raw_strip(ring(6)), raw_grid(ROOF, 4, 3)], ids=["strip", "ring", "grid"]
)
def test_where_all_is_well_nothing_is_said(panels):
    assert notes(*panels) == ()


def test_a_long_side_against_two_short_ones_is_told():
    found = notes(tile("A", 0.0, 0.0, length=2000.0), tile("B", 1000.0, 0.0), tile("C", 1000.0, 1000.0))
    (note,) = found
    assert note.startswith("2 pairs of panels of 'roof.step' touch along a part of an edge only, like 'A' and 'B'")


def test_a_brick_bond_is_told():
    (note,) = notes(tile("A", 0.0, 0.0), tile("B", 1000.0, 0.0), tile("C", 500.0, 1000.0))
    assert "2 pairs of panels" in note


@pytest.mark.parametrize(("gap", "told"), [(0.9, False), (1.1, True), (4.0, True), (25.0, True), (60.0, False)])
def test_sides_farther_apart_than_the_tolerance_are_told(gap, told):
    found = notes(tile("A", 0.0, 0.0), tile("B", 1000.0 + gap, 0.0))
    assert len(found) == told
    if told:
        assert f"the nearest, 'A' and 'B', by {gap:g} mm: no seam is held there" in found[0]


@pytest.mark.parametrize(("gap", "told"), [(1.5, True), (6.0, True), (20.0, True), (30.0, False)])
def test_a_short_side_beside_a_long_one_is_told_as_far_as_half_its_length(gap, told):
    found = notes(tile("A", 0.0, 0.0, 900.0, 900.0), tile("B", 300.0, 900.0 + gap, 50.0, 50.0))
    assert [f"'A' and 'B', by {gap:g} mm" in note for note in found] == [True] * told


def test_a_short_side_that_points_at_a_long_one_does_not_run_along_it():
    turned = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    spike = moved(tile("B", 0.0, 0.0, 30.0, 30.0), turned, np.array([300.0, 904.0, 0.0]))
    assert notes(tile("A", 0.0, 0.0, 900.0, 900.0), spike) == ()


@pytest.mark.parametrize("angle", [10.0, 20.0])
def test_sides_that_a_panel_between_them_touches_do_not_run_along_each_other(angle):
    """Small panels on either side of a long wedge's tip, whose sides lie on the wedge's."""
    slope = np.tan(np.radians(0.5 * angle))
    flat = sheet_of(lambda x, _: 0.0 * x, 1.0, 1.0)
    xs = [0.0, 100.0, 200.0, 300.0, 400.0, 9000.0]
    wedge = np.array([[0.0, 0.0], [9000.0, -9000.0 * slope], [9000.0, 9000.0 * slope]])
    above = [
        np.array([[first, slope * first], [last, slope * last], [last, 3000.0], [first, 3000.0]])
        for first, last in pairwise(xs)
    ]
    below = [corners[::-1] * [1.0, -1.0] for corners in above]
    parts = [
        RawPanel(name=f"P{n}", faces=(polygon_face(flat, part),)) for n, part in enumerate([wedge, *above, *below])
    ]
    (note,) = notes(*parts)
    assert note.startswith("10 pairs of panels of 'roof.step' touch along a part of an edge only")


def test_a_frame_between_two_rows_of_panels_keeps_them_from_running_along_each_other():
    frame = tile("frame", 0.0, 0.0, 9000.0, 100.0)
    rows = [tile(f"{y}/{n}", 1000.0 * n, y, 1000.0) for y in (-1000.0, 100.0) for n in range(9)]
    (note,) = notes(frame, *rows)
    assert note.startswith("18 pairs of panels")
    gap = tile("gap", 0.0, 1101.5, 9000.0, 100.0)
    told = notes(frame, *rows, gap)
    assert "9 pairs of panels of 'roof.step' run along each other farther apart" in told[1]


def test_corners_that_meet_are_no_sides_that_do():
    assert notes(tile("A", 0.0, 0.0), tile("B", 1000.0, 1000.0)) == ()


@pytest.mark.parametrize("shift", [(500.0, 0.0), (300.0, 200.0), (700.0, 0.0)])
def test_panels_that_cover_each_other_in_part_are_refused_with_both_names(shift):
    with pytest.raises(PanelError, match=r"a part of it covers panel '(A|B)' to within 1 mm, .*: trim or delete one"):
        notes(tile("A", 0.0, 0.0), tile("B", *shift))


def test_a_panel_inside_another_one_is_refused():
    with pytest.raises(PanelError, match="a part of it covers panel"):
        notes(tile("A", 0.0, 0.0), tile("B", 200.0, 300.0, 500.0, 400.0))


def test_panels_above_each_other_do_not_cover_each_other():
    assert notes(tile("A", 0.0, 0.0), tile("B", 300.0, 200.0, height=50.0)) == ()
