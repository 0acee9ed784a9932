"""Flat faces with lines and arcs, and edges of skins found by their corners."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest

from cadpanel.brep.building.drawn import edges_along, flat_face
from cadpanel.brep.building.mass_properties import areas_and_centroids
from cadpanel.brep.building.sheet import build_skin
from cadpanel.brep.kernel.kept import kept_binary, kept_shape
from cadpanel.brep.kernel.shapes import edges_of, faces_of, loose_edges
from cadpanel.brep.proof.inspection import inspect, vertices_of
from cadpanel.features.catalogue import feature
from cadpanel.geometry.biarcs import arc_contour_area
from tests.instances import random_polygon, random_shapes

NO_LINES = np.empty((0, 2, 2))


def test_a_disc_of_two_half_circles_has_its_area_and_lies_in_the_plane() -> None:
    face = flat_face(np.array([[3.0, 1.0, 1.0], [-3.0, 1.0, 1.0]]), NO_LINES)
    facts = inspect("disc", face)
    assert facts.valid
    assert facts.areas.sum() == pytest.approx(9.0 * math.pi, rel=1e-12)
    assert np.abs(vertices_of(face)[:, 2]).max() == 0.0


def test_contours_that_bulge_in_and_out_have_the_area_of_their_arcs() -> None:
    contour = np.array([[0, 0, 0.3], [1000, 0, 0.0], [1000, 500, -0.2], [300, 600, 1e-12], [0, 500, -0.4]], dtype=float)
    lines = np.array([[[100.0, 10.0], [100.0, 400.0]]])
    shape = flat_face(contour, lines)
    (face,) = faces_of(shape)
    assert areas_and_centroids([face])[0] == pytest.approx(arc_contour_area(contour), rel=1e-9)
    assert inspect("part", shape).valid
    assert len(loose_edges(shape)) == 1
    assert len(edges_of(face)) == len(contour)


def test_holes_are_taken_out_of_a_flat_face() -> None:
    contour = np.array([[0, 0, 0.0], [1000, 0, 0.1], [1000, 500, 0.0], [0, 500, 0.0]], dtype=float)
    holes = np.array([[40.0, 50.0, 13.0], [900.0, 400.0, 30.0]])
    shape = flat_face(contour, NO_LINES, holes)
    (face,) = faces_of(shape)
    wanted = arc_contour_area(contour) - 0.25 * math.pi * (13.0**2 + 30.0**2)
    assert areas_and_centroids([face])[0] == pytest.approx(wanted, rel=1e-9)
    assert inspect("part", shape).valid
    assert len(edges_of(face)) == len(contour) + len(holes)


def test_edges_of_skins_are_found_along_their_corners() -> None:
    chain = random_shapes(feature("plane-cone-plane"), 1, 1)[0]
    polygon = random_polygon(1, 5)
    for shape, edge, pieces in ((chain, "end 1", 3), (chain, "side 0", 1), (polygon, "edge 4", 1)):
        row = shape.edge(edge).corners
        found = edges_along([(build_skin(shape), row)])
        assert len(edges_of(found)) == pieces
        places = vertices_of(found)
        assert np.linalg.norm(places[:, None] - row, axis=-1).min(axis=0).max() < 1e-9
        with pytest.raises(ValueError, match="no edge between"):
            edges_along([(build_skin(shape), row + 1.0)])


def test_a_shape_is_the_same_after_it_was_text() -> None:
    skin = build_skin(random_shapes(feature("tri-cone"), 2, 1)[0])
    again = kept_shape(kept_binary(skin))
    assert vertices_of(again) == pytest.approx(vertices_of(skin), rel=1e-14)
    areas = [areas_and_centroids(faces_of(shape))[0] for shape in (again, skin)]
    assert areas[0] == pytest.approx(areas[1], rel=1e-13)
    data = kept_binary(skin)
    tail = struct.pack("<3i", 10_000, 0, 0)
    for damaged in (b"no shape", data[:40], data[:400], data[:-12] + tail):
        assert kept_shape(damaged).IsNull()
