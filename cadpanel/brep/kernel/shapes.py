"""Walks over the parts of a kernel shape, compounds, and shapes as bytes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from io import BytesIO

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Edge, TopoDS_Face, TopoDS_Iterator, TopoDS_Shape


def shapes_of(
    shape: TopoDS_Shape, kind: TopAbs_ShapeEnum, outside: TopAbs_ShapeEnum | None = None
) -> list[TopoDS_Shape]:
    """The sub-shapes of one kind, in the explorer's order; those inside shapes of the kind `outside` are left out."""
    explorer = TopExp_Explorer(shape, kind) if outside is None else TopExp_Explorer(shape, kind, outside)
    found = []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def faces_of(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    """The faces, in the explorer's order."""
    return [TopoDS.Face_s(face) for face in shapes_of(shape, TopAbs_FACE)]


def edges_of(shape: TopoDS_Shape) -> list[TopoDS_Edge]:
    """The edges, in the explorer's order, each once for every face that it bounds; a seam twice."""
    return [TopoDS.Edge_s(edge) for edge in shapes_of(shape, TopAbs_EDGE)]


def loose_edges(shape: TopoDS_Shape) -> list[TopoDS_Shape]:
    """The edges that bound no face."""
    return shapes_of(shape, TopAbs_EDGE, TopAbs_FACE)


def children(shape: TopoDS_Shape, *, oriented: bool = True) -> Iterator[TopoDS_Shape]:
    """The direct sub-shapes, placed; turned round with the shape, or as they are stored in it."""
    iterator = TopoDS_Iterator(shape, oriented, True)
    while iterator.More():
        yield iterator.Value()
        iterator.Next()


def compound_of(shapes: Iterable[TopoDS_Shape]) -> TopoDS_Compound:
    """A compound of shapes, in their order."""
    builder, compound = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def packed(shape: TopoDS_Shape) -> bytes:
    """A shape in the kernel's binary form, which keeps every digit."""
    stream = BytesIO()
    BinTools.Write_s(shape, stream)
    return stream.getvalue()


def unpacked(data: bytes) -> TopoDS_Shape:
    """The shape again."""
    shape = TopoDS_Shape()
    BinTools.Read_s(shape, BytesIO(data))
    return shape
