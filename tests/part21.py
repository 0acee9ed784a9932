"""Part 21 files as plain values, and what ISO 10303 says that the instances in ours must look like.

The table tells of each entity type the kinds of its attributes in their order, as the resources (parts 41 to 46) and
AP242 and AP214 define them: where an attribute's type is abstract, its subtypes that we write stand in its place.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

TOKEN = re.compile(
    r"\s*(?:(?P<string>'(?:[^']|'')*')|(?P<reference>#\d+)|(?P<enumeration>\.[A-Z_0-9]+\.)"
    r"|(?P<real>[-+]?\d+\.\d*(?:E[-+]?\d+)?)|(?P<integer>[-+]?\d+)|(?P<word>[A-Z][A-Z_0-9]*)|(?P<sign>[=(),;$*]))"
)


@dataclass(frozen=True)
class Value:
    """An attribute: "string", "reference", "enumeration", "real", "integer", "$", "*", "list" or a measure's type."""

    kind: str
    content: object = None


Parts = dict[str, list[Value]]
"""An instance: its types, one, or of a complex one several in their order, and the attributes of each."""


def read_instances(path: Path) -> dict[str, Parts]:
    """The instances of a file by their names, such as #1.

    Raises:
        ValueError: the file is no Part 21 file, or names an instance twice.
    """
    text = path.read_text(encoding="ascii")
    data = text[text.index("DATA;") + 5 : text.index("ENDSEC;", text.index("DATA;"))]
    tokens, found = _tokens(data), dict[str, Parts]()
    for kind, name in tokens:
        if kind != "reference" or name in found or next(tokens)[1] != "=":
            raise ValueError(f"{name} does not begin an instance of its own")
        kind, word = next(tokens)
        parts: Parts = {}
        if kind == "word":
            _open(tokens)
            parts[word] = _values(tokens)
        else:
            while (word := next(tokens)[1]) != ")":
                _open(tokens)
                parts[word] = _values(tokens)
        if next(tokens)[1] != ";":
            raise ValueError(f"{name} does not end")
        found[name] = parts
    return found


def _tokens(data: str) -> Iterator[tuple[str, str]]:
    place = 0
    while match := TOKEN.match(data, place):
        place = match.end()
        yield str(match.lastgroup), match[match.lastgroup or 0]
    if data[place:].strip():
        raise ValueError(f"no Part 21: {data[place : place + 40]!r}")


def _open(tokens: Iterator[tuple[str, str]]) -> None:
    if next(tokens)[1] != "(":
        raise ValueError("a list does not open")


def _values(tokens: Iterator[tuple[str, str]]) -> list[Value]:
    """The values up to the end of a list that is open."""
    found: list[Value] = []
    for kind, text in tokens:
        if text == ")":
            return found
        if text == ",":
            continue
        if text == "(":
            found.append(Value("list", _values(tokens)))
        elif kind == "word":
            _open(tokens)
            found.append(Value(text, _values(tokens)))
        else:
            found.append(Value(text if text in "$*" else kind, text))
    raise ValueError("a list does not end")


