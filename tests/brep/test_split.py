import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.Geom import Geom_BezierSurface, Geom_Circle
from OCP.GeomConvert import GeomConvert
from OCP.gp import gp_Ax2, gp_Dir, gp_Pln, gp_Pnt
from OCP.ShapeFix import ShapeFix_Face
from OCP.TColgp import TColgp_Array2OfPnt

from cadpanel.brep.patch import patch_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.split import area_of, split_faces
from cadpanel.brep.subdivide.grid import line_edge
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import write_shape

RADIUS = 500.0
AREA = np.pi * RADIUS**2
LOST = 1e-6  # part of the area


def spline_plane():
    poles = TColgp_Array2OfPnt(1, 2, 1, 2)
    for row, x in enumerate((-RADIUS, RADIUS), start=1):
        for column, y in enumerate((-RADIUS, RADIUS), start=1):
            poles.SetValue(row, column, gp_Pnt(x, y, 0.0))
    return GeomConvert.SurfaceToBSplineSurface_s(Geom_BezierSurface(poles))


def disc(surface):
    """A disc as the readers make it: on a spline surface its border runs up to 0.8 mm beside the circle."""
    circle = Geom_Circle(gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0)), RADIUS)
    if not isinstance(surface, gp_Pln):
        circle = GeomConvert.CurveToBSplineCurve_s(circle)
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire()
    fixing = ShapeFix_Face(BRepBuilderAPI_MakeFace(surface, wire, True).Face())
    fixing.Perform()
    fixing.FixOrientation()
    BRepLib.SameParameter_s(fixing.Face(), 1e-7, True)
    assert BRepCheck_Analyzer(fixing.Face()).IsValid()
    return fixing.Face()


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
    assert area_of(coarse, exactly=True) != pytest.approx(AREA, rel=1e-6)
    face = patch_of(coarse).face
    assert BRepCheck_Analyzer(face).IsValid()
    assert area_of(face, exactly=True) == pytest.approx(AREA, rel=1e-7)


def test_area_within_the_tolerance_of_the_border_is_not_lost():
    patch = patch_of(disc(spline_plane()))
    tools = [line_edge(patch, axis, 0.5) for axis in (0, 1)]
    assert len(split_faces([disc(spline_plane())], tools, "a disc").faces[0]) == 4
