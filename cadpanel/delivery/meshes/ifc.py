"""Panels as IFC4 (ISO 16739-1:2018): plates of a curtain wall, with their numbers as properties. Millimetres.

Shapes are closed sets of triangles: IFC4 has no conical surface, and triangles are what every reader takes.
"""

from __future__ import annotations

import uuid
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.guid
import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.step.properties import ATTRIBUTES, PartData
from cadpanel.delivery.meshes.glb import MeshedPanel
from cadpanel.errors import DeliveryError
from cadpanel.geometry.triangles import merged

PROPERTIES = "cadpanel_Panel"
QUANTITIES = "Qto_PlateBaseQuantities"
_TOGETHER = 1e-5
_MEASURES = {"length": "IfcLengthMeasure", "mass": "IfcMassMeasure", "text": "IfcText"}
_M2, _M3 = 1e-6, 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class IfcHeader:
    """Who a file is from, when, and where the origin of the panels' coordinates lies in it, mm."""

    title: str
    date: datetime
    author: str
    organization: str
    placed: tuple[float, float, float]
    origin: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class IfcPanel:
    """A panel to be written: its mesh and colour, what is said of it, the area of its blank in mm2."""

    mesh: MeshedPanel
    data: PartData
    blank_area: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadPlate:
    """A plate that was read back: its name, points (v, 3) in mm, triangles (t, 3), and its properties."""

    name: str
    points: Array
    corners: IntArray
    properties: Mapping[str, object]


def property_name(attribute: str) -> str:
    """As IFC writes names: "blank length" is BlankLength."""
    return "".join(word.capitalize() for word in attribute.split())


def ifc_text(panels: Sequence[IfcPanel], header: IfcHeader) -> str:
    """A whole file; the same panels and header give the same text, and a panel keeps its identity by its name."""
    return _Writer(header).text(panels)


def read_ifc(path: Path) -> list[ReadPlate]:
    """The plates of a file that `ifc_text` made, in its order.

    Raises:
        DeliveryError: it cannot be read, or is no such file.
    """
    try:
        text = path.read_text(encoding="utf-8")
        if not text.rstrip().endswith("END-ISO-10303-21;"):  # the library takes what there is
            raise ValueError("it has no end")
        file = ifcopenshell.file.from_string(text)
        return [_read(plate) for plate in file.by_type("IfcPlate")]
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except (RuntimeError, ValueError, TypeError, AttributeError, IndexError, ifcopenshell.Error) as error:
        raise DeliveryError(f"'{path}' cannot be read: it is no whole IFC file ({error}).") from error


def _read(plate: Any) -> ReadPlate:
    (shape,) = plate.Representation.Representations[0].Items
    points = np.array(shape.Coordinates.CoordList, dtype=np.float64)
    placement = plate.ObjectPlacement
    while placement is not None:
        points = points + placement.RelativePlacement.Location.Coordinates
        placement = placement.PlacementRelTo
    sets = [relation.RelatingPropertyDefinition for relation in plate.IsDefinedBy]
    (own,) = [found for found in sets if found.Name == PROPERTIES]
    values = {one.Name: one.NominalValue.wrappedValue for one in own.HasProperties}
    return ReadPlate(
        name=plate.Name, points=points, corners=np.array(shape.CoordIndex, dtype=np.intp) - 1, properties=values
    )


