"""What a file holds, whatever its format: named, coloured, layered parts of faces and loose curves, in millimetres."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from io import BytesIO

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_ShapeEnum, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Edge, TopoDS_Face, TopoDS_Iterator, TopoDS_Shape

from cadpanel.brep.names import call_panels
from cadpanel.brep.shape_maps import ShapeSet


@dataclass(frozen=True, slots=True, kw_only=True)
class Label:
    """What a file says of a shape; each is empty where it says nothing.

    Attributes:
        name: as the user gave it.
        layer: the layer it lies on.
        color: "#rrggbb", sRGB.
    """

    name: str = ""
    layer: str = ""
    color: str = ""

    def over(self, below: Label) -> Label:
        """Fill what this label leaves out from that of the shape which holds this one."""
        return Label(name=self.name or below.name, layer=self.layer or below.layer, color=self.color or below.color)


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One top-level shape of a file: a product, an entity, an object.

    Attributes:
        label: what the file says of it.
        shape: solid, shell, face, compound, wire or edge, placed, mm.
        face_labels: what the file says of each of its faces, in the explorer's order.
        product: the name of the product that it is, in formats with products.
        instance: the name of this use of the product in its assembly.
    """

    label: Label
    shape: TopoDS_Shape
    face_labels: tuple[Label, ...]
    product: str = ""
    instance: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """All that it is called in the file."""
        return tuple(name for name in dict.fromkeys((self.label.name, self.product, self.instance)) if name)


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelFace:
    """One face of a model.

    Attributes:
        number: its place in the file, from 1.
        part: index of its part.
        label: its own, filled up from its part's.
        face: the kernel's face.
        of_solid: whether it bounds a solid.
        names: all that it, and its part, is called in the file.
        panel: what its part is called as a ready-made panel.
    """

    number: int
    part: int
    label: Label
    face: TopoDS_Face
    of_solid: bool
    names: tuple[str, ...]
    panel: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelCurve:
    """One loose curve of a model: an edge that bounds no face, with its part's label."""

    label: Label
    edge: TopoDS_Edge


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """What a file holds.

    Attributes:
        source: the file's name.
        format: what kind of file it is.
        unit: the unit of length in which it was read, as a word.
        own_unit: whether the file itself says so.
        parts: in file order, mm.
        notes: what was done to it or should be known of it, one sentence each.
        origin: what was taken off all coordinates of the file, mm.
    """

    source: str
    format: str
    unit: str
    own_unit: bool = True
    parts: tuple[Part, ...]
    notes: tuple[str, ...] = ()
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def faces(self) -> tuple[ModelFace, ...]:
        """All faces in file order."""
        found: list[ModelFace] = []
        for index, (part, panel) in enumerate(zip(self.parts, self.panel_names(), strict=True)):
            solids = [shape for solid in shapes_of(part.shape, TopAbs_SOLID) for shape in shapes_of(solid, TopAbs_FACE)]
            bounding = ShapeSet(solids)
            for face, label in zip(shapes_of(part.shape, TopAbs_FACE), part.face_labels, strict=True):
                found.append(
                    ModelFace(
                        number=len(found) + 1,
                        part=index,
                        label=label.over(part.label),
                        face=TopoDS.Face_s(face),
                        of_solid=face in bounding,
                        names=(label.name, *part.names) if label.name else part.names,
                        panel=panel,
                    )
                )
        return tuple(found)

    def panel_names(self) -> tuple[str, ...]:
        """What each part is called as a ready-made panel, all different; empty for a part without faces."""
        bearing = [index for index, part in enumerate(self.parts) if part.face_labels]
        said = [(part.product or part.label.name, part.instance) for part in map(self.parts.__getitem__, bearing)]
        names = dict(zip(bearing, call_panels(said), strict=True))
        return tuple(names.get(index, "") for index in range(len(self.parts)))

    def curves(self) -> tuple[ModelCurve, ...]:
        """All loose curves in file order."""
        return tuple(
            ModelCurve(label=part.label, edge=TopoDS.Edge_s(edge))
            for part in self.parts
            for edge in loose_edges(part.shape)
        )

    def with_notes(self, notes: Iterable[str]) -> Model:
        """The model with further notes."""
        return replace(self, notes=(*self.notes, *notes))


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


def loose_edges(shape: TopoDS_Shape) -> list[TopoDS_Shape]:
    """The edges that bound no face."""
    return shapes_of(shape, TopAbs_EDGE, TopAbs_FACE)


def children(shape: TopoDS_Shape) -> Iterator[TopoDS_Shape]:
    """The direct sub-shapes, placed."""
    iterator = TopoDS_Iterator(shape)
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
