"""A document's two XML files: Document.xml, what there is, and GuiDocument.xml, how it is shown."""

from __future__ import annotations

import re
import uuid
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import singledispatch
from xml.sax.saxutils import quoteattr

from cadpanel.delivery.document.objects import (
    AnyProperty,
    Body,
    Choice,
    Color,
    DocumentObject,
    Lines,
    Look,
    Number,
    Place,
    Property,
    Sheet,
    Words,
    Yes,
)
from cadpanel.delivery.schedule.csv_text import Row
from cadpanel.geometry.triangles import SHOWN_DEVIATION

HEAD = "<?xml version='1.0' encoding='utf-8'?>\n"
# Marks of a property that FreeCAD's own objects have: how their status is kept.
_LABEL_STATUS, _SHOWN_STATUS = 134217728, 648
# What no XML file can hold.
_NOT_IN_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")
# FreeCAD's own share of the light that comes from everywhere.
_AMBIENT = (1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0)
_GROUP = "App::DocumentObjectGroup"


def quoted(text: str) -> str:
    """A text as the value of an attribute, with its quotes; what XML cannot hold becomes "_"."""
    escapes = {"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}
    return quoteattr(_NOT_IN_XML.sub("_", text), escapes)


def document_xml(title: str, objects: Sequence[DocumentObject]) -> bytes:
    """Document.xml: all objects, which depends on which, and their properties."""
    inside: dict[str, list[str]] = {one.name: [] for one in objects}
    for one in objects:
        if one.parent is not None:
            inside[one.parent].append(one.name)
    own = uuid.uuid5(uuid.NAMESPACE_URL, f"cadpanel/{title}")
    lines = [
        f'{HEAD}<Document SchemaVersion="4" ProgramVersion="0.20R" FileVersion="1">',
        '<Properties Count="2" TransientCount="0">',
        f'<Property name="Label" type="App::PropertyString" status="1"><String value={quoted(title)}/></Property>',
        f'<Property name="Uid" type="App::PropertyUUID" status="16777217"><Uuid value="{own}"/></Property>',
        "</Properties>",
        f'<Objects Count="{len(objects)}" Dependencies="1">',
        *(_depends(name, children) for name, children in inside.items()),
        *(f'<Object type="{_type(one)}" name="{one.name}" id="{i}"/>' for i, one in enumerate(objects, start=1)),
        f'</Objects>\n<ObjectData Count="{len(objects)}">',
        *(_data(one, inside[one.name]) for one in objects),
        "</ObjectData>\n</Document>\n",
    ]
    return "\n".join(lines).encode()


def gui_xml(objects: Sequence[DocumentObject], camera: str) -> bytes:
    """GuiDocument.xml: colours, what is hidden, and where the camera stands.

    Args:
        objects: those of the document.
        camera: as Open Inventor writes it.
    """
    lines = [f'{HEAD}<Document SchemaVersion="1">\n<ViewProviderData Count="{len(objects)}">']
    for one in objects:
        shown = list(_look(one.look))
        opened = 0 if isinstance(one, Body | Sheet) or not one.look.visible else 1
        lines.append(
            f'<ViewProvider name="{one.name}" expanded="{opened}"><Properties Count="{len(shown)}" TransientCount="0">'
            f"{''.join(shown)}</Properties></ViewProvider>"
        )
    lines.append(f"</ViewProviderData>\n<Camera settings={quoted(camera)}/>\n</Document>\n")
    return "\n".join(lines).encode()


def _type(one: DocumentObject) -> str:
    return "Part::Feature" if isinstance(one, Body) else "Spreadsheet::Sheet" if isinstance(one, Sheet) else _GROUP


def _depends(name: str, children: Sequence[str]) -> str:
    inside = "".join(f'<Dep Name="{child}"/>' for child in children)
    return f'<ObjectDeps Name="{name}" Count="{len(children)}">{inside}</ObjectDeps>'


def _data(one: DocumentObject, children: Sequence[str]) -> str:
    visible = "true" if one.look.visible else "false"
    found = [
        f'<Property name="Label" type="App::PropertyString" status="{_LABEL_STATUS}">'
        f"<String value={quoted(one.label)}/></Property>",
        f'<Property name="Visibility" type="App::PropertyBool" status="{_SHOWN_STATUS}">'
        f'<Bool value="{visible}"/></Property>',
    ]
    head = f'<Object name="{one.name}">'
    if isinstance(one, Body):
        # With an element map, though an empty one, FreeCAD 1.0 sees nothing to recompute when it opens the file.
        found.append(
            '<Property name="Shape" type="Part::PropertyPartShape">'
            f'<Part ElementMap="0.4" file="{one.file}"/><ElementMap/></Property>'
        )
    elif isinstance(one, Sheet):
        found.append(_cells(one))
    else:
        head = (
            f'<Object name="{one.name}" Extensions="True"><Extensions Count="1">'
            '<Extension type="App::GroupExtension" name="GroupExtension"></Extension></Extensions>'
        )
        links = "".join(f'<Link value="{child}"/>' for child in children)
        found.append(
            '<Property name="Group" type="App::PropertyLinkList">'
            f'<LinkList count="{len(children)}">{links}</LinkList></Property>'
        )
    found += [_property(one) for one in one.properties]
    return (
        f'{head}<Properties Count="{len(found)}" TransientCount="0">\n' + "\n".join(found) + "\n</Properties></Object>"
    )


def _property(one: AnyProperty) -> str:
    kind, value = _value(one)
    fixed = 0 if isinstance(one, Choice) else 1
    return (
        f'<Property name="{one.name}" type="App::Property{kind}" group={quoted(one.group)} doc={quoted(one.tip)} '
        f'attr="0" ro="{fixed}" hide="0">{value}</Property>'
    )


@singledispatch
def _value(one: Property) -> tuple[str, str]:
    """The type's name without its prefix, and the element that holds the value; one entry for each kind of property."""
    raise TypeError(f"nobody has said how a property like {one!r} is written")


@_value.register
def _(one: Number) -> tuple[str, str]:
    return one.kind, f'<Float value="{one.value!r}"/>'


@_value.register
def _(one: Words) -> tuple[str, str]:
    return "String", f"<String value={quoted(one.value)}/>"


@_value.register
def _(one: Lines) -> tuple[str, str]:
    texts = "".join(f"<String value={quoted(text)}/>" for text in one.value)
    return "StringList", f'<StringList count="{len(one.value)}">{texts}</StringList>'


@_value.register
def _(one: Yes) -> tuple[str, str]:
    return "Bool", f'<Bool value="{str(one.value).lower()}"/>'


@_value.register
def _(one: Place) -> tuple[str, str]:
    x, y, z = one.value
    return "Vector", f'<PropertyVector valueX="{x!r}" valueY="{y!r}" valueZ="{z!r}"/>'


@_value.register
def _(one: Choice) -> tuple[str, str]:
    place = list(one.options).index(one.value)
    options = "".join(f"<Enum value={quoted(option)}/>" for option in one.options)
    return (
        "Enumeration",
        f'<Integer value="{place}" CustomEnum="true"/>'
        f'<CustomEnumList count="{len(one.options)}">{options}</CustomEnumList>',
    )


def _cells(sheet: Sheet) -> str:
    cells = list(_written_cells(sheet.cells))
    return (
        '<Property name="cells" type="Spreadsheet::PropertySheet" status="67108864">'
        f'<Cells Count="{len(cells)}" xlink="1"><XLinks count="0"></XLinks>\n'
        + "\n".join(cells)
        + "\n</Cells></Property>"
    )


def _written_cells(rows: Iterable[Row]) -> Iterator[str]:
    for number, row in enumerate(rows, start=1):
        style = ' style="bold"' if number == 1 else ""
        for column, value in enumerate(row):
            if value is None or value == "":
                continue
            # A text begins with an apostrophe, else "=A1" would be a formula and "1-2" a number.
            content = quoted(f"'{value}") if isinstance(value, str) else f'"{value!r}"'
            yield f'<Cell address="{_column(column)}{number}" content={content}{style}/>'


def _column(place: int) -> str:
    """A, B, ..., Z, AA, AB, ..."""
    letters = ""
    place += 1
    while place:
        place, rest = divmod(place - 1, 26)
        letters = chr(ord("A") + rest) + letters
    return letters


def _look(look: Look) -> Iterator[str]:
    if look.faces is not None:
        # Before it is shown, which is when FreeCAD meshes it: half of the time in which a document opens.
        yield _seen("Deviation", "FloatConstraint", f'<Float value="{SHOWN_DEVIATION!r}"/>')
    yield _seen("Visibility", "Bool", f'<Bool value="{str(look.visible).lower()}"/>')
    colors: Mapping[str, Color | None] = {"ShapeColor": look.faces, "LineColor": look.lines, "PointColor": look.lines}
    for name, color in colors.items():
        if color is not None:
            yield _seen(name, "Color", f'<PropertyColor value="{_packed(color)}"/>')
    if look.faces is not None:
        # Without gloss: under FreeCAD 1.0's lamps a flat panel that shines is all white, whatever its colour.
        dull = f'ambientColor="{_packed(_AMBIENT)}" specularColor="0" emissiveColor="0" shininess="0" transparency="0"'
        yield _seen("ShapeMaterial", "Material", f'<PropertyMaterial diffuseColor="{_packed(look.faces)}" {dull}/>')
    if look.line_width is not None:
        yield _seen("LineWidth", "FloatConstraint", f'<Float value="{look.line_width!r}"/>')


def _seen(name: str, kind: str, value: str) -> str:
    return f'<Property name="{name}" type="App::Property{kind}" status="1">{value}</Property>'


def _packed(color: Color) -> int:
    """Red, green and blue in the upper three bytes; the last one is transparency."""
    red, green, blue = (round(255.0 * part) for part in color)
    return red << 24 | green << 16 | blue << 8
