"""Edges laid on a face follow what was drawn to within a thousandth of a millimetre, with few poles."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GCPnts import GCPnts_AbscissaPoint

from cadpanel.brep.curves.pcurve_fit import HALF, Stretch, lay
from cadpanel.brep.curves.pieces import Piece
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.kernel.tolerances import CLOSE
from tests.known_faces import arc_face, face_on, graph_surface

RADIUS = 1000.0


def bowl():
    return patch_of(face_on(graph_surface(lambda x, y: 3e-4 * x * x - 2e-4 * x * y)))


def stretch(patch, line, count=9):
    """A stretch along a line (m,) -> (m, 2) of the parameter plane, told of at few points."""
    places = np.linspace(0.0, 1.0, count)
    piece = Piece(at=lambda at: patch.points(line(at)), parameters=places, points=patch.points(line(places)))
    return Stretch(curve=0, piece=piece, places=places, line=line(places), offset=0.0)


def along(edge, count=80):
    curve = BRepAdaptor_Curve(edge)
    places = np.linspace(curve.FirstParameter(), curve.LastParameter(), count)
    return np.array([curve.Value(place).Coord() for place in places.tolist()])


def off(points, patch, line):
    """How far points lie beside a line of a patch at most, by ever closer points of it."""
    fine = patch.points(line(np.linspace(0.0, 1.0, 20_001)))
    nearest = [np.linalg.norm(fine - point, axis=1).argmin() for point in points]
    near = np.clip(nearest, 1, len(fine) - 2)
    ways = fine[near + 1] - fine[near - 1]
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    away = points - fine[near]
    return np.linalg.norm(away - np.sum(away * ways, axis=1)[:, None] * ways, axis=1).max()


def wave(height, waves):
    return lambda t: np.stack([0.1 + 0.8 * t, 0.5 + height * np.sin(2.0 * np.pi * waves * t)], axis=1)


@settings(max_examples=6)
@given(height=st.floats(0.0, 0.3), waves=st.integers(1, 4), count=st.sampled_from([9, 40]))
def test_an_edge_follows_a_wave_and_ends_where_it_does(height, waves, count):
    patch, line = bowl(), wave(height, waves)
    assert lay(patch, []) == []
    (edge,) = lay(patch, [stretch(patch, line, count)])
    assert edge is not None
    found = along(edge)
    assert off(found, patch, line) <= CLOSE
    np.testing.assert_allclose(found[[0, -1]], patch.points(line(np.array([0.0, 1.0]))), atol=1e-9)


def test_straight_lines_of_the_parameter_plane_need_few_poles_and_waves_more():
    patch = bowl()
    straight, waved = lay(patch, [stretch(patch, wave(0.0, 1), 200), stretch(patch, wave(0.2, 3), 200)])
    poles = [BRepAdaptor_Curve(edge).BSpline().NbPoles() for edge in (straight, waved)]
    assert poles[0] < 50
    assert poles[0] < poles[1]


def test_a_helix_on_a_cylinder_is_as_long_as_its_triangle():
    """Unrolled, it is a straight line."""
    patch = patch_of(arc_face(RADIUS, 0.0, 120.0))
    low, high = patch.bounds[:, 0], patch.bounds[:, 1]
    (edge,) = lay(patch, [stretch(patch, lambda t: low + t[:, None] * (high - low))])
    length = GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge))
    assert length == pytest.approx(np.hypot(RADIUS * np.radians(120.0), 1000.0), abs=CLOSE)


def test_an_end_that_is_drawn_on_is_kept():
    """Beyond the end of the curve there is nothing that the edge could be held against."""
    patch = bowl()
    own = stretch(patch, wave(0.0, 1))
    onward = Stretch(
        curve=0,
        piece=own.piece,
        places=np.concatenate([own.places, [np.nan]]),
        line=np.concatenate([own.line, [[1.0, 0.5]]]),
        offset=0.0,
    )
    (edge,) = lay(patch, [onward])
    np.testing.assert_allclose(along(edge)[-1], patch.points(np.array([1.0, 0.5])), atol=HALF)


def test_points_told_twice_change_nothing():
    patch = bowl()
    own = stretch(patch, wave(0.1, 1), 30)
    twice = Stretch(
        curve=0, piece=own.piece, places=np.repeat(own.places, 2), line=np.repeat(own.line, 2, axis=0), offset=0.0
    )
    first, second = (along(edge) for edge in (*lay(patch, [own]), *lay(patch, [twice])))
    np.testing.assert_allclose(first, second, atol=CLOSE)
