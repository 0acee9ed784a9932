"""What a STEP file says of its products besides their shapes, as the kernel's reader hands it on."""

from __future__ import annotations

from collections.abc import Iterable

from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_NamedData
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_Area, XCAFDoc_Centroid, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool, XCAFDoc_Volume

from cadpanel.brep.files.xcaf import full_name
from cadpanel.brep.step.properties import Stated


def stated_of(document: TDocStd_Document, attributes: Iterable[str]) -> dict[str, Stated]:
    """What is said of every product that has a shape of its own, by its name.

    Args:
        document: as the reader has filled it, told to read properties.
        attributes: names of those to look for: the kernel's binding lists none.
    """
    labels, wanted = TDF_LabelSequence(), tuple(attributes)
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetShapes(labels)
    products = [labels.Value(index) for index in range(1, labels.Length() + 1)]
    return {
        full_name(product): _stated(product, wanted)
        for product in products
        if XCAFDoc_ShapeTool.IsSimpleShape_s(product) and not XCAFDoc_ShapeTool.IsSubShape_s(product)
    }


def _stated(product: TDF_Label, wanted: Iterable[str]) -> Stated:
    area, volume, centroid, data = XCAFDoc_Area(), XCAFDoc_Volume(), XCAFDoc_Centroid(), TDataStd_NamedData()
    return Stated(
        area=area.Get() if _found(product, area) else None,
        volume=volume.Get() if _found(product, volume) else None,
        centroid=centroid.Get().Coord() if _found(product, centroid) else None,
        attributes=_values(data, wanted) if _found(product, data) else {},
    )


def _found(
    product: TDF_Label, attribute: XCAFDoc_Area | XCAFDoc_Volume | XCAFDoc_Centroid | TDataStd_NamedData
) -> bool:
    # Asked for first: looking for an attribute that is not there may crash the kernel's binding.
    known = attribute.GetID_s()
    return bool(product.IsAttribute(known) and product.FindAttribute(known, attribute))


def _values(data: TDataStd_NamedData, wanted: Iterable[str]) -> dict[str, str | float]:
    found: dict[str, str | float] = {}
    for name in wanted:
        key = TCollection_ExtendedString(name)
        if data.HasReal(key):
            found[name] = data.GetReal(key)
        elif data.HasString(key):
            found[name] = str(data.GetString(key).ToExtString())
    return found
