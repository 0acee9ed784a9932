"""From a document of the kernel (what its STEP and IGES readers fill) to parts with names, colours and layers."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import islice

from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_COMPOUND, TopAbs_FACE, TopAbs_SHELL
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import (
    XCAFDoc_ColorGen,
    XCAFDoc_ColorSurf,
    XCAFDoc_ColorTool,
    XCAFDoc_DocumentTool,
    XCAFDoc_LayerTool,
    XCAFDoc_ShapeTool,
)

from cadpanel.brep.files.model import Label, Part
from cadpanel.brep.kernel.shape_maps import ShapeMap
from cadpanel.brep.kernel.shapes import children, compound_of, shapes_of

# Names that programs give when the user gave none.
GENERIC_NAME = re.compile(
    r"|Open CASCADE .*|Open_CASCADE.*|=>\[.*\]|NAUO\d*|"
    r"(compound|shell|open shell|face|surface|product|part|none|unnamed|no name)[ _.:#-]*\d*",
    re.IGNORECASE,
)


def new_document() -> TDocStd_Document:
    """An empty document for a reader to fill."""
    document = TDocStd_Document(TCollection_ExtendedString("cadpanel"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    return document


def parts_of(document: TDocStd_Document, *, as_panels: bool = False, labels: bool = True) -> tuple[Part, ...]:
    """The document's shapes, assemblies flattened, in file order.

    Args:
        document: as a reader has filled it.
        as_panels: whether parts are what may be a panel each: an assembly of the nameless faces of a sheet is one part,
            and a lone product of several sheets is as many.
        labels: whether to say of parts and faces what the document does; without, parts have but the names of their
            products and instances, and no labels of faces.
    """
    layers = XCAFDoc_DocumentTool.LayerTool_s(document.Main()) if labels else None
    take = _Take(name=label_name, layers=layers, as_panels=as_panels)
    found = _flattened(document, take)
    return tuple(_split(found[0]) if as_panels and len(found) == 1 else found)


def products_of(document: TDocStd_Document) -> list[tuple[str, TopoDS_Shape]]:
    """The document's shapes, assemblies flattened, in file order, each with its product's name letter for letter."""
    take = _Take(name=full_name, layers=None, as_panels=False)
    return [(part.product, part.shape) for part in _flattened(document, take)]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Take:
    """What is taken from a document.

    Attributes:
        name: the name that a label counts as having.
        layers: the document's, to look up what it says of parts and faces; None where only names matter.
        as_panels: whether the nameless faces of a sheet are one part.
    """

    name: Callable[[TDF_Label], str]
    layers: XCAFDoc_LayerTool | None
    as_panels: bool


def _each(labels: TDF_LabelSequence) -> list[TDF_Label]:
    return [labels.Value(index) for index in range(1, labels.Length() + 1)]


def _flattened(document: TDocStd_Document, take: _Take) -> list[Part]:
    roots = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(roots)
    return [part for root in _each(roots) for part in _flatten(root, TopLoc_Location(), Label(), take)]


def _flatten(use: TDF_Label, location: TopLoc_Location, above: Label, take: _Take) -> list[Part]:
    """The parts below one label; `above` is what is said of the assemblies that hold it."""
    product = TDF_Label()
    if XCAFDoc_ShapeTool.IsReference_s(use):
        location = location.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(use))
        XCAFDoc_ShapeTool.GetReferredShape_s(use, product)
    else:
        product = use
    said = Label() if take.layers is None else _said(use, product, take.layers).over(above)
    components = TDF_LabelSequence()
    if XCAFDoc_ShapeTool.IsAssembly_s(product):
        XCAFDoc_ShapeTool.GetComponents_s(product, components)
    whole = Part(label=said, shape=None, face_labels=(), product=take.name(product), instance=instance_name(use))
    if not components.Length():
        shape = XCAFDoc_ShapeTool.GetShape_s(product)
        labels = () if take.layers is None else _face_labels(product, shape, take.layers)
        return [replace(whole, shape=shape.Moved(location), face_labels=labels)]
    # A name of an assembly is not one of its parts', but its colour and layer hold for them.
    below = Label(layer=said.layer, color=said.color)
    parts = [part for component in _each(components) for part in _flatten(component, location, below, take)]
    if not (take.as_panels and is_sheet_in_pieces(product, components)):
        return parts
    labels = tuple(label.over(part.label) for part in parts for label in part.face_labels)
    return [replace(whole, shape=compound_of(part.shape for part in parts), face_labels=labels)]


def _said(use: TDF_Label, product: TDF_Label, layers: XCAFDoc_LayerTool) -> Label:
    """What is said of a product and of its use, which in an assembly may carry a colour and layer of its own."""
    own = _label(product, layers)
    if use.IsEqual(product):
        return own
    return Label(
        name=own.name or instance_name(use), layer=_layer(use, layers) or own.layer, color=_color(use) or own.color
    )


def _split(part: Part) -> list[Part]:
    """A lone product as the sheets that it holds."""
    labels = iter(part.face_labels)
    return [
        replace(part, shape=shape, face_labels=tuple(islice(labels, len(shapes_of(shape, TopAbs_FACE)))))
        for shape in split_groups(part.shape)
    ]


def _face_labels(product: TDF_Label, shape: TopoDS_Shape, layers: XCAFDoc_LayerTool) -> tuple[Label, ...]:
    """What the document says of each face of a product; what it says of a shell holds for the shell's faces."""
    below = TDF_LabelSequence()
    XCAFDoc_ShapeTool.GetSubShapes_s(product, below)
    said: ShapeMap[Label] = ShapeMap()
    for label in _each(below):
        sub_shape = XCAFDoc_ShapeTool.GetShape_s(label)
        for face in shapes_of(sub_shape, TopAbs_FACE):
            own = _label(label, layers)
            known = said.get(face, Label())
            said[face] = own.over(known) if sub_shape.IsSame(face) else known.over(own)
    return tuple(said.get(face, Label()) for face in shapes_of(shape, TopAbs_FACE))


def _label(label: TDF_Label, layers: XCAFDoc_LayerTool) -> Label:
    return Label(name=label_name(label), layer=_layer(label, layers), color=_color(label))


def _layer(label: TDF_Label, layers: XCAFDoc_LayerTool) -> str:
    found = layers.GetLayers(label)
    return str(found.Value(1).ToExtString()) if found is not None and found.Length() else ""


def _color(label: TDF_Label) -> str:
    color = Quantity_Color()
    for kind in (XCAFDoc_ColorSurf, XCAFDoc_ColorGen):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, color):
            red, green, blue = (round(255 * value) for value in color.Values(Quantity_TOC_sRGB))
            return f"#{red:02x}{green:02x}{blue:02x}"
    return ""


def label_name(label: TDF_Label) -> str:
    """A product's name, empty where it is missing or made up by the writing program."""
    name = full_name(label).strip()
    return "" if GENERIC_NAME.fullmatch(name) else name


def full_name(label: TDF_Label) -> str:
    """A label's name as it stands there, empty where it has none."""
    # Asked for first: looking for an attribute that is not there may crash the kernel's binding.
    attribute = TDataStd_Name()
    if not (label.IsAttribute(TDataStd_Name.GetID_s()) and label.FindAttribute(TDataStd_Name.GetID_s(), attribute)):
        return ""
    return str(attribute.Get().ToExtString())


def instance_name(use: TDF_Label) -> str:
    """The name of a use of a product; a mere number is what programs call it when the user does not."""
    name = label_name(use)
    return "" if name.isdecimal() else name


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
