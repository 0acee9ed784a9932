"""One strip and the curves that cut it, written by each format as an assembly, a block or a matrix puts it in place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, cast

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface
from OCP.GeomAbs import GeomAbs_C2
from OCP.GeomAPI import GeomAPI_PointsToBSpline
from OCP.gp import gp_Pnt, gp_Trsf, gp_XYZ
from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESBasic import IGESBasic_SingularSubfigure, IGESBasic_SubfigureDef
from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer
from OCP.IGESData import IGESData_HArray1OfIGESEntity, IGESData_IGESEntity, IGESData_IGESModel
from OCP.IGESGeom import IGESGeom_TransformationMatrix
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TColStd import TColStd_HArray2OfReal
from OCP.TDataStd import TDataStd_Name
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from cadpanel.arrays import Array
from cadpanel.brep.files.xcaf import new_document
from cadpanel.brep.kernel.shapes import compound_of
from tests.model_files import strip_faces, write_shape
from tests.reference_shapes import Lip

STRIP = Lip(length=6000.0, twist=1.0, taper=0.02)
POINTS = 41
POLES = 10
IGES_SPLINES = (126, 128)


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """Where a shape is put: by one (3, 4) matrix after the other, the first one innermost."""

    matrices: tuple[Array, ...]

    @property
    def whole(self) -> Array:
        """(4, 4) all of them as one."""
        found = np.eye(4)
        for matrix in self.matrices:
            found = np.vstack([matrix, [0.0, 0.0, 0.0, 1.0]]) @ found
        return found

    @property
    def mirrors(self) -> bool:
        """Whether any of them mirrors."""
        return any(np.linalg.det(matrix[:, :3]) < 0.0 for matrix in self.matrices)

    def points(self, points: Array) -> Array:
        """Points (..., 3) there."""
        return points @ self.whole[:3, :3].T + self.whole[:3, 3]

    def ways(self, ways: Array) -> Array:
        """Directions (..., 3) there."""
        return ways @ self.whole[:3, :3].T

    def locations(self) -> list[TopLoc_Location]:
        """The kernel's, the innermost first."""
        return [TopLoc_Location(_trsf(matrix)) for matrix in self.matrices]


