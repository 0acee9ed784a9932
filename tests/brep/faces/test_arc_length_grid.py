"""Lines laid by length: evenly where they are even, anew where they are not, and areas that add up."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.Geom import Geom_SphericalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

from cadpanel.brep.faces.arc_length_grid import (
    are_uneven,
    even_lines,
    laid_anew,
    lines_by_spans,
    measure_chords,
    measure_strides,
    summed,
)
from cadpanel.brep.faces.surface_batch import SurfaceBatch
from tests.known_faces import bezier_surface, face_on

RADIUS = 700.0
STEPS = 16
steps = st.lists(st.floats(0.1, 10.0), min_size=2, max_size=12)


def sphere(north):
    """Of a sphere the part from the equator to a latitude, over a quarter turn: (1, 2, 2) bounds and the batch."""
    surface = Geom_SphericalSurface(gp_Ax3(gp_Pnt(), gp_Dir(0.0, 0.0, 1.0)), RADIUS)
    bounds = np.array([[(0.0, np.pi / 2.0), (0.0, north)]])
    return SurfaceBatch([BRepAdaptor_Surface(face_on(surface, *bounds[0]))]), bounds


@given(own=steps)
def test_lines_laid_anew_by_their_lengths_are_equally_far_apart(own):
    """A speed that is even within each step, as it was taken to be."""
    own = np.array(own)
    lines = np.linspace(0.0, 1.0, len(own) + 1)[None]
    (found,) = laid_anew(lines, own[None])
    walked = np.interp(found, lines[0], summed(own[None])[0])
    np.testing.assert_allclose(walked, np.linspace(0.0, own.sum(), len(own) + 1), rtol=1e-9, atol=1e-9)


@given(breaks=steps, count=st.integers(1, 9))
def test_lines_by_spans_pass_through_every_break_where_there_are_enough(breaks, count):
    rising = 3.0 + np.cumsum(breaks)
    found = lines_by_spans(rising, count * (len(rising) - 1))
    np.testing.assert_allclose(found[::count], (rising - rising[0]) / (rising[-1] - rising[0]), atol=1e-12)
    assert (np.diff(found) > 0.0).all()


def test_even_lines_and_sums_are_plain():
    u, v = even_lines(2, 4)
    assert u.tolist() == v.tolist() == [[0.0, 0.25, 0.5, 0.75, 1.0]] * 2
    assert summed(np.array([[1.0, 2.0, 4.0]])).tolist() == [[0.0, 1.0, 3.0, 7.0]]


@settings(max_examples=8)
@given(north=st.floats(0.2, 1.4))
def test_strides_on_a_sphere_are_those_of_its_parallels_and_meridians(north):
    """Along a meridian r dv; along the parallels r cos v du in the mean; the area is r^2 du sin v."""
    surfaces, bounds = sphere(north)
    for measured in (measure_strides, measure_chords):
        found = measured(surfaces, np.array([0]), bounds, even_lines(1, STEPS))
        along_u, along_v = (own[0] for own in found.speeds)
        assert along_v == pytest.approx(np.full(STEPS, RADIUS * north / STEPS), rel=2e-3)
        assert along_u.sum() == pytest.approx(RADIUS * np.pi / 2.0 * np.sin(north) / north, rel=1e-2)
        assert found.areas[0] == pytest.approx(RADIUS**2 * np.pi / 2.0 * np.sin(north), rel=2e-3)


def test_chords_are_never_longer_than_what_is_walked():
    surfaces, bounds = sphere(1.2)
    strides, chords = (
        measured(surfaces, np.array([0]), bounds, even_lines(1, 4)) for measured in (measure_strides, measure_chords)
    )
    assert chords.speeds[1].sum() < strides.speeds[1].sum()


def test_the_steps_of_a_surface_whose_speed_grows_are_uneven_from_the_ratio_on():
    """x = 1000 (a u + (1 - a) u^2) has speeds from a to 2 - a."""
    surface = bezier_surface([[(x, y, 0.0) for y in (0.0, 500.0)] for x in (0.0, 250.0, 1000.0)])
    surfaces = SurfaceBatch([BRepAdaptor_Surface(face_on(surface, (0.0, 1.0), (0.0, 1.0)))])
    bounds = np.array([[(0.0, 1.0), (0.0, 1.0)]])
    found = measure_strides(surfaces, np.array([0]), bounds, even_lines(1, 2))
    np.testing.assert_allclose(found.speeds[0][0], [375.0, 625.0])
    np.testing.assert_allclose(found.speeds[1][0], [250.0, 250.0])
    assert are_uneven(found, 1.7).tolist() == [False]
    assert are_uneven(found, 1.6).tolist() == [True]
    lines = laid_anew(even_lines(1, 2)[0], found.speeds[0])
    assert lines[0].tolist() == pytest.approx([0.0, 0.6, 1.0])
