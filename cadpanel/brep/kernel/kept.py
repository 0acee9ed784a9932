"""Shapes in the binary form in which FreeCAD keeps them in its documents: the kernel's tables, then which one is meant.

Of the kernel's versions of these tables the third is what FreeCAD itself writes. In its documents shapes of the other
versions come out empty, without a word: the first two are read by going back, which its archives cannot.
"""

from __future__ import annotations

import struct
from io import BytesIO

from OCP.BinTools import BinTools_ShapeSet
from OCP.Message import Message_ProgressRange
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_EXTERNAL, TopAbs_FORWARD, TopAbs_INTERNAL, TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

_VERSION = 3
_HEAD = b"\nOpen CASCADE Topology V3"
# Place of the shape in its table, of where it is placed in the table of places, and its orientation.
_MEANT = struct.Struct("<3i")
_ORIENTATIONS = (TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_INTERNAL, TopAbs_EXTERNAL)


def kept_binary(shape: TopoDS_Shape, *, triangles: bool = False) -> bytes:
    """A shape with every digit, and with the triangles that it has if they are wanted."""
    tables, stream = BinTools_ShapeSet(), BytesIO()
    tables.SetWithTriangles(triangles)
    tables.SetFormatNb(_VERSION)
    place = tables.Add(shape)
    placed = tables.Locations().Index(shape.Location())
    tables.Write(stream, Message_ProgressRange())
    return stream.getvalue() + _MEANT.pack(place, placed, _ORIENTATIONS.index(shape.Orientation()))


def kept_shape(data: bytes) -> TopoDS_Shape:
    """The shape again; a null one where the data are none."""
    if not data.startswith(_HEAD) or len(data) < len(_HEAD) + _MEANT.size:
        return TopoDS_Shape()
    tables = BinTools_ShapeSet()
    place, placed, way = _MEANT.unpack(data[-_MEANT.size :])
    try:
        tables.Read(BytesIO(data[: -_MEANT.size]), Message_ProgressRange())
        if not (0 < place <= tables.NbShapes() and 0 <= way < len(_ORIENTATIONS)):
            return TopoDS_Shape()
        shape = tables.Shape(place).Oriented(_ORIENTATIONS[way])
        return shape.Located(tables.Locations().Location(placed) if placed else TopLoc_Location())
    except (Standard_Failure, RuntimeError):
        return TopoDS_Shape()
