"""From a STEP file to named shapes, one a panel.

A panel is a product of the file. Assemblies are flattened. Programs differ in what they make of a compound of faces:
some write one product, some an assembly with a nameless product for each face; both are one panel here.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Check
from OCP.Standard import Standard_Failure
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TColStd import TColStd_SequenceOfAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_COMPOUND, TopAbs_FACE, TopAbs_SHELL
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cadpanel.brep.files.model import NamedShape, Products
from cadpanel.brep.files.names import call_panels
from cadpanel.brep.files.step_damage import damage
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.brep.kernel.shapes import children, shapes_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError

# Names that programs give when the user gave none.
GENERIC_NAME = re.compile(
    r"|Open CASCADE .*|Open_CASCADE.*|=>\[.*\]|NAUO\d*|"
    r"(compound|shell|open shell|face|surface|product|part|none|unnamed|no name)[ _.:#-]*\d*",
    re.IGNORECASE,
)


@dataclass(frozen=True, slots=True)
class _Use:
    """A product in its place; names are empty where the file gives none.

    Attributes:
        product: the product's name.
        instance: the name of this use of the product in its assembly.
        shape: the placed shape.
    """

    product: str
    instance: str
    shape: TopoDS_Shape


def read_products(path: Path, millimetres: float | None = None) -> Products:
    """Return the file's panels.

    They are called as `call_panels` says.

    Args:
        path: the file.
        millimetres: how many the unit has, where the file says none; None for one.

    Raises:
        ReferenceFileError: the kernel cannot read the file, or only a part of it.
    """
    silence_kernel()
    document = TDocStd_Document(TCollection_ExtendedString("cadpanel"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = STEPCAFControl_Reader()
    # Only names matter here; leaving out the rest makes the reader as fast as one that knows no names at all.
    for leave_out in (
        reader.SetColorMode,
        reader.SetLayerMode,
        reader.SetPropsMode,
        reader.SetMetaMode,
        reader.SetGDTMode,
        reader.SetMatMode,
        reader.SetViewMode,
        reader.SetSHUOMode,
    ):
        leave_out(False)
    try:
        transfer(path, document, reader)
        labels = TDF_LabelSequence()
        XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(labels)
        roots = [labels.Value(index) for index in range(1, labels.Length() + 1)]
        uses = [use for root in roots for use in _flatten(root, TopLoc_Location())]
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({error}): repair the reference and export it again."
        ) from error
    if len(uses) == 1:
        uses = [replace(uses[0], shape=shape) for shape in split_groups(uses[0].shape)]
    unit = file_unit(reader)
    factor = millimetres or 1.0 if unit is None else 1.0
    names = call_panels([(use.product, use.instance) for use in uses])
    shapes = tuple(NamedShape(name, scaled(use.shape, factor)) for name, use in zip(names, uses, strict=True))
    return Products(shapes=shapes, unit=unit)


def transfer(path: Path, document: TDocStd_Document, reader: STEPCAFControl_Reader) -> None:
    """Read a STEP file into a document and refuse what was read only in part.

    Raises:
        ReferenceFileError: naming what the kernel could not read.
    """
    if reader.ReadFile(str(path)) != IFSelect_RetDone:
        raise ReferenceFileError(f"'{path.name}' is damaged: the CAD kernel cannot read it; export it again.")
    fault = damage(reader.Reader().StepModel())
    if fault is not None:
        raise ReferenceFileError(f"'{path.name}' is damaged ({fault}): export the reference again.")
    reader.Transfer(document)
    checks = reader.Reader().WS().TransferReader().LastCheckList()
    checks.Start()
    while checks.More():
        if checks.Value().HasFailed():
            raise ReferenceFileError(
                f"'{path.name}' holds a shape that the CAD kernel cannot read ({_first_fail(checks.Value())}): "
                "repair it and export the reference again."
            )
        checks.Next()


def file_unit(reader: STEPCAFControl_Reader) -> str | None:
    """The units of length of a file that is read, in its own words; None where it says none."""
    lengths, angles, solid_angles = (TColStd_SequenceOfAsciiString() for _ in range(3))
    reader.Reader().FileUnits(lengths, angles, solid_angles)
    words = {str(lengths.Value(index).ToCString()).lower() for index in range(1, lengths.Length() + 1)}
    return " and ".join(sorted(words)) or None


def _first_fail(check: Interface_Check) -> str:
    """Return the first message of a check that has failed."""
    message: str = check.CFail(1)
    return message.strip().rstrip(".")


def _flatten(label: TDF_Label, location: TopLoc_Location) -> list[_Use]:
    """Return the panels below one label, placed by `location`."""
    product = TDF_Label()
    if XCAFDoc_ShapeTool.IsReference_s(label):
        location = location.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label))
        XCAFDoc_ShapeTool.GetReferredShape_s(label, product)
    else:
        product = label
    components = TDF_LabelSequence()
    if XCAFDoc_ShapeTool.IsAssembly_s(product):
        XCAFDoc_ShapeTool.GetComponents_s(product, components)
    if components.Length() == 0 or is_sheet_in_pieces(product, components):
        shape = XCAFDoc_ShapeTool.GetShape_s(product).Moved(location)
        return [_Use(label_name(product), instance_name(label), shape)]
    return [
        panel for index in range(1, components.Length() + 1) for panel in _flatten(components.Value(index), location)
    ]


def is_sheet_in_pieces(assembly: TDF_Label, components: TDF_LabelSequence) -> bool:
    """Tell whether an assembly only holds the nameless single faces of one panel."""
    own_name = label_name(assembly)
    for index in range(1, components.Length() + 1):
        product = TDF_Label()
        XCAFDoc_ShapeTool.GetReferredShape_s(components.Value(index), product)
        if label_name(product) not in ("", own_name) or XCAFDoc_ShapeTool.IsAssembly_s(product):
            return False
        if not _is_one_face(XCAFDoc_ShapeTool.GetShape_s(product)):
            return False
    return True


def label_name(label: TDF_Label) -> str:
    """Return a product's name, empty where it is missing or made up by the writing program."""
    # Asked for first: looking for an attribute that is not there may crash the kernel's binding.
    attribute = TDataStd_Name()
    if not (label.IsAttribute(TDataStd_Name.GetID_s()) and label.FindAttribute(TDataStd_Name.GetID_s(), attribute)):
        return ""
    name: str = attribute.Get().ToExtString().strip()
    return "" if GENERIC_NAME.fullmatch(name) else name


def instance_name(use: TDF_Label) -> str:
    """Return the name of a use of a product; a mere number is what programs call it when the user does not."""
    name = label_name(use)
    return "" if name.isdecimal() else name


def split_groups(shape: TopoDS_Shape) -> list[TopoDS_Shape]:
    """Split a file's only product into its compounds and shells, where it holds more than the faces of one panel."""
    whole = shape
    members = list(children(shape))
    while shape.ShapeType() == TopAbs_COMPOUND and len(members) == 1:
        shape = members[0]
        members = list(children(shape))
    groups = [child for child in members if child.ShapeType() in (TopAbs_COMPOUND, TopAbs_SHELL)]
    if shape.ShapeType() != TopAbs_COMPOUND or len(groups) < len(members) or all(map(_is_one_face, groups)):
        return [whole]
    return groups


def _is_one_face(shape: TopoDS_Shape) -> bool:
    """Tell whether a shape holds exactly one face."""
    return len(shapes_of(shape, TopAbs_FACE)) == 1
