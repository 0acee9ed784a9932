"""Small model files for the tests of reading: lips as one strip, in several formats and units."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from OCP.BinTools import BinTools
from OCP.BRepTools import BRepTools
from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESCAFControl import IGESCAFControl_Writer
from OCP.IGESControl import IGESControl_Controller
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from cadpanel.brep.files.model import Label
from cadpanel.brep.kernel.messages import silence_kernel
from tests.reference_shapes import Lip, kernel_face

Labelled = tuple[Label, TopoDS_Shape, Sequence[tuple[Label, TopoDS_Shape]]]

STRIP = Lip(length=9000.0, twist=1.0, taper=0.05)
CUTS = (0.0, 1.0, 2.0, 3.0)


def strip_faces(lip: Lip = STRIP, poles: int = 24) -> list[TopoDS_Shape]:
    """The three faces of a lip that is to be cut into panels."""
    return [kernel_face(lip, (CUTS[k], CUTS[k + 1]), poles=poles) for k in range(3)]


def labelled_document(parts: Sequence[Labelled]) -> TDocStd_Document:
    """A document of parts with names, colours and layers, each with labelled faces of its own."""
    silence_kernel()
    document = TDocStd_Document(TCollection_ExtendedString("test"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    layers = XCAFDoc_DocumentTool.LayerTool_s(document.Main())
    for label, shape, faces in parts:
        part = shapes.AddShape(shape, False)
        for said, target in ((label, part), *((said, shapes.AddSubShape(part, face)) for said, face in faces)):
            if said.name:
                TDataStd_Name.Set_s(target, TCollection_ExtendedString(said.name, True))
            if said.color:
                red, green, blue = (int(said.color[k : k + 2], 16) / 255 for k in (1, 3, 5))
                colors.SetColor(target, Quantity_Color(red, green, blue, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)
            if said.layer:
                layers.SetLayer(target, TCollection_ExtendedString(said.layer, True))
    return document


def write_labelled(path: Path, parts: Sequence[Labelled], unit: str = "MM") -> Path:
    """Write parts with their labels as STEP or IGES, by the path's ending."""
    document = labelled_document(parts)
    if path.suffix == ".step":
        writer = STEPCAFControl_Writer()
        Interface_Static.SetCVal_s("write.step.unit", unit)
        Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", 1)
        try:
            writer.SetNameMode(True)
            writer.SetColorMode(True)
            writer.SetLayerMode(True)
            assert writer.Transfer(document, STEPControl_AsIs)
            assert writer.Write(str(path)) == IFSelect_RetDone
        finally:
            Interface_Static.SetCVal_s("write.step.unit", "MM")
            Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", 0)
        return path
    IGESControl_Controller.Init_s()
    Interface_Static.SetCVal_s("write.iges.unit", unit)
    try:
        iges = IGESCAFControl_Writer()
        assert iges.Transfer(document)
        iges.ComputeModel()
        assert iges.Write(str(path))
    finally:
        Interface_Static.SetCVal_s("write.iges.unit", "MM")
    return path


def write_shape(path: Path, shape: TopoDS_Shape) -> Path:
    """Write one shape as .brep text, or binary where the path ends in .bin.brep."""
    if path.name.endswith(".bin.brep"):
        assert BinTools.Write_s(shape, str(path))
    else:
        assert BRepTools.Write_s(shape, str(path))
    return path