_CURVES = "LINE|CIRCLE|ELLIPSE|B_SPLINE_CURVE_WITH_KNOTS|SURFACE_CURVE|SEAM_CURVE"
_SURFACES = "PLANE|CYLINDRICAL_SURFACE|CONICAL_SURFACE|B_SPLINE_SURFACE_WITH_KNOTS"
_SPACE = (
    "GEOMETRIC_REPRESENTATION_CONTEXT+GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT+GLOBAL_UNIT_ASSIGNED_CONTEXT"
    "+REPRESENTATION_CONTEXT"
)
_SHAPES = "SHAPE_REPRESENTATION|ADVANCED_BREP_SHAPE_REPRESENTATION|MANIFOLD_SURFACE_SHAPE_REPRESENTATION"
_ITEMS = (
    "AXIS2_PLACEMENT_3D|MANIFOLD_SOLID_BREP|SHELL_BASED_SURFACE_MODEL|MEASURE_REPRESENTATION_ITEM|CARTESIAN_POINT"
    "|DESCRIPTIVE_REPRESENTATION_ITEM"
)
_SI = "LENGTH_UNIT+NAMED_UNIT+SI_UNIT|MASS_UNIT+NAMED_UNIT+SI_UNIT"
_UNITS = f"{_SI}|NAMED_UNIT+PLANE_ANGLE_UNIT+SI_UNIT|NAMED_UNIT+SI_UNIT+SOLID_ANGLE_UNIT|DERIVED_UNIT"
_MEASURES = "AREA_MEASURE|VOLUME_MEASURE|LENGTH_MEASURE|POSITIVE_LENGTH_MEASURE|MASS_MEASURE|NUMERIC_MEASURE"
_RELATION = (
    "REPRESENTATION_RELATIONSHIP+REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION+SHAPE_REPRESENTATION_RELATIONSHIP"
)
_FORM_OF_CURVE = "UNSPECIFIED|POLYLINE_FORM|CIRCULAR_ARC|ELLIPTIC_ARC|PARABOLIC_ARC|HYPERBOLIC_ARC"
_FORM_OF_SURFACE = "UNSPECIFIED|PLANE_SURF|CYLINDRICAL_SURF|CONICAL_SURF|RULED_SURF"
_KNOTS = ".UNIFORM_KNOTS|UNSPECIFIED|QUASI_UNIFORM_KNOTS|PIECEWISE_BEZIER_KNOTS"

_DEFINITIONS = "PRODUCT_DEFINITION|PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS"

