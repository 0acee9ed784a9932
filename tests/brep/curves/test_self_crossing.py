"""A curve that crosses itself cuts out its loops, as the same curve drawn in parts does."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.GeomAPI import GeomAPI_Interpolate
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_HArray1OfPnt

from cadpanel.brep.curves.self_crossing import crossings
from tests.brep.curves.test_drawn_curve import LENGTH, WIDTH, areas, cut, line, plate

CLOSELY = 1e-5  # part of the area; the splines follow the formulae no better


def spline(points, closed=False):
    """The smooth curve through (q, 2) points on the plate, and back to the first of them where it is closed."""
    array = TColgp_HArray1OfPnt(1, len(points))
    for place, (x, y) in enumerate(np.asarray(points).tolist(), start=1):
        array.SetValue(place, gp_Pnt(x, y, 0.0))
    interpolation = GeomAPI_Interpolate(array, closed, 1e-7)
    interpolation.Perform()
    return BRepBuilderAPI_MakeEdge(interpolation.Curve()).Edge()


def alpha(t):
    """From the plate's lower border up, round a loop where |t| < 1, and down to it again."""
    return np.stack([0.5 * LENGTH + 1500.0 * (t**3 - t), 1700.0 - 1000.0 * t**2], axis=-1)


def eight(t):
    return np.stack([0.5 * LENGTH + 1500.0 * np.sin(t), 0.5 * WIDTH + 500.0 * np.sin(2.0 * t)], axis=-1)


def coil(t):
    """From the left border to the right one round four loops, one beside the other; t from 0 to 1."""
    turns = 10.0 * np.pi * t + np.pi
    return np.stack(
        [-300.0 + (LENGTH + 600.0) * t + 500.0 * np.sin(turns), 0.5 * WIDTH + 500.0 * np.cos(turns)], axis=-1
    )


def enclosed_by(points):
    x, y = (points - points[0]).T
    return 0.5 * abs(float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])))


def test_loop_of_a_curve_is_a_panel_whichever_way_it_is_drawn():
    t = np.linspace(-1.35, 1.35, 121)
    loop = enclosed_by(alpha(np.linspace(-1.0, 1.0, 5001)))
    whole, against = areas(cut([plate()], [spline(alpha(t))])), areas(cut([plate()], [spline(alpha(t[::-1]))]))
    parts = areas(cut([plate()], [spline(alpha(t[:61])), spline(alpha(t[60:]))]))
    assert len(whole) == 3
    assert min(abs(area - loop) for area in whole) <= CLOSELY * loop
    assert against == pytest.approx(whole, rel=CLOSELY)
    assert parts == pytest.approx(whole, rel=CLOSELY)


@pytest.mark.parametrize("begun", [0.0, 0.3, np.pi / 2])
def test_figure_eight_cuts_out_both_its_loops_wherever_it_begins(begun):
    t = begun + 2.0 * np.pi * np.arange(96) / 96
    lobe = enclosed_by(eight(np.linspace(0.0, np.pi, 5001)))
    found = areas(cut([plate()], [spline(eight(t), closed=True)]))
    assert found == pytest.approx([lobe, lobe, LENGTH * WIDTH - 2.0 * lobe], rel=CLOSELY)


def test_coil_cuts_out_all_its_loops():
    t = np.linspace(0.0, 1.0, 40_001)
    drawn = coil(t)
    first, last = crossings(coil(t[::10]))[0] * 10
    loop = enclosed_by(drawn[first : last + 10])
    found = areas(cut([plate()], [spline(drawn[::100])]))
    assert len(found) == 6
    assert found[:4] == pytest.approx([loop] * 4, rel=1e-3)


@pytest.mark.parametrize("short", [0.0, 0.005])
def test_curve_that_ends_on_itself_closes_its_loop(short):
    t = np.linspace(-1.35, 1.0, 121)
    points = alpha(t)
    points[-1] -= short * (points[-1] - points[-2]) / np.linalg.norm(points[-1] - points[-2])
    loop = enclosed_by(alpha(np.linspace(-1.0, 1.0, 5001)))
    found = areas(cut([plate()], [spline(points), line((3000, 700, 0), (3000, 0, 0))]))
    assert min(abs(area - loop) for area in found) <= 1e-3 * loop


def test_closed_curve_without_loops_stays_whole():
    t = 2.0 * np.pi * np.arange(48) / 48
    ring = np.stack([3000.0 + 800.0 * np.cos(t), 1000.0 + 600.0 * np.sin(t)], axis=1)
    found = cut([plate()], [spline(ring, closed=True)])
    assert areas(found)[0] == pytest.approx(np.pi * 800.0 * 600.0, rel=CLOSELY)


def met(line):
    """Pairs of segments that meet, one pair after the other."""
    found = []
    for i in range(len(line) - 1):
        for j in range(i + 2, len(line) - 1):
            (a, b), (c, d) = line[i : i + 2], line[j : j + 2]
            if np.linalg.matrix_rank(np.stack([b - a, c - d])) == 2:
                s, t = np.linalg.solve(np.stack([b - a, c - d], axis=1), c - a)
                if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
                    found.append([i, j])
    return found


@pytest.mark.parametrize("count", [3, 5, 33, 34, 100])
def test_crossings_are_those_that_one_finds_pair_by_pair(count):
    line = np.random.default_rng(count).uniform(size=(count, 2))
    assert crossings(line).tolist() == met(line)


def test_crossings_of_a_long_line_are_found_in_little_memory():
    t = np.linspace(0.0, 1.0, 20_001)
    spiral = t[:, None] * np.stack([np.cos(300.0 * t), np.sin(300.0 * t)], axis=1)
    assert not len(crossings(spiral))
    assert len(crossings(np.concatenate([spiral, [[2.0, 0.0], [-2.0, 0.1]]])))
