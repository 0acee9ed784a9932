"""What a file holds, whatever its format: named, coloured, layered parts of faces and loose curves, in millimetres."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape

from cadpanel.brep.files.names import call_panels
from cadpanel.brep.kernel.shape_maps import ShapeSet
from cadpanel.brep.kernel.shapes import loose_edges, shapes_of


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
        unreadable: for each of its faces that is not in the shape, as it could not be read, the place among all its
            faces, from 0, and why.
        product: the name of the product that it is, in formats with products.
        instance: the name of this use of the product in its assembly.
    """

    label: Label
    shape: TopoDS_Shape
    face_labels: tuple[Label, ...]
    unreadable: Mapping[int, str] = field(default_factory=dict)
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
class UnreadableFace:
    """One face of a file that a model leaves out: its place in the file, what the file says of it, and what is wrong.

    Attributes:
        number: its place in the file, from 1.
        label: its part's.
        names: all that its part is called in the file.
        panel: what its part is called as a ready-made panel.
        why: a clause that begins with "it".
    """

    number: int
    label: Label
    names: tuple[str, ...]
    panel: str
    why: str


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
        """All faces in file order; they keep their numbers where others are unreadable."""
        found: list[ModelFace] = []
        for index, (part, panel, numbers) in enumerate(self._numbered()):
            solids = [shape for solid in shapes_of(part.shape, TopAbs_SOLID) for shape in shapes_of(solid, TopAbs_FACE)]
            bounding = ShapeSet(solids)
            own = [number for place, number in enumerate(numbers) if place not in part.unreadable]
            for number, face, label in zip(own, shapes_of(part.shape, TopAbs_FACE), part.face_labels, strict=True):
                found.append(
                    ModelFace(
                        number=number,
                        part=index,
                        label=label.over(part.label),
                        face=TopoDS.Face_s(face),
                        of_solid=face in bounding,
                        names=(label.name, *part.names) if label.name else part.names,
                        panel=panel,
                    )
                )
        return tuple(found)

    def unreadable(self) -> tuple[UnreadableFace, ...]:
        """The faces of the file that are left out, in file order."""
        return tuple(
            UnreadableFace(number=numbers[place], label=part.label, names=part.names, panel=panel, why=why)
            for part, panel, numbers in self._numbered()
            for place, why in sorted(part.unreadable.items())
        )

    def _numbered(self) -> list[tuple[Part, str, range]]:
        """Each part with its panel's name and the numbers of all its faces."""
        found, start = [], 1
        for part, panel in zip(self.parts, self.panel_names(), strict=True):
            stop = start + len(part.face_labels) + len(part.unreadable)
            found.append((part, panel, range(start, stop)))
            start = stop
        return found

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


@dataclass(frozen=True, slots=True)
class NamedShape:
    """A shape placed in the file's coordinates (mm), under a name of its own."""

    name: str
    shape: TopoDS_Shape


@dataclass(frozen=True, slots=True, kw_only=True)
class Products:
    """The panels of a file.

    Attributes:
        source: the file's name.
        shapes: placed, in file order, mm.
        unit: the file's unit of length in its own words; None where it says none.
        notes: what was done to it or should be known of it, one sentence each.
        origin: what was taken off all coordinates of the file, mm.
    """

    source: str
    shapes: tuple[NamedShape, ...]
    unit: str | None
    notes: tuple[str, ...] = ()
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