def matrix(*, turned: bool = False, mirror: bool = False, shift: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
    """(3, 4) mirrored at the plane z = 0, turned about y and then z, and shifted, mm.

    The angles are those of right triangles with whole sides: the files' decimal numbers hold the matrix exactly.
    """
    (c, s), (cos, sin) = ((0.96, 0.28), (0.8, 0.6)) if turned else ((1.0, 0.0), (1.0, 0.0))
    turning = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    tilting = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    linear = turning @ tilting @ np.diag([1.0, 1.0, -1.0 if mirror else 1.0])
    return np.column_stack([linear, np.asarray(shift, dtype=np.float64)])


NOWHERE = Place(matrices=())
SHIFTED = matrix(shift=(1500.0, -700.0, 320.0))
TURNED = matrix(turned=True, shift=(100.0, 200.0, -50.0))
MIRRORED = matrix(mirror=True, shift=(0.0, 40.0, 900.0))
PLACES = {
    "idle": Place(matrices=(matrix(),)),
    "shifted": Place(matrices=(SHIFTED,)),
    "turned": Place(matrices=(TURNED,)),
    "nested": Place(matrices=(TURNED, SHIFTED, matrix())),
    "mirrored": Place(matrices=(MIRRORED,)),
    "mirrored in an assembly": Place(matrices=(TURNED, MIRRORED, SHIFTED)),
    "mirrored twice": Place(matrices=(MIRRORED, TURNED, MIRRORED)),
}
"""Each leaves the strip's parts in the order in which they lie along x, by which panels are numbered."""


def _trsf(matrix: Array) -> gp_Trsf:
    found = gp_Trsf()
    found.SetValues(*(float(number) for number in matrix.ravel()))
    return found


@cache
def faces() -> tuple[TopoDS_Shape, ...]:
    """The strip's three faces."""
    return tuple(strip_faces(STRIP, poles=POLES))


@cache
def curves() -> tuple[TopoDS_Shape, ...]:
    """A curve all along the strip and one across it, on it to some hundredths of a millimetre."""
    u, v, middle = np.linspace(0.0, 3.0, POINTS), np.linspace(0.0, 1.0, POINTS), np.full(POINTS, 0.45)
    return tuple(_curve(STRIP(*place)) for place in ((u, middle), (0.5 + 0.0 * v, v)))


def _curve(points: Array) -> TopoDS_Shape:
    array = TColgp_Array1OfPnt(1, len(points))
    for index, point in enumerate(points.tolist(), start=1):
        array.SetValue(index, gp_Pnt(*point))
    return BRepBuilderAPI_MakeEdge(GeomAPI_PointsToBSpline(array, 3, 8, GeomAbs_C2, 1e-4).Curve()).Edge()


def write(path: Path, shapes: Sequence[TopoDS_Shape], place: Place | None) -> Path:
    """Write shapes in a place, or without any, in the format of the path's ending."""
    return {".step": _step, ".igs": _iges, ".brep": _brep, ".3dm": _rhino}[path.suffix](path, shapes, place)


def _brep(path: Path, shapes: Sequence[TopoDS_Shape], place: Place | None) -> Path:
    if place is None:
        return write_shape(path, compound_of(shapes))
    inner, *outer = place.locations()
    whole: TopoDS_Shape = compound_of(shape.Moved(inner) for shape in shapes)
    for location in outer:
        whole = compound_of([whole.Moved(location)])
    return write_shape(path, whole)


def _step(path: Path, shapes: Sequence[TopoDS_Shape], place: Place | None) -> Path:
    """An assembly of products, in others."""
    document = new_document()
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    parts = [tool.AddShape(shape, False) for shape in shapes]
    for number, part in enumerate(parts, start=1):
        TDataStd_Name.Set_s(part, TCollection_ExtendedString(f"P{number}"))
    for level, location in enumerate(place.locations() if place is not None else ()):
        above = tool.NewShape()
        TDataStd_Name.Set_s(above, TCollection_ExtendedString(f"level {level}"))
        for part in parts:
            tool.AddComponent(above, part, location)
        parts = [above]
    tool.UpdateAssemblies()
    writer = STEPCAFControl_Writer()
    writer.SetNameMode(True)
    assert writer.Transfer(document, STEPControl_AsIs)
    assert writer.Write(str(path)) == IFSelect_RetDone
    return path


def _iges(path: Path, shapes: Sequence[TopoDS_Shape], place: Place | None) -> Path:
    """Entities with a transformation matrix, in subfigures with theirs."""
    IGESControl_Controller.Init_s()
    writer = IGESControl_Writer("MM", 0)
    for shape in shapes:
        assert writer.AddShape(shape)
    model = writer.Model()
    entities = [model.Entity(number) for number in range(1, model.NbEntities() + 1)]
    if place is not None:
        inner, *outer = place.matrices
        own = _iges_matrix(model, inner)
        for entity in entities:
            if entity.TypeNumber() in IGES_SPLINES:
                entity.InitTransf(own)
        members = [entity for entity in entities if entity.SubordinateStatus() == 0 and entity.TypeNumber() != 128]
        for level, rows in enumerate(outer):
            put = _iges_matrix(model, rows)
            members = [_iges_use(model, member, level, put) for member in members]
    writer.ComputeModel()
    assert writer.Write(str(path))
    return path


def _iges_use(
    model: IGESData_IGESModel, member: IGESData_IGESEntity, level: int, put: IGESGeom_TransformationMatrix
) -> IGESBasic_SingularSubfigure:
    """A nameless subfigure of one member, used in a place."""
    listed = IGESData_HArray1OfIGESEntity(1, 1)
    listed.SetValue(1, member)
    figure, use = IGESBasic_SubfigureDef(), IGESBasic_SingularSubfigure()
    figure.Init(level, TCollection_HAsciiString(""), listed)
    use.Init(figure, gp_XYZ(0.0, 0.0, 0.0), False, 1.0)
    use.InitTransf(put)
    model.AddEntity(figure)
    model.AddEntity(use)
    return use


def _iges_matrix(model: IGESData_IGESModel, rows: Array) -> IGESGeom_TransformationMatrix:
    numbers = TColStd_HArray2OfReal(1, 3, 1, 4)
    for row in range(3):
        for column in range(4):
            numbers.SetValue(row + 1, column + 1, float(rows[row, column]))
    found = IGESGeom_TransformationMatrix()
    found.Init(numbers)
    found.SetFormNumber(1 if np.linalg.det(rows[:, :3]) < 0.0 else 0)
    model.AddEntity(found)
    return found


def _rhino(path: Path, shapes: Sequence[TopoDS_Shape], place: Place | None) -> Path:
    """Objects, or a block of them, in other blocks."""
    rhino: Any = import_module("rhino3dm")
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Millimeters
    objects: list[Any] = [_rhino_object(rhino, shape) for shape in shapes]
    if place is None:
        for thing in objects:
            file.Objects.Add(thing)
        assert file.Write(str(path), 8)
        return path
    for level, rows in enumerate(place.matrices):
        attributes = tuple(rhino.ObjectAttributes() for _ in objects)
        name = f"block {level}"
        file.InstanceDefinitions.Add(name, "", "", "", rhino.Point3d(0.0, 0.0, 0.0), tuple(objects), attributes)
        block = next(definition.Id for definition in file.InstanceDefinitions if definition.Name == name)
        transform = rhino.Transform(1.0)
        for row in range(3):
            for column in range(4):
                setattr(transform, f"M{row}{column}", float(rows[row, column]))
        objects = [rhino.InstanceReference(block, transform)]
    file.Objects.AddInstanceObject(objects[0])
    assert file.Write(str(path), 8)
    return path


def _rhino_object(rhino: Any, shape: TopoDS_Shape) -> Any:
    """A face's whole B-spline surface, or an edge's B-spline curve, as rhino3dm has it: without the outermost knots."""
    if shape.ShapeType() == TopAbs_FACE:
        source = cast(Geom_BSplineSurface, BRep_Tool.Surface_s(TopoDS.Face_s(shape)))
        counts, degrees = (source.NbUPoles(), source.NbVPoles()), (source.UDegree(), source.VDegree())
        made = rhino.NurbsSurface.Create(3, False, degrees[0] + 1, degrees[1] + 1, *counts)
        _fill(made.KnotsU, source.UKnotSequence())
        _fill(made.KnotsV, source.VKnotSequence())
        for i in range(counts[0]):
            for j in range(counts[1]):
                made.Points[i, j] = rhino.Point4d(*source.Pole(i + 1, j + 1).Coord(), 1.0)
        return made
    curve = cast(Geom_BSplineCurve, BRepAdaptor_Curve(TopoDS.Edge_s(shape)).BSpline())
    drawn = rhino.NurbsCurve(3, False, curve.Degree() + 1, curve.NbPoles())
    _fill(drawn.Knots, curve.KnotSequence())
    for i in range(curve.NbPoles()):
        drawn.Points[i] = rhino.Point4d(*curve.Pole(i + 1).Coord(), 1.0)
    return drawn


def _fill(knots: Any, sequence: Any) -> None:
    for index in range(2, sequence.Length()):
        knots[index - 2] = sequence.Value(index)
