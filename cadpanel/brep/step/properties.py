"""What a STEP file says of a part besides its shape: attributes, material, and numbers to check an import by.

Written as the CAx-IF recommends: "Geometric and Assembly Validation Properties" (volume, surface area, centroid),
"User Defined Attributes" (values with their units), "Material Identification and Density".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from cadpanel.brep.step.text import StepText, real, references, string

Measure = Literal["length", "mass", "text"]
USER_DEFINED = "user defined attribute"
ATTRIBUTES: dict[str, Measure] = {
    "material": "text",
    "thickness": "length",
    "feature": "text",
    "smallest inner radius": "length",
    "largest inner radius": "length",
    "mass": "mass",
    "blank length": "length",
    "blank width": "length",
    "stock sheet": "text",
}
"""The attributes that a part may have, in the order in which they are written: lengths in mm, masses in kg."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """What a part is made of: its name, and its density in kg/m3."""

    name: str
    density: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Validation:
    """Numbers by which a receiver sees that the shape arrived whole.

    Attributes:
        area: of all faces, mm2.
        volume: mm3; None of an open shell.
        centroid: of the volume, or of the area of an open shell, in the part's own coordinates, mm.
    """

    area: float
    volume: float | None
    centroid: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class PartData:
    """What is said of one part.

    Attributes:
        number: its part number; different for every part of a house, so the project's name is in it.
        description: one line for those who read lists of parts.
        validation: by which it is checked; None to say nothing.
        material: None where it is not known.
        attributes: values of some of ATTRIBUTES.
    """

    number: str
    description: str = ""
    validation: Validation | None = None
    material: Material | None = None
    attributes: Mapping[str, str | float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stated:
    """What is said of one product; None where the file is silent.

    Attributes:
        area: of all faces, mm2.
        volume: mm3.
        centroid: in the product's own coordinates, mm.
        attributes: texts, and numbers in the file's units.
    """

    area: float | None = None
    volume: float | None = None
    centroid: tuple[float, float, float] | None = None
    attributes: dict[str, str | float] = field(default_factory=dict)


class PropertyWriter:
    """Writes the properties of the parts of one file; units and definitions are shared by all of them."""

    def __init__(self, text: StepText, context: int, length: int) -> None:
        """Args: where to write, the context that geometry has, its unit of length."""
        self._text, self._context, self._length = text, context, length
        self._shared: dict[str, int] = {}

    def write(self, data: PartData, definition: int, shape: int) -> None:
        """All that is said of a part, at its product definition and the shape of that."""
        if data.validation is not None:
            self._validation(data.validation, shape)
        if data.attributes:
            self._attributes(data.attributes, definition)
        if data.material is not None:
            # Last: OCCT's reader takes any text and measure for a material, and keeps the last ones.
            self._material(data.material, definition)

    def _validation(self, of: Validation, shape: int) -> None:
        rows = [("surface area", f"'surface area measure',AREA_MEASURE({real(of.area)}),#{self._power(2)}")]
        if of.volume is not None:
            rows.append(("volume", f"'volume measure',VOLUME_MEASURE({real(of.volume)}),#{self._power(3)}"))
        for name, measure in rows:
            item = self._text.add(f"MEASURE_REPRESENTATION_ITEM({measure})")
            self._property("'geometric validation property'", f"'{name}'", shape, f"'{name}'", [item])
        point = self._text.add(f"CARTESIAN_POINT('centre point',({','.join(map(real, of.centroid))}))")
        self._property("'geometric validation property'", "'centroid'", shape, "'centroid'", [point])

    def _material(self, material: Material, definition: int) -> None:
        name = string(material.name)
        item = self._text.add(f"DESCRIPTIVE_REPRESENTATION_ITEM({name},{name})")
        self._property("'material property'", "'material name'", definition, "'material name'", [item])
        # The practice has a POSITIVE_RATIO_MEASURE, which by the schema's rule on units may have no unit but 1.
        measure = f"'density measure',NUMERIC_MEASURE({real(material.density)}),#{self._density_unit()}"
        item = self._text.add(f"MEASURE_REPRESENTATION_ITEM({measure})")
        self._property("'material property'", "'density'", definition, "'density'", [item])

    def _attributes(self, attributes: Mapping[str, str | float], definition: int) -> None:
        # A property for each, though one may hold many: OCCT's reader keeps one value of each property.
        for key, measure in ATTRIBUTES.items():
            if key in attributes:
                name = string(key)
                general = self._once(f"GENERAL_PROPERTY('',{name},'{USER_DEFINED}')")
                item = self._text.add(self._item(name, attributes[key], measure))
                found = self._property(name, f"'{USER_DEFINED}'", definition, name, [item])
                self._text.add(f"GENERAL_PROPERTY_ASSOCIATION('{USER_DEFINED}','',#{general},#{found})")

    def _item(self, name: str, value: str | float, measure: Measure) -> str:
        if isinstance(value, str):
            return f"DESCRIPTIVE_REPRESENTATION_ITEM({name},{string(value)})"
        kind, unit = ("MASS_MEASURE", self._kilogram()) if measure == "mass" else ("LENGTH_MEASURE", self._length)
        return f"MEASURE_REPRESENTATION_ITEM({name},{kind}({real(value)}),#{unit})"

    def _property(self, name: str, description: str, of: int, called: str, items: list[int]) -> int:
        """A property definition with its representation, from quoted texts; its number."""
        add = self._text.add
        representation = add(f"REPRESENTATION({called},{references(items)},#{self._context})")
        found = add(f"PROPERTY_DEFINITION({name},{description},#{of})")
        add(f"PROPERTY_DEFINITION_REPRESENTATION(#{found},#{representation})")
        return found

    def _power(self, exponent: int) -> int:
        element = self._once(f"DERIVED_UNIT_ELEMENT(#{self._length},{real(exponent)})")
        return self._once(f"DERIVED_UNIT((#{element}))")

    def _kilogram(self) -> int:
        return self._once("(MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.KILO.,.GRAM.))")

    def _density_unit(self) -> int:
        metre = self._once("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))")
        mass = self._once(f"DERIVED_UNIT_ELEMENT(#{self._kilogram()},1.0)")
        volume = self._once(f"DERIVED_UNIT_ELEMENT(#{metre},-3.0)")
        return self._once(f"DERIVED_UNIT((#{mass},#{volume}))")

    def _once(self, entity: str) -> int:
        """An instance that the parts of a file share."""
        if entity not in self._shared:
            self._shared[entity] = self._text.add(entity)
        return self._shared[entity]
