"""Surfaces evaluated together agree with the kernel, which evaluates them point by point."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import (
    Geom_BezierSurface,
    Geom_BSplineSurface,
    Geom_CylindricalSurface,
    Geom_SphericalSurface,
    Geom_ToroidalSurface,
)
from OCP.GeomConvert import GeomConvert
from OCP.gp import gp_Ax1, gp_Ax3, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.surface_batch import SurfaceBatch

SIZE = 1000.0  # mm, of the random surfaces
ROUNDING = 1e-11  # of values and of derivatives, relative to their size


def kernel_array(array, values):
    for index, value in enumerate(values, start=1):
        array.SetValue(index, value)
    return array


def knots_and_multiplicities(random, degree, spans):
    knots = np.cumsum(random.uniform(0.2, 1.0, spans + 1)) - 0.7
    inner = random.integers(1, degree + 1, spans - 1).tolist()
    return knots.tolist(), [degree + 1, *inner, degree + 1]


def kernel_surface(random, degrees, spans, rational):
    (knots_u, times_u), (knots_v, times_v) = (
        knots_and_multiplicities(random, degree, count) for degree, count in zip(degrees, spans, strict=True)
    )
    shape = sum(times_u) - degrees[0] - 1, sum(times_v) - degrees[1] - 1
    poles, weights = TColgp_Array2OfPnt(1, shape[0], 1, shape[1]), TColStd_Array2OfReal(1, shape[0], 1, shape[1])
    for i in range(shape[0]):
        for j in range(shape[1]):
            x, y, z = random.uniform(0.0, 0.3 * SIZE, 3) + np.array([i / shape[0], j / shape[1], 0.0]) * SIZE
            poles.SetValue(i + 1, j + 1, gp_Pnt(x, y, z))
            weights.SetValue(i + 1, j + 1, random.uniform(0.5, 2.0) if rational else 1.0)
    return Geom_BSplineSurface(
        poles,
        weights,
        *(kernel_array(TColStd_Array1OfReal(1, len(knots)), knots) for knots in (knots_u, knots_v)),
        *(kernel_array(TColStd_Array1OfInteger(1, len(times)), times) for times in (times_u, times_v)),
        *degrees,
    )


def face_on(surface, low=(0.0, 0.0), high=(1.0, 1.0), moved=True):
    """A face on a part of the range, moved about."""
    u_first, u_last, v_first, v_last = surface.Bounds()
    u, v = (u_first, u_last - u_first), (v_first, v_last - v_first)
    face = BRepBuilderAPI_MakeFace(
        surface, u[0] + low[0] * u[1], u[0] + high[0] * u[1], v[0] + low[1] * v[1], v[0] + high[1] * v[1], 1e-7
    ).Face()
    turn, shift = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(1.0, 2.0, 3.0), gp_Dir(1.0, 2.0, -1.0)), 0.7)
    shift.SetTranslation(gp_Vec(100.0, -200.0, 300.0))
    place = TopLoc_Location(shift.Multiplied(turn)) if moved else TopLoc_Location()
    return BRepAdaptor_Surface(TopoDS.Face_s(face.Moved(place)))


def kernel_values(surface, parameters):
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    values = []
    for u, v in parameters:
        surface.D1(u, v, point, along_u, along_v)
        values.append([point.Coord(), along_u.Coord(), along_v.Coord()])
    return np.array(values).transpose(1, 0, 2)


def places(surface, random, count=20):
    """Parameters inside, on the border and at the corners of a face."""
    ends = [
        (surface.FirstUParameter(), surface.LastUParameter()),
        (surface.FirstVParameter(), surface.LastVParameter()),
    ]
    inside = np.stack([random.uniform(*end, count) for end in ends], axis=1)
    border = inside[:4].copy()
    border[[0, 1], 0], border[[2, 3], 1] = ends[0], ends[1]
    return np.concatenate([inside, border, [(u, v) for u in ends[0] for v in ends[1]]])


def disagreement(surfaces, random):
    """Greatest difference of any value from the kernel's, relative to the size of its kind."""
    batch = SurfaceBatch(surfaces)
    parameters = np.array([places(surface, random) for surface in surfaces])
    found = np.array(batch.evaluate(np.arange(len(surfaces))[:, None], parameters))
    wanted = np.stack([kernel_values(surface, own) for surface, own in zip(surfaces, parameters, strict=True)], axis=1)
    return float((np.abs(found - wanted).max(axis=(2, 3)) / np.abs(wanted).max(axis=(2, 3))).max())


