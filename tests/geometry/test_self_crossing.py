"""An end of the skin that runs into itself is found, and one that only turns far is not."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.patches import ConePatch, PlanePatch
from cadpanel.geometry.self_crossing import crosses_itself, end_polyline
from cadpanel.geometry.shape import PanelShape
from tests.shapes import CHAINS, folded_panel, moved, random_panel


def folded(sweep, flange, radius=100.0):
    """Plane, cylinder, plane along x: flanges of a length on both sides of a bend."""
    return folded_panel(radius=radius, sweep=sweep, widths=(flange, flange))


@pytest.mark.parametrize("degrees", [190.0, 240.0, 300.0])
@pytest.mark.parametrize(("part", "crosses"), [(0.95, False), (1.05, True)])
def test_flanges_that_lean_towards_each_other_cross_from_where_their_lines_meet(degrees, part, crosses):
    """The tangents at both ends of an arc beyond half a turn meet at radius times the tangent of half of it."""
    sweep = np.radians(degrees)
    meet = 100.0 * abs(np.tan(0.5 * sweep))
    assert crosses_itself(folded(sweep, part * meet)) == crosses


@pytest.mark.parametrize("degrees", [30.0, 90.0, 179.0])
def test_up_to_half_a_turn_nothing_crosses_however_long_the_flanges(degrees):
    assert not crosses_itself(folded(np.radians(degrees), 5000.0))
    assert not crosses_itself(folded(np.radians(-degrees), 5000.0, radius=-100.0))


@given(seed=st.integers(0, 10_000), chain=st.sampled_from(sorted(CHAINS)))
def test_the_polyline_runs_through_all_corners_in_the_plane_of_its_end(seed, chain):
    shape = random_panel(seed, chain=chain)
    for end in (0, 1):
        points = end_polyline(shape, end, arc_points=9)
        np.testing.assert_allclose((points - shape.cut_points[end]) @ shape.cut_normals[end], 0.0, atol=1e-9)
        corners = shape.corners()[end]
        away = np.linalg.norm(points[:, None] - corners, axis=-1).min(axis=0)
        np.testing.assert_allclose(away, 0.0, atol=1e-9)
        np.testing.assert_allclose(points[[0, -1]], corners[[0, -1]], atol=1e-9)
        arcs = sum(isinstance(patch, ConePatch) for patch in shape.patches)
        assert len(points) == len(corners) + 7 * arcs


@given(seed=st.integers(0, 10_000), chain=st.sampled_from(sorted(CHAINS)), lift=st.sampled_from([-2.0, 3.0]))
def test_the_ends_of_a_square_sheets_faces_are_everywhere_as_far_apart_as_the_faces(seed, chain, lift):
    shape = replace(random_panel(seed, chain=chain), square=True)
    for end in (0, 1):
        away = end_polyline(shape.offset(lift), end) - end_polyline(shape, end)
        np.testing.assert_allclose(np.linalg.norm(away, axis=-1), abs(lift), rtol=1e-9)
        # All to the same side.
        assert (np.einsum("mx,mx->m", away[1:], away[:-1]) > 0.0).all()


@pytest.mark.parametrize("part", [0.9, 1.1])
def test_where_a_panel_stands_does_not_matter(part):
    shape = folded(np.radians(240.0), part * 100.0 * np.tan(np.radians(60.0)))
    assert crosses_itself(moved(shape, (1e4, -2e4, 3e3))) == crosses_itself(shape) == (part > 1.0)


def strip(*corners):
    """Planes along x whose ends run through corners (y, z)."""
    points = np.array([(0.0, *corner) for corner in corners])
    upwards, along = np.tile([0.0, 0.0, 1.0], (len(points), 1)), np.tile([1.0, 0.0, 0.0], (len(points), 1))
    return PanelShape(
        name="A-01",
        feature="by hand",
        points=points,
        directions=along,
        normals=upwards,
        patches=(PlanePatch(),) * (len(points) - 1),
        cut_points=np.array([[-500.0, 0.0, 0.0], [500.0, 0.0, 0.0]]),
        cut_normals=along[:2],
    )


@pytest.mark.parametrize("size", [0.3, 1.0, 100.0])
@pytest.mark.parametrize(("end", "crosses"), [(0.5, False), (0.1, False), (0.0, True), (-0.5, True)])
def test_an_end_that_touches_itself_runs_into_itself(size, end, crosses):
    """Its last corner on the first flange, and on the flange next but one, is the smallest case."""
    far = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 2.0), (1.0, end)]
    near = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, end)]
    for corners in (far, near):
        assert crosses_itself(strip(*(size * np.array(corners)))) == crosses


def test_an_end_that_goes_back_over_itself_square_to_its_way_runs_into_itself():
    assert crosses_itself(strip((0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (1.0, -1.0), (2.0, 0.0)))
    assert not crosses_itself(strip((0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (1.5, -1.0), (2.0, 0.0)))
