"""Rolled out sections of cones: velocities are derivatives, lengths and areas those of what is drawn."""

import math

import numpy as np
import pytest

from cadpanel.geometry.flat_curves import segments
from cadpanel.geometry.unroll import unroll
from tests.shapes import folded_panel, random_panel


@pytest.mark.parametrize("half_angle", [-0.05, 0.0, 0.05])
@pytest.mark.parametrize("concave", [False, True])
def test_velocities_are_the_derivatives_of_points(half_angle, concave):
    curves = unroll(random_panel(5, half_angle=half_angle, concave=concave)).curves
    u, step = np.tile([0.2, 0.5, 0.8], (len(curves), 1)), 1e-5
    slope = (curves.points(u + step) - curves.points(u - step)) / (2.0 * step)
    assert curves.velocities(u) == pytest.approx(slope, abs=1e-4)


def test_lengths_and_areas_are_those_of_many_chords():
    curves = unroll(random_panel(6, half_angle=0.04)).curves
    points = curves.points(np.broadcast_to(np.linspace(0.0, 1.0, 4001), (len(curves), 4001)))
    chords = np.linalg.norm(np.diff(points, axis=1), axis=-1).sum(axis=-1)
    assert curves.lengths() == pytest.approx(chords, rel=1e-6)
    x, y = points[:, :-1].reshape(-1, 2).T
    shoelace = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    assert float(curves.areas().sum()) == pytest.approx(shoelace, rel=1e-6)


def test_the_area_of_a_square_is_its_side_squared():
    corners = 5.0 + np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    square = segments(corners, np.roll(corners, -1, axis=0))
    assert float(square.areas().sum()) == pytest.approx(4.0)
    assert square.lengths() == pytest.approx(np.full(4, 2.0))
    assert not square.curved.any()


def test_a_mitred_cylinder_ends_in_a_sine_curve():
    """Rolling an oblique section of a cylinder out gives height = tan(tilt) times the distance along the axis' view."""
    shape = folded_panel(
        chain="c", radius=100.0, sweep=math.pi, widths=(), turns=(), cut_normals=((1, 0, 0.5), (1, 0, 0))
    )
    curve = unroll(shape).curves.take(slice(0, 1))
    u = np.linspace(0.0, 1.0, 7)[None]
    x, y = curve.points(u)[0].T
    assert x == pytest.approx(100.0 * math.pi * u[0])
    assert y - y[0] == pytest.approx(0.5 * 100.0 * (1.0 - np.cos(math.pi * u[0])), abs=1e-9)