@given(
    seed=st.integers(0, 2**32 - 1),
    degrees=st.tuples(st.integers(1, 6), st.integers(1, 6)),
    spans=st.tuples(st.integers(1, 5), st.integers(1, 5)),
    rational=st.booleans(),
    low=st.tuples(st.floats(0.0, 0.4), st.floats(0.0, 0.4)),
    high=st.tuples(st.floats(0.6, 1.0), st.floats(0.6, 1.0)),
)
@settings(max_examples=60)
def test_splines_agree_with_the_kernel_on_trimmed_ranges_and_their_borders(seed, degrees, spans, rational, low, high):
    random = np.random.default_rng(seed)
    surface = kernel_surface(random, degrees, spans, rational)
    placed = [face_on(surface), face_on(surface, low, high), face_on(surface, low, high, moved=False)]
    assert disagreement(placed, random) < ROUNDING


def test_surfaces_of_all_kinds_are_evaluated_together_each_by_its_own_means():
    random = np.random.default_rng(3)
    frame = gp_Ax3(gp_Pnt(10.0, 20.0, 30.0), gp_Dir(0.0, 1.0, 1.0))
    poles = TColgp_Array2OfPnt(1, 3, 1, 4)
    for i in range(1, 4):
        for j in range(1, 5):
            poles.SetValue(i, j, gp_Pnt(*(random.uniform(0.0, 300.0, 3) + 300.0 * np.array([i, j, 0.0]))))
    cylinder = Geom_CylindricalSurface(frame, 500.0)
    surfaces = [
        face_on(kernel_surface(random, (3, 3), (4, 2), False)),
        BRepAdaptor_Surface(BRepBuilderAPI_MakeFace(cylinder, 0.1, 2.0, 0.0, 700.0, 1e-7).Face()),
        face_on(Geom_BezierSurface(poles)),
        face_on(kernel_surface(random, (2, 3), (3, 2), True)),
        face_on(kernel_surface(random, (3, 3), (1, 5), False), (0.1, 0.2), (0.7, 0.9)),
        face_on(Geom_SphericalSurface(frame, 400.0), (0.0, 0.3), (0.5, 0.7)),
    ]
    assert disagreement(surfaces, random) < ROUNDING


@pytest.mark.parametrize("part", [(0.0, 1.0), (0.2, 0.6), (0.7, 1.2)])
def test_periodic_splines_go_on_beyond_the_end_of_their_period(part):
    random = np.random.default_rng(5)
    ring = GeomConvert.SurfaceToBSplineSurface_s(Geom_ToroidalSurface(gp_Ax3(), 900.0, 300.0))
    assert ring.IsUPeriodic()
    assert ring.IsVPeriodic()
    low, high = part
    assert (
        disagreement([face_on(ring, (low, 0.1), (high, 0.8)), face_on(ring, (0.3, low), (0.5, high))], random)
        < ROUNDING
    )


def test_on_a_crease_the_derivative_is_the_one_from_inside_the_face():
    knots, times = [0.0, 1.0, 2.0], [2, 1, 2]
    poles = TColgp_Array2OfPnt(1, 3, 1, 2)
    for i, (x, z) in enumerate([(0.0, 0.0), (1.0, 0.0), (2.0, 1.0)], start=1):
        for j in (1, 2):
            poles.SetValue(i, j, gp_Pnt(x, float(j), z))
    creased = Geom_BSplineSurface(
        poles,
        kernel_array(TColStd_Array1OfReal(1, 3), knots),
        kernel_array(TColStd_Array1OfReal(1, 2), [0.0, 1.0]),
        kernel_array(TColStd_Array1OfInteger(1, 3), times),
        kernel_array(TColStd_Array1OfInteger(1, 2), [2, 2]),
        1,
        1,
    )
    before = face_on(creased, (0.0, 0.0), (0.5, 1.0), moved=False)
    behind = face_on(creased, (0.5, 0.0), (1.0, 1.0), moved=False)
    _, along_u, _ = SurfaceBatch([before, behind]).evaluate(np.array([0, 1]), np.array([[1.0, 0.5], [1.0, 0.5]]))
    np.testing.assert_allclose(along_u, [[1.0, 0.0, 0.0], [1.0, 0.0, 1.0]], atol=1e-15)


def test_another_surface_does_not_agree():
    random = np.random.default_rng(7)
    surface = kernel_surface(random, (3, 2), (3, 3), True)
    own = face_on(surface)
    parameters = places(own, random)
    found = np.array(SurfaceBatch([own]).evaluate(np.array(0), parameters))
    pole = surface.Pole(2, 2)
    surface.SetPole(2, 2, gp_Pnt(pole.X() + 1e-4, pole.Y(), pole.Z()))
    off = np.abs(found - kernel_values(face_on(surface), parameters)).max(axis=(1, 2))
    assert (off > 1e-6).all()


def test_no_points_and_single_points_keep_their_shapes():
    batch = SurfaceBatch([face_on(kernel_surface(np.random.default_rng(1), (2, 2), (2, 2), False))])
    for shape in ((0,), (1,), (2, 0), (2, 3)):
        for values in batch.evaluate(np.array(0), np.full((*shape, 2), math.nan if 0 in shape else 0.1)):
            assert values.shape == (*shape, 3)
