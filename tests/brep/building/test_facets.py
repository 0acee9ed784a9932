"""How far triangles lie from their face: as far as the chord's bow, also where sides run aslant over a cone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface
from OCP.gp import gp_Ax3
from OCP.TopoDS import TopoDS_Face

from cadpanel.brep.building.facets import corners_of, farthest, near, triangles_of


def cone(half_angle: float, *, radius: float = 200.0, sweep: float = 1.0, length: float = 2000.0) -> TopoDS_Face:
    return BRepBuilderAPI_MakeFace(
        Geom_ConicalSurface(gp_Ax3(), half_angle, radius), 0.0, sweep, 0.0, length, 1e-7
    ).Face()


def test_a_face_without_triangles_and_a_plane_are_as_near_as_can_be() -> None:
    face = cone(0.3)
    assert triangles_of(face) is None
    assert farthest(face, 1.0) == 0.0


@pytest.mark.parametrize("coarse", [0.2, 0.5])
def test_triangles_of_a_cylinder_lie_as_far_inside_as_their_chords_bow(coarse: float) -> None:
    face = BRepBuilderAPI_MakeFace(Geom_CylindricalSurface(gp_Ax3(), 100.0), 0.0, 1.5, 0.0, 50.0, 1e-7).Face()
    BRepMesh_IncrementalMesh(face, 100.0, False, coarse, False)
    mesh = triangles_of(face)
    assert mesh is not None
    _, places, named = corners_of(mesh)
    step = np.ptp(places[named][..., 0], axis=1).max()
    assert step > 0.05
    assert farthest(face, 0.0) == pytest.approx(100.0 * (1.0 - math.cos(0.5 * step)), rel=0.02)


def test_the_middle_of_a_side_aslant_over_a_cone_is_held_against_the_place_beside_it() -> None:
    surface = BRepAdaptor_Surface(cone(0.6))
    places = np.array([[0.0, 0.0], [0.2, 2000.0]])
    ends = np.array([surface.Value(u, v).Coord() for u, v in places.tolist()])
    middle, shown = places.mean(axis=0, keepdims=True), ends.mean(axis=0, keepdims=True)
    straight, closer = (float(np.linalg.norm(near(surface, middle, shown, far) - shown)) for far in (math.inf, 0.0))
    # From its axis the middle is so far away, and the cone there so far.
    height, away = shown[0, 2], np.hypot(*shown[0, :2])
    distance = (200.0 + height * math.tan(0.6) - away) * math.cos(0.6)
    assert 0.999 * distance <= closer <= 1.5 * distance
    assert straight > 3.0 * closer
    assert np.array_equal(near(surface, middle, shown, 1.001 * straight), near(surface, middle, shown, math.inf))
