"""Products, assembly, colours and header around the topology: one product a panel, all placed where they are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import IO

from OCP.TopAbs import TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.step.properties import PartData, PropertyWriter
from cadpanel.brep.step.schemas import SCHEMAS, UNCERTAINTY, Schema
from cadpanel.brep.step.text import StepText, real, references, string
from cadpanel.brep.step.topology import TopologyWriter


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """Who wrote a file, and when.

    Attributes:
        date: the time that the file states; the same panels at the same time give the same bytes.
        author, organization: empty where nobody is named.
        note: what readers should know, one line; empty where there is nothing.
    """

    date: datetime = datetime(1970, 1, 1, tzinfo=UTC)
    author: str = ""
    organization: str = ""
    note: str = ""


Place = tuple[float, float, float]
"""Where the origin of a part's coordinates lies in the assembly, mm."""
_ORIGIN: Place = (0.0, 0.0, 0.0)
NamedShape = tuple[str, TopoDS_Shape, tuple[float, float, float] | None]
"""A name, a shape and its colour, sRGB with components in 0 to 1."""


def write_step_text(
    file: IO[str],
    shapes: Iterable[NamedShape],
    title: str,
    schema: Schema,
    placed: Place = _ORIGIN,
    data: Iterable[PartData] | None = None,
    header: Header | None = None,
) -> None:
    """Write the whole file, shape by shape, the origin of their coordinates placed somewhere in the assembly, mm.

    Args:
        file: that is written from its beginning.
        shapes: names, shapes and colours; each is asked for once all before it are written, and let go of.
        title: name of the assembly.
        schema: "AP242" or "AP214".
        placed: where their origin lies in the assembly.
        data: what is said of each shape; None to say nothing but their names.
        header: who wrote it, and when.

    Raises:
        UnsupportedGeometry: if a shape is not made of exact panels' geometry.
    """
    text = begin_step_text(file, title, schema, header)
    frame = StepFrame(text, schema)
    assembly = frame.assembly(title, [placed])
    styled = []
    for number, ((name, shape, color), part_data) in enumerate(_told(shapes, data), start=1):
        item = TopologyWriter(text).item(shape)
        solid = shape.ShapeType() == TopAbs_SOLID
        kind = "ADVANCED_BREP_SHAPE_REPRESENTATION" if solid else "MANIFOLD_SURFACE_SHAPE_REPRESENTATION"
        part = frame.product(name, part_data, kind, [item])
        frame.place(part, assembly, number, name, placed)
        if color is not None:
            styled.append(text.add(f"STYLED_ITEM('color',(#{frame.style(color)}),#{item})"))
    if styled:
        text.add(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{references(styled)},#{frame.context})")
    end_step_text(file)


def begin_step_text(file: IO[str], title: str, schema: Schema, header: Header | None) -> StepText:
    """Write a file's header, and open its data section."""
    file.write(_header(title, SCHEMAS[schema].name, header or Header()))
    return StepText(file)


def end_step_text(file: IO[str]) -> None:
    """Close the data section and the file."""
    file.write("ENDSEC;\nEND-ISO-10303-21;\n")


def _told(shapes: Iterable[NamedShape], data: Iterable[PartData] | None) -> Iterator[tuple[NamedShape, PartData]]:
    """Each shape and what is said of it."""
    if data is not None:
        yield from zip(shapes, data, strict=True)
        return
    for shape in shapes:
        yield shape, PartData(number=shape[0])


def _header(title: str, schema_name: str, header: Header) -> str:
    date = header.date.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%S+00:00")
    who = f"({string(header.author)}),({string(header.organization)})"
    described = ",".join(string(text) for text in ("Exact developable panels", header.note) if text)
    return (
        f"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(({described}),'2;1');\n"
        f"FILE_NAME({string(title)},'{date}',{who},'cadpanel','cadpanel','');\n"
        f"FILE_SCHEMA(('{schema_name}'));\nENDSEC;\nDATA;\n"
    )


@dataclass(frozen=True, slots=True)
class Product:
    """The numbers of a product's definition and of its shape's representation."""

    definition: int
    representation: int


@dataclass(frozen=True, slots=True)
class Assembly:
    """The product that all others hang in, and the axes at each place that they may have in it."""

    product: Product
    axes: Mapping[Place, int]


class StepFrame:
    """What all products of a file share: contexts, units, origin, colours.

    Parts have one context and the assembly has another, and the axes by which a part is placed stand among the items
    of both representations, each its own: so the schema wants it (representation_relationship_with_transformation).
    """

    def __init__(self, text: StepText, schema: Schema) -> None:
        """Write what all products share.

        Args:
            text: where to write.
            schema: "AP242" or "AP214".
        """
        self._text = text
        _, protocol, application = SCHEMAS[schema]
        self._styles: dict[tuple[float, float, float], int] = {}
        add = text.add
        self._application = add(f"APPLICATION_CONTEXT('{application}')")
        add(f"APPLICATION_PROTOCOL_DEFINITION('international standard','{protocol},#{self._application})")
        self._product_context = add(f"PRODUCT_CONTEXT('',#{self._application},'mechanical')")
        self._definition_context = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',#{self._application},'design')")
        length = add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
        angle = add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        solid_angle = add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        uncertainty = add(
            f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({real(UNCERTAINTY)}),#{length},"
            "'distance_accuracy_value','confusion accuracy')"
        )
        self.context, self._context_of_assembly = (
            add(
                f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{uncertainty}))"
                f"GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{solid_angle}))REPRESENTATION_CONTEXT('{of}',''))"
            )
            for of in ("parts", "assembly")
        )
        self._properties = PropertyWriter(text, self.context, length)
        self._origin = self._placement(_ORIGIN)

    def _placement(self, place: Place) -> int:
        point = self._text.add(f"CARTESIAN_POINT('',({','.join(map(real, place))}))")
        z_axis = self._text.add("DIRECTION('',(0.,0.,1.))")
        x_axis = self._text.add("DIRECTION('',(1.,0.,0.))")
        return self._text.add(f"AXIS2_PLACEMENT_3D('',#{point},#{z_axis},#{x_axis})")

    def assembly(self, title: str, places: Iterable[Place]) -> Assembly:
        """A new product that parts may hang in at some places; it has axes at its origin, too."""
        axes = {place: self._placement(place) for place in dict.fromkeys([_ORIGIN, *places])}
        number = PartData(number=title)
        items, context = list(axes.values()), self._context_of_assembly
        return Assembly(self._product(title, number, "SHAPE_REPRESENTATION", items, context), axes)

    def product(
        self, name: str, data: PartData, kind: str, items: Sequence[int], documents: Sequence[int] = ()
    ) -> Product:
        """A new part with its origin and other items; it may stand in documents."""
        return self._product(name, data, kind, [self._origin, *items], self.context, documents)

    def _product(
        self, name: str, data: PartData, kind: str, items: Sequence[int], context: int, documents: Sequence[int] = ()
    ) -> Product:
        add, said = self._text.add, ",".join(string(text) for text in (data.number, name, data.description))
        product = add(f"PRODUCT({said},(#{self._product_context}))")
        add(f"PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#{product}))")
        formation = add(f"PRODUCT_DEFINITION_FORMATION('','',#{product})")
        told = f"'design','',#{formation},#{self._definition_context}"
        definition = add(
            f"PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS({told},{references(documents)})"
            if documents
            else f"PRODUCT_DEFINITION({told})"
        )
        shape = add(f"PRODUCT_DEFINITION_SHAPE('','',#{definition})")
        representation = add(f"{kind}('',{references(items)},#{context})")
        add(f"SHAPE_DEFINITION_REPRESENTATION(#{shape},#{representation})")
        self._properties.write(data, definition, shape)
        return Product(definition, representation)

    def place(self, part: Product, assembly: Assembly, number: int, name: str, place: Place) -> None:
        """Put a part into the assembly, its origin at one of the places that the assembly has axes at."""
        add, whole = self._text.add, assembly.product
        usage = add(
            f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{number}',{string(name)},'',#{whole.definition},#{part.definition},$)"
        )
        placed = add(f"PRODUCT_DEFINITION_SHAPE('Placement','Placement of an item',#{usage})")
        moved = add(f"ITEM_DEFINED_TRANSFORMATION('','',#{self._origin},#{assembly.axes[place]})")
        relation = add(
            f"(REPRESENTATION_RELATIONSHIP('','',#{part.representation},#{whole.representation})"
            f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{moved})SHAPE_REPRESENTATION_RELATIONSHIP())"
        )
        add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{placed})")

    def style(self, color: tuple[float, float, float]) -> int:
        """One style a colour, shared by all that wear it."""
        if color not in self._styles:
            add = self._text.add
            rgb = add(f"COLOUR_RGB('',{','.join(map(real, color))})")
            fill = add(f"FILL_AREA_STYLE_COLOUR('',#{rgb})")
            area = add(f"FILL_AREA_STYLE('',(#{fill}))")
            side = add(f"SURFACE_SIDE_STYLE('',(#{add(f'SURFACE_STYLE_FILL_AREA(#{area})')}))")
            usage = add(f"SURFACE_STYLE_USAGE(.BOTH.,#{side})")
            self._styles[color] = add(f"PRESENTATION_STYLE_ASSIGNMENT((#{usage}))")
        return self._styles[color]
