"""STEP files whose products stand in assemblies, under names of their own."""

from __future__ import annotations

from OCP.gp import gp_Trsf, gp_Vec
from OCP.IFSelect import IFSelect_RetDone
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from cadpanel.brep.files.xcaf import new_document
from tests.reference_shapes import Lip, kernel_lip


def nested(path, product="Panel", instances=("inst0", "inst1")):
    """Three times an assembly of two panels that are one product."""
    document = new_document()
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    part = named(shapes.AddShape(kernel_lip(Lip(twist=0.0, taper=0.0)), False), product)
    inner, outer = named(shapes.NewShape(), "Sub"), named(shapes.NewShape(), "Top")
    for place, instance in enumerate(instances):
        named(shapes.AddComponent(inner, part, at(2000.0 * place)), instance)
    for place in range(3):
        named(shapes.AddComponent(outer, inner, at(4000.0 * place)), f"sub{place}")
    shapes.UpdateAssemblies()
    writer = STEPCAFControl_Writer()
    writer.SetNameMode(True)
    writer.Transfer(document, STEPControl_AsIs)
    assert writer.Write(str(path)) == IFSelect_RetDone
    return path


def at(x):
    moving = gp_Trsf()
    moving.SetTranslation(gp_Vec(x, 0.0, 0.0))
    return TopLoc_Location(moving)


def named(label, name):
    if name:
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
    return label