class _Writer:
    """A file under construction."""

    def __init__(self, header: IfcHeader) -> None:
        self._file = ifcopenshell.file(schema="IFC4")
        self._header = header
        name = self._file.header.file_name
        name.name = header.title
        name.time_stamp = header.date.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%S+00:00")
        name.author, name.organization = (header.author,), (header.organization,)
        name.preprocessor_version = name.originating_system = "cadpanel"
        name.authorization = ""
        self._file.header.file_description.description = ("Panels of a curtain wall",)
        self._styles: dict[tuple[float, float, float], Any] = {}
        self._materials: dict[tuple[str, float], Any] = {}

    def text(self, panels: Sequence[IfcPanel]) -> str:
        """All of it."""
        context, body = self._contexts()
        title = self._header.title
        project = self._root("IfcProject", title, RepresentationContexts=[context], UnitsInContext=self._units())
        site = self._root("IfcSite", "Site", ObjectPlacement=self._placement(self._header.placed, None))
        building = self._root("IfcBuilding", "Building", ObjectPlacement=self._placement(None, site.ObjectPlacement))
        wall = self._root(
            "IfcCurtainWall",
            title,
            ObjectPlacement=self._placement(None, building.ObjectPlacement),
            PredefinedType="NOTDEFINED",
        )
        origin = {f"{axis} of the local origin": value for axis, value in zip("XYZ", self._header.origin, strict=True)}
        self._properties(wall, "cadpanel_Origin", {name: ("IfcLengthMeasure", at) for name, at in origin.items()})
        plates = [self._plate(panel, body, wall.ObjectPlacement) for panel in panels]
        self._root("IfcRelAggregates", "site", RelatingObject=project, RelatedObjects=[site])
        self._root("IfcRelAggregates", "building", RelatingObject=site, RelatedObjects=[building])
        self._root("IfcRelContainedInSpatialStructure", "wall", RelatingStructure=building, RelatedElements=[wall])
        self._root("IfcRelAggregates", "panels", RelatingObject=wall, RelatedObjects=plates)
        for key, material in self._materials.items():
            own = [plate for plate, panel in zip(plates, panels, strict=True) if _material_of(panel) == key]
            self._root("IfcRelAssociatesMaterial", key[0], RelatingMaterial=material, RelatedObjects=own)
        return str(self._file.to_string())

    def _plate(self, panel: IfcPanel, body: Any, within: Any) -> Any:
        mesh, data = panel.mesh.mesh, panel.data
        points, place = merged(mesh.points, _TOGETHER)
        origin = points[0]
        coordinates = self._add("IfcCartesianPointList3D", CoordList=(points - origin).tolist())
        corners = (place[mesh.corners] + 1).tolist()
        shape = self._add("IfcTriangulatedFaceSet", Coordinates=coordinates, Closed=True, CoordIndex=corners)
        self._add("IfcStyledItem", Item=shape, Styles=[self._style(panel.mesh.colour)])
        representation = self._add(
            "IfcShapeRepresentation",
            ContextOfItems=body,
            RepresentationIdentifier="Body",
            RepresentationType="Tessellation",
            Items=[shape],
        )
        plate = self._root(
            "IfcPlate",
            panel.mesh.name,
            Description=data.description,
            ObjectPlacement=self._placement(tuple(origin.tolist()), within),
            Representation=self._add("IfcProductDefinitionShape", Representations=[representation]),
            Tag=data.number,
            PredefinedType="CURTAIN_PANEL",
        )
        values = {property_name(name): (_MEASURES[ATTRIBUTES[name]], value) for name, value in data.attributes.items()}
        self._properties(plate, PROPERTIES, values)
        self._properties(plate, "Pset_PlateCommon", {"Reference": ("IfcIdentifier", data.description)})
        self._quantities(plate, panel)
        if data.material is not None and _material_of(panel) not in self._materials:
            self._materials[_material_of(panel)] = self._material(data.material.name, data.material.density)
        return plate

    def _quantities(self, plate: Any, panel: IfcPanel) -> None:
        data = panel.data
        found = [("IfcQuantityArea", "NetArea", "AreaValue", panel.blank_area * _M2)]
        if isinstance(thickness := data.attributes.get("thickness"), float):
            found.append(("IfcQuantityLength", "Width", "LengthValue", thickness))
        if data.validation is not None and data.validation.volume is not None:
            found.append(("IfcQuantityVolume", "NetVolume", "VolumeValue", data.validation.volume * _M3))
        if isinstance(mass := data.attributes.get("mass"), float):
            found.append(("IfcQuantityWeight", "NetWeight", "WeightValue", mass))
        quantities = [self._add(kind, Name=name, **{value: number}) for kind, name, value, number in found]
        one = self._root("IfcElementQuantity", QUANTITIES, of=plate.Name, Quantities=quantities)
        self._define(plate, one)

    def _properties(self, of: Any, called: str, values: Mapping[str, tuple[str, str | float]]) -> None:
        rows = [
            self._add("IfcPropertySingleValue", Name=name, NominalValue=self._file.create_entity(measure, value))
            for name, (measure, value) in values.items()
        ]
        self._define(of, self._root("IfcPropertySet", called, of=of.Name, HasProperties=rows))

    def _define(self, element: Any, by: Any) -> None:
        self._root(
            "IfcRelDefinesByProperties",
            by.Name,
            of=element.Name,
            RelatedObjects=[element],
            RelatingPropertyDefinition=by,
        )

    def _material(self, name: str, density: float) -> Any:
        material = self._add("IfcMaterial", Name=name)
        value = self._file.create_entity("IfcMassDensityMeasure", density)
        row = self._add("IfcPropertySingleValue", Name="MassDensity", NominalValue=value)
        self._add("IfcMaterialProperties", Name="Pset_MaterialCommon", Properties=[row], Material=material)
        return material

    def _style(self, colour: tuple[float, float, float]) -> Any:
        if colour not in self._styles:
            rgb = self._add("IfcColourRgb", Red=colour[0], Green=colour[1], Blue=colour[2])
            shading = self._add("IfcSurfaceStyleShading", SurfaceColour=rgb, Transparency=0.0)
            self._styles[colour] = self._add("IfcSurfaceStyle", Side="BOTH", Styles=[shading])
        return self._styles[colour]

    def _contexts(self) -> tuple[Any, Any]:
        world = self._add("IfcAxis2Placement3D", Location=self._point((0.0, 0.0, 0.0)))
        context = self._add(
            "IfcGeometricRepresentationContext",
            ContextType="Model",
            CoordinateSpaceDimension=3,
            Precision=_TOGETHER,
            WorldCoordinateSystem=world,
        )
        body = self._add(
            "IfcGeometricRepresentationSubContext",
            ContextIdentifier="Body",
            ContextType="Model",
            ParentContext=context,
            TargetView="MODEL_VIEW",
        )
        return context, body

    def _units(self) -> Any:
        units = [self._add("IfcSIUnit", UnitType="LENGTHUNIT", Prefix="MILLI", Name="METRE")]
        for kind, name in (("AREAUNIT", "SQUARE_METRE"), ("VOLUMEUNIT", "CUBIC_METRE"), ("PLANEANGLEUNIT", "RADIAN")):
            units.append(self._add("IfcSIUnit", UnitType=kind, Name=name))
        kilogram = self._add("IfcSIUnit", UnitType="MASSUNIT", Prefix="KILO", Name="GRAM")
        metre = self._add("IfcSIUnit", UnitType="LENGTHUNIT", Name="METRE")
        parts = [
            self._add("IfcDerivedUnitElement", Unit=unit, Exponent=exponent)
            for unit, exponent in ((kilogram, 1), (metre, -3))
        ]
        density = self._add("IfcDerivedUnit", Elements=parts, UnitType="MASSDENSITYUNIT")
        return self._add("IfcUnitAssignment", Units=[*units, kilogram, density])

    def _placement(self, place: tuple[float, ...] | None, within: Any) -> Any:
        axes = self._add("IfcAxis2Placement3D", Location=self._point(place or (0.0, 0.0, 0.0)))
        return self._add("IfcLocalPlacement", PlacementRelTo=within, RelativePlacement=axes)

    def _point(self, place: tuple[float, ...]) -> Any:
        return self._add("IfcCartesianPoint", Coordinates=place)

    def _root(self, kind: str, name: str, of: str = "", **more: Any) -> Any:
        """An entity with an identity: that of its kind, its name and what it belongs to, in this project."""
        own = uuid.uuid5(uuid.NAMESPACE_URL, "\n".join(("cadpanel", self._header.title, kind, of, name)))
        return self._add(kind, GlobalId=ifcopenshell.guid.compress(own.hex), Name=name, **more)

    def _add(self, kind: str, **values: Any) -> Any:
        return self._file.create_entity(kind, **values)


def _material_of(panel: IfcPanel) -> tuple[str, float]:
    material = panel.data.material
    return ("", 0.0) if material is None else (material.name, material.density)
