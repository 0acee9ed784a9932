"""Planes across a surface: every piece lies between its own two, together they cover it, and no place is left empty."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.GCE2d import GCE2d_MakeSegment
from OCP.Geom import Geom_BSplineSurface, Geom_Plane
from OCP.gp import gp_Pln, gp_Pnt2d

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.kernel.splines import knot_arrays, pole_grid
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.skin.split_by_planes import cut_by_planes, places_of
from cadpanel.brep.skin.strip import find_strip
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import ReferenceFileError
from tests.cuts import surface_of
from tests.known_faces import arc_face, disc_on, face_on, graph_surface
from tests.model_files import strip_faces

INSIDE = 0.02


def cuts_across(heights, normal=(1.0, 0.0, 0.0), reach=5000.0, length=4000.0):
    """Planes square to a straight line along x."""
    line = np.stack([np.linspace(-0.1, 1.1, 601) * length, np.zeros(601), np.zeros(601)], axis=1)
    heights = np.array(heights)
    unit = np.array(normal) / np.linalg.norm(normal)
    return Cuts(
        origins=np.outer(heights, (1.0, 0.0, 0.0)),
        normals=np.tile(unit, (len(heights), 1)),
        reach=np.full(len(heights), reach),
        line=line,
        places=np.interp(line[:, 0], [-0.1 * length, *heights, 1.1 * length], np.arange(len(heights) + 2)),
    )


def wavy(length=4000.0):
    """A face along x that rises and falls."""
    return face_on(
        graph_surface(lambda x, y: 1e-4 * x * (length - x) + 2e-4 * y * y, (0.0, -500.0), (length, 0.0), (0.0, 1000.0))
    )


heights = st.lists(st.floats(100.0, 3900.0), min_size=1, max_size=4, unique_by=lambda height: round(height / 150.0))


@settings(max_examples=10)
@given(heights=heights, slant=st.floats(-0.1, 0.1))
def test_pieces_lie_between_their_planes_and_cover_the_surface(heights, slant):
    heights = [height for height in sorted(heights) if 150.0 < height < 3850.0] or [2000.0]
    heights = [height for k, height in enumerate(heights) if k == 0 or height - heights[k - 1] > 250.0]
    face, cuts = wavy(), cuts_across(heights, (1.0, slant, 0.0))
    groups = cut_by_planes(surface_of(face), cuts, "roof.step")
    assert [len(group) for group in groups] == [1] * (len(heights) + 1)
    assert sum(area_of(piece) for group in groups for piece in group) == pytest.approx(area_of(face), rel=1e-6)
    for place, group in enumerate(groups):
        points = np.concatenate([edge for piece in sample_faces(compound_of(group)) for edge in piece.edges])
        if place > 0:
            assert ((points - cuts.origins[place - 1]) @ cuts.normals[place - 1]).min() > -INSIDE
        if place < len(heights):
            assert ((points - cuts.origins[place]) @ cuts.normals[place]).max() < INSIDE


def test_a_trimmed_face_goes_through_the_splitter_and_keeps_its_area():
    plane = Geom_Plane(gp_Pln())
    face = disc_on(plane, (2000.0, 0.0), 1000.0)
    groups = cut_by_planes(surface_of(face), cuts_across([1500.0, 2000.0]), "roof.step")
    segment = np.pi / 3.0 - np.sqrt(3.0) / 4.0  # of a unit circle beyond half its radius
    wanted = [segment * 1e6, (np.pi / 2.0 - segment) * 1e6, np.pi / 2.0 * 1e6]
    assert [sum(map(area_of, group)) for group in groups] == pytest.approx(wanted, rel=1e-4)


def test_planes_across_several_faces_cut_each_of_them():
    faces = strip_faces()
    surface = surface_of(*faces)
    parts = np.array([0.2, 0.5, 0.9])
    groups = cut_by_planes(surface, find_strip(surface, "roof.step", 1.0).planes(parts), "roof.step")
    assert [len(group) for group in groups] == [3] * 4
    shares = np.array([sum(map(area_of, group)) for group in groups]) / sum(map(area_of, faces))
    assert shares.sum() == pytest.approx(1.0, rel=1e-6)
    np.testing.assert_allclose(shares, np.diff([0.0, *parts, 1.0]), atol=0.03)


def test_a_plane_off_the_surface_is_refused_with_its_place():
    with pytest.raises(ReferenceFileError, match=r"Beyond the last cut of 2 there is nothing of the surface of face 1"):
        cut_by_planes(surface_of(wavy()), cuts_across([2000.0, 4200.0]), "roof.step")
    with pytest.raises(ReferenceFileError, match=r"Before the first cut of 2 there is nothing"):
        cut_by_planes(surface_of(wavy()), cuts_across([-200.0, 2000.0]), "roof.step")


@given(places=st.lists(st.floats(-300.0, 4300.0), min_size=1, max_size=30))
def test_places_count_the_planes_that_lie_behind_a_point(places):
    heights = [0.0, 1000.0, 1300.0, 4000.0]
    places = [place for place in places if min(abs(place - height) for height in heights) > 1e-6] or [5.0]
    points = np.stack([places, np.full(len(places), 70.0), np.full(len(places), -40.0)], axis=1)
    wanted = [sum(place > height for height in heights) for place in places]
    assert places_of(points, cuts_across(heights)).tolist() == wanted


def test_half_a_tube_is_cut_along_its_arc_and_each_piece_knows_its_place():
    face = arc_face(1000.0, 0.0, 180.0, 4000.0)
    groups = cut_by_planes(surface_of(face), cuts_across([1000.0, 3000.0]), "roof.step")
    shares = [sum(map(area_of, group)) / area_of(face) for group in groups]
    assert shares == pytest.approx([0.25, 0.5, 0.25], rel=1e-6)


def swept(trimmed):
    """A swept face that bends in a thousandth of its range, as where a spline was drawn on to meet another one."""
    knots = np.array([0.0, 0.0, 0.0, 0.0, 1e-3, 1.0, 1.0, 1.0, 1.0])
    across = np.array([(0.0, 0.0), (0.0, 40.0), (30.0, 60.0), (300.0, 80.0), (600.0, 90.0)])
    rows = [[(x + 0.3 * y, y, z) for y, z in across] for x in (0.0, 4000.0)]
    (knots_u, times_u), (knots_v, times_v) = knot_arrays(np.array([0.0, 0.0, 1.0, 1.0])), knot_arrays(knots)
    surface = Geom_BSplineSurface(pole_grid(np.array(rows)), knots_u, knots_v, times_u, times_v, 1, 3)
    face = BRepBuilderAPI_MakeFace(surface, 1e-7).Face()
    if not trimmed:
        return face
    ends = [(0.0, 0.0), (1.0, 0.0), (0.98, 1.0), (0.01, 0.95)]
    wiring = BRepBuilderAPI_MakeWire()
    for (u, v), (s, t) in zip(ends, [*ends[1:], ends[0]], strict=True):
        line = GCE2d_MakeSegment(gp_Pnt2d(u, v), gp_Pnt2d(s, t)).Value()
        wiring.Add(BRepBuilderAPI_MakeEdge(line, surface).Edge())
    cut = BRepBuilderAPI_MakeFace(surface, wiring.Wire(), True).Face()
    BRepLib.BuildCurves3d_s(cut)
    return cut


@pytest.mark.parametrize("trimmed", [False, True])
def test_cuts_lie_in_their_planes_where_a_spline_does_much_in_a_little_of_its_range(trimmed):
    face, cuts = swept(trimmed), cuts_across([900.0, 1700.0, 2600.0, 3400.0], (0.95, 0.1, 0.3), reach=900.0)
    groups = cut_by_planes(surface_of(face), cuts, "wing.step")
    assert [len(group) for group in groups] == [1] * 5
    for place, group in enumerate(groups):
        points = np.concatenate([edge for piece in sample_faces(compound_of(group)) for edge in piece.edges])
        for plane, side in ((place - 1, -1.0), (place, 1.0)):
            if 0 <= plane < 4:
                assert (side * ((points - cuts.origins[plane]) @ cuts.normals[plane])).max() < INSIDE
