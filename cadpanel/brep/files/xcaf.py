"""From a document of the kernel (what its STEP and IGES readers fill) to parts with names, colours and layers."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
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
from cadpanel.brep.files.step_products import instance_name, is_sheet_in_pieces, label_name, split_groups
from cadpanel.brep.kernel.shape_maps import ShapeMap
from cadpanel.brep.kernel.shapes import compound_of, shapes_of


def new_document() -> TDocStd_Document:
    """An empty document for a reader to fill."""
    document = TDocStd_Document(TCollection_ExtendedString("cadpanel"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    return document


def parts_of(document: TDocStd_Document, *, as_panels: bool = False) -> tuple[Part, ...]:
    """The document's shapes, assemblies flattened, in file order.

    Args:
        document: as a reader has filled it.
        as_panels: whether parts are what `read_products` takes for one panel each: an assembly of the nameless faces of
            a sheet is one part, and a lone product of several sheets is as many.
    """
    roots = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(roots)
    layers = XCAFDoc_DocumentTool.LayerTool_s(document.Main())
    found = [part for root in _each(roots) for part in _flatten(root, TopLoc_Location(), Label(), layers, as_panels)]
    return tuple(_split(found[0]) if as_panels and len(found) == 1 else found)


def _each(labels: TDF_LabelSequence) -> list[TDF_Label]:
    return [labels.Value(index) for index in range(1, labels.Length() + 1)]


def _flatten(
    use: TDF_Label, location: TopLoc_Location, above: Label, layers: XCAFDoc_LayerTool, as_panels: bool
) -> list[Part]:
    """The parts below one label; a use of a product in an assembly may carry a colour and layer of its own."""
    product = TDF_Label()
    if XCAFDoc_ShapeTool.IsReference_s(use):
        location = location.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(use))
        XCAFDoc_ShapeTool.GetReferredShape_s(use, product)
        own = _label(product, layers)
        said = Label(
            name=own.name or instance_name(use), layer=_layer(use, layers) or own.layer, color=_color(use) or own.color
        ).over(above)
    else:
        product = use
        said = _label(product, layers).over(above)
    components = TDF_LabelSequence()
    if XCAFDoc_ShapeTool.IsAssembly_s(product):
        XCAFDoc_ShapeTool.GetComponents_s(product, components)
    whole = Part(label=said, shape=None, face_labels=(), product=label_name(product), instance=instance_name(use))
    if not components.Length():
        shape = XCAFDoc_ShapeTool.GetShape_s(product)
        return [replace(whole, shape=shape.Moved(location), face_labels=_face_labels(product, shape, layers))]
    # A name of an assembly is not one of its parts', but its colour and layer hold for them.
    below = Label(layer=said.layer, color=said.color)
    parts = [
        part for component in _each(components) for part in _flatten(component, location, below, layers, as_panels)
    ]
    if not (as_panels and is_sheet_in_pieces(product, components)):
        return parts
    labels = tuple(label.over(part.label) for part in parts for label in part.face_labels)
    return [replace(whole, shape=compound_of(part.shape for part in parts), face_labels=labels)]


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