ENTITIES: dict[str, str] = {
    "APPLICATION_CONTEXT": "s",
    "APPLICATION_PROTOCOL_DEFINITION": "s s i #APPLICATION_CONTEXT",
    "PRODUCT_CONTEXT": "s #APPLICATION_CONTEXT s",
    "PRODUCT_DEFINITION_CONTEXT": "s #APPLICATION_CONTEXT s",
    "PRODUCT": "s s ?s 1(#PRODUCT_CONTEXT)",
    "PRODUCT_RELATED_PRODUCT_CATEGORY": "s ?s 1(#PRODUCT)",
    "PRODUCT_DEFINITION_FORMATION": "s ?s #PRODUCT",
    "PRODUCT_DEFINITION": "s ?s #PRODUCT_DEFINITION_FORMATION #PRODUCT_DEFINITION_CONTEXT",
    "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS": (
        "s ?s #PRODUCT_DEFINITION_FORMATION #PRODUCT_DEFINITION_CONTEXT 1(#DOCUMENT_FILE)"
    ),
    "PRODUCT_DEFINITION_SHAPE": f"s ?s #{_DEFINITIONS}|NEXT_ASSEMBLY_USAGE_OCCURRENCE",
    "NEXT_ASSEMBLY_USAGE_OCCURRENCE": f"s s ?s #{_DEFINITIONS} #{_DEFINITIONS} ?s",
    "SHAPE_DEFINITION_REPRESENTATION": f"#PRODUCT_DEFINITION_SHAPE #{_SHAPES}",
    "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION": f"#{_RELATION} #PRODUCT_DEFINITION_SHAPE",
    "ITEM_DEFINED_TRANSFORMATION": "s ?s #AXIS2_PLACEMENT_3D #AXIS2_PLACEMENT_3D",
    "SHAPE_REPRESENTATION": f"s 1(#{_ITEMS}) #{_SPACE}",
    "ADVANCED_BREP_SHAPE_REPRESENTATION": f"s 1(#AXIS2_PLACEMENT_3D|MANIFOLD_SOLID_BREP) #{_SPACE}",
    "MANIFOLD_SURFACE_SHAPE_REPRESENTATION": f"s 1(#AXIS2_PLACEMENT_3D|SHELL_BASED_SURFACE_MODEL) #{_SPACE}",
    "MANIFOLD_SOLID_BREP": "s #CLOSED_SHELL",
    "SHELL_BASED_SURFACE_MODEL": "s 1(#OPEN_SHELL|CLOSED_SHELL)",
    "CLOSED_SHELL": "s 1(#ADVANCED_FACE)",
    "OPEN_SHELL": "s 1(#ADVANCED_FACE)",
    "ADVANCED_FACE": f"s 1(#FACE_BOUND|FACE_OUTER_BOUND) #{_SURFACES} b",
    "FACE_BOUND": "s #EDGE_LOOP b",
    "FACE_OUTER_BOUND": "s #EDGE_LOOP b",
    "EDGE_LOOP": "s 1(#ORIENTED_EDGE)",
    "ORIENTED_EDGE": "s * * #EDGE_CURVE b",
    "EDGE_CURVE": f"s #VERTEX_POINT #VERTEX_POINT #{_CURVES} b",
    "VERTEX_POINT": "s #CARTESIAN_POINT",
    "CARTESIAN_POINT": "s 1(r)3",
    "DIRECTION": "s 2(r)3",
    "VECTOR": "s #DIRECTION r",
    "AXIS2_PLACEMENT_2D": "s #CARTESIAN_POINT ?#DIRECTION",
    "AXIS2_PLACEMENT_3D": "s #CARTESIAN_POINT ?#DIRECTION ?#DIRECTION",
    "LINE": "s #CARTESIAN_POINT #VECTOR",
    "CIRCLE": "s #AXIS2_PLACEMENT_3D|AXIS2_PLACEMENT_2D r",
    "ELLIPSE": "s #AXIS2_PLACEMENT_3D|AXIS2_PLACEMENT_2D r r",
    "PLANE": "s #AXIS2_PLACEMENT_3D",
    "CYLINDRICAL_SURFACE": "s #AXIS2_PLACEMENT_3D r",
    "CONICAL_SURFACE": "s #AXIS2_PLACEMENT_3D r r",
    "B_SPLINE_CURVE_WITH_KNOTS": f"s i 2(#CARTESIAN_POINT) .{_FORM_OF_CURVE} l l 2(i) 2(r) {_KNOTS}",
    "B_SPLINE_SURFACE_WITH_KNOTS": (
        f"s i i 2(2(#CARTESIAN_POINT)) .{_FORM_OF_SURFACE} l l l 2(i) 2(i) 2(r) 2(r) {_KNOTS}"
    ),
    "SURFACE_CURVE": "s #LINE|CIRCLE|ELLIPSE|B_SPLINE_CURVE_WITH_KNOTS 1(#PCURVE)2 .CURVE_3D|PCURVE_S1|PCURVE_S2",
    "SEAM_CURVE": "s #LINE|CIRCLE|ELLIPSE|B_SPLINE_CURVE_WITH_KNOTS 2(#PCURVE)2 .CURVE_3D|PCURVE_S1|PCURVE_S2",
    "PCURVE": f"s #{_SURFACES} #DEFINITIONAL_REPRESENTATION",
    "DEFINITIONAL_REPRESENTATION": (
        "s 1(#LINE|CIRCLE|ELLIPSE|B_SPLINE_CURVE_WITH_KNOTS)"
        " #GEOMETRIC_REPRESENTATION_CONTEXT+PARAMETRIC_REPRESENTATION_CONTEXT+REPRESENTATION_CONTEXT"
    ),
    "UNCERTAINTY_MEASURE_WITH_UNIT": f"m:LENGTH_MEASURE #{_UNITS} s ?s",
    "PROPERTY_DEFINITION": (
        f"s ?s #{_DEFINITIONS}|PRODUCT_DEFINITION_SHAPE|NEXT_ASSEMBLY_USAGE_OCCURRENCE|DOCUMENT_FILE"
    ),
    "PROPERTY_DEFINITION_REPRESENTATION": f"#PROPERTY_DEFINITION|GENERAL_PROPERTY #REPRESENTATION|{_SHAPES}",
    "REPRESENTATION": f"s 1(#{_ITEMS}) #{_SPACE}|REPRESENTATION_CONTEXT",
    "REPRESENTATION_CONTEXT": "s s",
    "MEASURE_REPRESENTATION_ITEM": f"s m:{_MEASURES} #{_UNITS}",
    "DESCRIPTIVE_REPRESENTATION_ITEM": "s s",
    "GENERAL_PROPERTY": "s s ?s",
    "GENERAL_PROPERTY_ASSOCIATION": "s ?s #GENERAL_PROPERTY #PROPERTY_DEFINITION",
    "DERIVED_UNIT": "1(#DERIVED_UNIT_ELEMENT)",
    "DERIVED_UNIT_ELEMENT": f"#{_SI} r",
    "STYLED_ITEM": "s 1(#PRESENTATION_STYLE_ASSIGNMENT) #MANIFOLD_SOLID_BREP|SHELL_BASED_SURFACE_MODEL|ADVANCED_FACE",
    "PRESENTATION_STYLE_ASSIGNMENT": "1(#SURFACE_STYLE_USAGE)",
    "SURFACE_STYLE_USAGE": ".POSITIVE|NEGATIVE|BOTH #SURFACE_SIDE_STYLE",
    "SURFACE_SIDE_STYLE": "s 1(#SURFACE_STYLE_FILL_AREA)7",
    "SURFACE_STYLE_FILL_AREA": "#FILL_AREA_STYLE",
    "FILL_AREA_STYLE": "s 1(#FILL_AREA_STYLE_COLOUR)",
    "FILL_AREA_STYLE_COLOUR": "s #COLOUR_RGB",
    "COLOUR_RGB": "s r r r",
    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION": f"s 1(#STYLED_ITEM|AXIS2_PLACEMENT_3D) #{_SPACE}",
    "DOCUMENT_TYPE": "s",
    "DOCUMENT_FILE": "s s ?s #DOCUMENT_TYPE s ?s",
    "DOCUMENT_REPRESENTATION_TYPE": "s #DOCUMENT_FILE",
    "IDENTIFICATION_ROLE": "s ?s",
    "EXTERNAL_SOURCE": "t:IDENTIFIER|MESSAGE",
    "APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT": "s #IDENTIFICATION_ROLE #EXTERNAL_SOURCE 1(#DOCUMENT_FILE)",
    "APPLIED_DOCUMENT_REFERENCE": f"#DOCUMENT_FILE s 1(#{_DEFINITIONS})",
    "OBJECT_ROLE": "s ?s",
    "ROLE_ASSOCIATION": "#OBJECT_ROLE #APPLIED_DOCUMENT_REFERENCE",
}
COMPLEX: dict[str, dict[str, str]] = {
    _SPACE: {
        "GEOMETRIC_REPRESENTATION_CONTEXT": "i",
        "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT": "1(#UNCERTAINTY_MEASURE_WITH_UNIT)",
        "GLOBAL_UNIT_ASSIGNED_CONTEXT": f"1(#{_UNITS})",
        "REPRESENTATION_CONTEXT": "s s",
    },
    "GEOMETRIC_REPRESENTATION_CONTEXT+PARAMETRIC_REPRESENTATION_CONTEXT+REPRESENTATION_CONTEXT": {
        "GEOMETRIC_REPRESENTATION_CONTEXT": "i",
        "PARAMETRIC_REPRESENTATION_CONTEXT": "",
        "REPRESENTATION_CONTEXT": "s s",
    },
    _RELATION: {
        "REPRESENTATION_RELATIONSHIP": f"s ?s #{_SHAPES} #{_SHAPES}",
        "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION": "#ITEM_DEFINED_TRANSFORMATION",
        "SHAPE_REPRESENTATION_RELATIONSHIP": "",
    },
    "LENGTH_UNIT+NAMED_UNIT+SI_UNIT": {"LENGTH_UNIT": "", "NAMED_UNIT": "*", "SI_UNIT": "?.MILLI .METRE"},
    "MASS_UNIT+NAMED_UNIT+SI_UNIT": {"MASS_UNIT": "", "NAMED_UNIT": "*", "SI_UNIT": "?.KILO .GRAM"},
    "NAMED_UNIT+PLANE_ANGLE_UNIT+SI_UNIT": {"NAMED_UNIT": "*", "PLANE_ANGLE_UNIT": "", "SI_UNIT": "?.MILLI .RADIAN"},
    "NAMED_UNIT+SI_UNIT+SOLID_ANGLE_UNIT": {"NAMED_UNIT": "*", "SI_UNIT": "?.MILLI .STERADIAN", "SOLID_ANGLE_UNIT": ""},
}
"""Complex instances, their types in alphabetical order as Part 21 wants them, and the attributes of each."""


def faults(instances: dict[str, Parts]) -> Iterator[str]:
    """One sentence for everything that the table does not allow; where there is nothing, for every rule that is broken.

    The rules are those of representation_relationship_with_transformation in part 43: its representations have
    different contexts, and each has the item by which it is transformed. The schema is content with an item in any
    representation of the same context; readers look among the representation's own.
    """
    found = list(_strange_values(instances))
    yield from found or _broken_rules(instances)


def _broken_rules(instances: dict[str, Parts]) -> Iterator[str]:
    for name, parts in instances.items():
        if "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION" not in parts:
            continue
        [operator] = parts["REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"]
        of_items = instances[str(operator.content)]["ITEM_DEFINED_TRANSFORMATION"][2:]
        related = [_representation(instances, one) for one in parts["REPRESENTATION_RELATIONSHIP"][2:]]
        if len({context for _, context in related}) < len(related):
            yield f"{name}: both representations have the context {related[0][1]}"
        for item, (items, _) in zip(of_items, related, strict=True):
            if item not in items:
                yield f"{name}: {item.content} is no item of the representation that it transforms"


def _representation(instances: dict[str, Parts], reference: Value) -> tuple[list[Value], object]:
    """The items of a representation, and the name of its context."""
    [(_, items, context)] = instances[str(reference.content)].values()
    assert isinstance(items.content, list)
    return items.content, context.content


def _strange_values(instances: dict[str, Parts]) -> Iterator[str]:
    types = {name: "+".join(parts) for name, parts in instances.items()}
    for name, parts in instances.items():
        called = f"{name}={types[name]}"
        table = COMPLEX.get(types[name]) if len(parts) > 1 else {k: ENTITIES[k] for k in parts if k in ENTITIES}
        if not table:
            yield f"{called}: no such type is known"
            continue
        for part, values in parts.items():
            wanted = table[part].split()
            if len(values) != len(wanted):
                yield f"{called}: {part} has {len(values)} attributes instead of {len(wanted)}"
                continue
            for place, (value, kind) in enumerate(zip(values, wanted, strict=True), start=1):
                if not _is(value, kind, types):
                    yield f"{called}: attribute {place} of {part} is {value}, not {kind}"


def _is(value: Value, wanted: str, types: dict[str, str]) -> bool:
    """Whether an attribute is of the kind that a word of the table tells."""
    if wanted[0] == "?":
        return value.kind == "$" or _is(value, wanted[1:], types)
    if wanted[0].isdigit():
        least, most = int(wanted[0]), wanted[wanted.rindex(")") + 1 :]
        inner = wanted[2 : wanted.rindex(")")]
        if value.kind != "list" or not isinstance(value.content, list):
            return False
        enough = least <= len(value.content) <= (int(most) if most else len(value.content))
        return enough and all(_is(one, inner, types) for one in value.content)
    if wanted[0] == "#":
        return value.kind == "reference" and types.get(str(value.content)) in wanted[1:].split("|")
    if wanted.startswith("m:"):
        return value.kind in wanted[2:].split("|") and [one.kind for one in value.content] == ["real"]  # type: ignore[attr-defined]
    if wanted.startswith("t:"):
        return value.kind in wanted[2:].split("|") and [one.kind for one in value.content] == ["string"]  # type: ignore[attr-defined]
    if wanted[0] == ".":
        return value.kind == "enumeration" and str(value.content)[1:-1] in wanted[1:].split("|")
    if wanted in ("b", "l"):
        allowed = (".T.", ".F.") if wanted == "b" else (".T.", ".F.", ".U.")
        return value.kind == "enumeration" and value.content in allowed
    return value.kind == {"s": "string", "r": "real", "i": "integer", "*": "*"}[wanted]
