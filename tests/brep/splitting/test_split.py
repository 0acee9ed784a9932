import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.GCE2d import GCE2d_MakeSegment
from OCP.Geom import Geom_Plane
from OCP.gp import gp_Pln, gp_Pnt2d
from OCP.TopoDS import TopoDS

from cadpanel.brep.cutting.by_grid import line_edge
from cadpanel.brep.faces.face_patch import geometry, patch_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.splitting.split_along_edges import split_along
from cadpanel.brep.splitting.splitter import FUZZY, area_of, require_whole, split_faces
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.known_faces import RADIUS, disc, spline_plane
from tests.model_files import write_shape
from tests.thorough import cases

pytestmark = pytest.mark.each_value_once

AREA = np.pi * RADIUS**2
LOST = 1e-6  # part of the area


@pytest.mark.parametrize("surface", [gp_Pln(), spline_plane()], ids=["plane", "spline"])
def test_disc_is_cut_into_quarters_of_its_circle(tmp_path, surface):
    path = write_shape(tmp_path / "disc.brep", disc(surface))
    panels = read_raw_panels(path, ReferenceSettings(unit="mm", grid=(2, 2))).panels
    assert [panel.name for panel in panels] == ["S1-R01-C01", "S1-R01-C02", "S1-R02-C01", "S1-R02-C02"]
    areas = [sum(face.weights.sum() for face in panel.faces) for panel in panels]
    assert areas == pytest.approx(4 * [AREA / 4], rel=1e-4)
    assert sum(areas) == pytest.approx(AREA, rel=LOST)


def test_border_beside_its_own_edge_is_laid_along_it():
    coarse = disc(spline_plane())
    assert area_of(coarse) != pytest.approx(AREA, rel=1e-6)
    face = patch_of(coarse).face
    assert BRepCheck_Analyzer(face).IsValid()
    assert area_of(face) == pytest.approx(AREA, rel=1e-7)


def test_area_within_the_tolerance_of_the_border_is_not_lost():
    face = disc(spline_plane())
    tools = [line_edge(patch_of(face), axis, 0.5) for axis in (0, 1)]
    for split in (split_faces, split_along):
        assert len(split([face], tools, "a disc").faces[0]) == 4


def chord(patch, start, stop):
    """The edge between two places of the parameter plane, in parts of the face's range."""
    low, width = patch.bounds[:, 0], np.ptp(patch.bounds, axis=1)
    ends = [gp_Pnt2d(*(low + width * np.array(place)).tolist()) for place in (start, stop)]
    edge = BRepBuilderAPI_MakeEdge(GCE2d_MakeSegment(*ends).Value(), geometry(patch)).Edge()
    BRepLib.BuildCurves3d_s(edge)
    return edge


@pytest.mark.parametrize("seed", cases(range(4), range(12)))
@pytest.mark.parametrize("turned", [False, True], ids=["forward", "reversed"])
def test_chords_leave_the_pieces_that_the_kernel_finds_the_slow_way(seed, turned):
    random = np.random.default_rng(seed)
    face = patch_of(disc(spline_plane())).face
    face = TopoDS.Face_s(face.Reversed()) if turned else face
    patch = patch_of(face)
    chords = [chord(patch, (-0.1, y0), (1.1, y1)) for y0, y1 in random.uniform(0.1, 0.9, (3, 2))]
    chords += [chord(patch, (x0, -0.1), (x1, 1.1)) for x0, x1 in random.uniform(0.1, 0.9, (3, 2))]
    fast, slow = (split([face], chords, "a disc") for split in (split_along, split_faces))
    assert all(BRepCheck_Analyzer(part).IsValid() for part in fast.faces[0])
    assert {part.Orientation() for part in fast.faces[0]} == {face.Orientation()}
    areas = [sorted(map(area_of, found.faces[0])) for found in (fast, slow)]
    assert len(areas[0]) > 7
    assert areas[0] == pytest.approx(areas[1], rel=1e-6, abs=1e-3)
    assert [len(parts) for parts in fast.tools] == [len(parts) for parts in slow.tools]


@pytest.mark.parametrize(("end", "pieces"), [(1.5, [2, 1]), (3.5, [2, 2])], ids=["one", "both"])
def test_edge_on_the_surface_of_two_faces_cuts_those_that_it_passes_over(end, pieces):
    plane = Geom_Plane(gp_Pln())
    squares = [BRepBuilderAPI_MakeFace(plane, x, x + 10.0, 0.0, 10.0, 1e-7).Face() for x in (0.0, 20.0)]
    edge = chord(patch_of(squares[0]), (-0.1, 0.5), (end, 0.5))
    found = split_along(squares, [edge], "two squares")
    assert [len(parts) for parts in found.faces] == pieces


def test_a_piece_that_is_lost_or_counted_twice_is_refused():
    face = patch_of(disc(spline_plane())).face
    patch = patch_of(face)
    parts = split_along([face], [line_edge(patch, axis, 0.5) for axis in (0, 1)], "a disc").faces[0]
    require_whole(face, parts, "a disc", FUZZY)
    for wrong in (parts[1:], (*parts, parts[0])):
        with pytest.raises(ReferenceFileError, match="cannot split a disc"):
            require_whole(face, wrong, "a disc", FUZZY)
