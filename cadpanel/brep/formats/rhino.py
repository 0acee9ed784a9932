"""Rhino .3dm files, read by rhino3dm: surfaces, polysurfaces, extrusions and curves, with blocks placed.

What lies on a layer that is switched off, or is hidden, is left out with a note, as are meshes and subdivision objects.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import Any

from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS, TopoDS_Shape

from cadpanel.brep.formats.format import Format, check_nothing
from cadpanel.brep.formats.opennurbs import ConversionError, brep_shape, curve_edge, surface_face
from cadpanel.brep.formats.units import scaled
from cadpanel.brep.model import Label, Model, Part, shapes_of
from cadpanel.brep.trims import sharpen_trims
from cadpanel.errors import ReferenceFileError

MAGIC = re.compile(rb"\s*3D Geometry File Format")
# Blocks may hold blocks; a file in which they go deeper than this holds itself.
DEEPEST_BLOCK = 32
# The units that Rhino knows, by its names for them: what they are called here, and how many mm they have.
UNITS = {
    "Microns": ("micrometre", 1e-3),
    "Millimeters": ("millimetre", 1.0),
    "Centimeters": ("centimetre", 10.0),
    "Decimeters": ("decimetre", 100.0),
    "Meters": ("metre", 1000.0),
    "Dekameters": ("decametre", 1e4),
    "Hectometers": ("hectometre", 1e5),
    "Kilometers": ("kilometre", 1e6),
    "Mils": ("mil", 0.0254),
    "Inches": ("inch", 25.4),
    "Feet": ("foot", 304.8),
    "Yards": ("yard", 914.4),
}
# What rhino3dm gives is untyped; each of these is one of its objects.
RhinoFile = Any
RhinoObject = Any
Transform = Any


@dataclass(frozen=True, slots=True, kw_only=True)
class _Placed:
    """An object's geometry where it stands, and what the file says of it; whether Rhino could put it there."""

    geometry: RhinoObject
    stands: bool
    label: Label
    place: int


def _read(path: Path, millimetres: float | None) -> Model:
    rhino = load_rhino3dm(path.name)
    file = rhino.File3dm.Read(str(path))
    if file is None:
        raise ReferenceFileError(f"'{path.name}' is damaged: rhino3dm cannot read it; save it again in Rhino.")
    unit, factor, own = _unit(path.name, file, millimetres)
    parts: list[Part] = []
    left_out: Counter[str] = Counter()
    for placed in _objects(path.name, file, left_out):
        try:
            shape = _shape(rhino, placed.geometry)
            if shape is not None and not placed.stands:
                raise ConversionError("it cannot be placed as its block says, flattened or with a number that is none")
        except (ConversionError, Standard_Failure) as error:
            raise ReferenceFileError(
                f"'{path.name}' holds an object that cannot be read (number {placed.place}"
                f"{f', {chr(39)}{placed.label.name}{chr(39)}' if placed.label.name else ''}: {error}): "
                "repair or rebuild it in Rhino and save again."
            ) from error
        if shape is None:
            left_out[_kind(placed.geometry)] += 1
            continue
        shape = scaled(shape, factor)
        # Only now are lengths millimetres, of which the kernel's projections may be a whole one off.
        for face in shapes_of(shape, TopAbs_FACE):
            sharpen_trims(TopoDS.Face_s(face))
        parts.append(Part(label=placed.label, shape=shape, face_labels=(Label(),) * len(shapes_of(shape, TopAbs_FACE))))
    notes = tuple(f"'{path.name}': {count} x {kind} left out." for kind, count in sorted(left_out.items()))
    return Model(source=path.name, format=RHINO.name, unit=unit, own_unit=own, parts=tuple(parts), notes=notes)


def load_rhino3dm(source: str) -> Any:
    """The library that reads .3dm files.

    Raises:
        ReferenceFileError: it is not installed; the message says how to.
    """
    try:
        return import_module("rhino3dm")
    except ImportError:
        raise ReferenceFileError(
            f"'{source}' is a Rhino file, and reading those needs rhino3dm: install it with "
            "'pip install cadpanel[rhino]', or export the model as STEP."
        ) from None


def _unit(name: str, file: RhinoFile, millimetres: float | None) -> tuple[str, float, bool]:
    """The model's unit as a word, how many mm it has, and whether the file says so."""
    word = str(file.Settings.ModelUnitSystem.name)
    if word in UNITS:
        return *UNITS[word], True
    if millimetres is None:
        raise ReferenceFileError(
            f"'{name}' has no unit that can be converted (it says '{word}'): give one, or set one in Rhino."
        )
    return f"none, read as {millimetres:g} mm", millimetres, False


def _objects(name: str, file: RhinoFile, left_out: Counter[str]) -> Iterator[_Placed]:
    """The visible objects outside blocks and those of placed blocks, in file order."""
    by_id = {str(thing.Attributes.Id): thing for thing in file.Objects}
    for place, thing in enumerate(file.Objects, start=1):
        if thing.Attributes.IsInstanceDefinitionObject:
            continue
        yield from _expand(name, file, by_id, thing, place, left_out, ())


def _expand(
    name: str,
    file: RhinoFile,
    by_id: dict[str, RhinoObject],
    thing: RhinoObject,
    place: int,
    left_out: Counter[str],
    transforms: tuple[Transform, ...],
) -> Iterator[_Placed]:
    """One object, or those of the block that it places."""
    label, hidden = _label(file, thing)
    if hidden:
        left_out["hidden object"] += 1
        return
    if len(transforms) > DEEPEST_BLOCK:
        raise ReferenceFileError(f"'{name}' holds a block that holds itself: explode it in Rhino and save again.")
    geometry = thing.Geometry
    if geometry is None:
        left_out["object without geometry"] += 1
        return
    if type(geometry).__name__ != "InstanceReference":
        if transforms:
            geometry = geometry.Duplicate()
        # Of a perspective Rhino makes nothing of use, and says so for some objects only.
        stands = all(transform.IsAffine and geometry.Transform(transform) for transform in reversed(transforms))
        yield _Placed(geometry=geometry, stands=stands, label=label, place=place)
        return
    definition = file.InstanceDefinitions.FindId(geometry.ParentIdefId)
    if definition is None:
        left_out["block without a definition"] += 1
        return
    for member in definition.GetObjectIds():
        inner = by_id.get(str(member))
        if inner is not None:
            for placed in _expand(name, file, by_id, inner, place, left_out, (*transforms, geometry.Xform)):
                yield replace(placed, label=placed.label.over(label))


def _label(file: RhinoFile, thing: RhinoObject) -> tuple[Label, bool]:
    """What the file says of an object, and whether it is hidden."""
    attributes = thing.Attributes
    layer = next((layer for layer in file.Layers if layer.Index == attributes.LayerIndex), None)
    by_object = attributes.ColorSource.name == "ColorFromObject"
    color = attributes.ObjectColor if by_object or layer is None else layer.Color
    label = Label(
        name=attributes.Name or "",
        layer="" if layer is None else layer.FullPath or layer.Name,
        color="#{:02x}{:02x}{:02x}".format(*color[:3]),
    )
    return label, not attributes.Visible or attributes.Mode.name == "Hidden" or not (layer is None or layer.Visible)


def _shape(rhino: Any, geometry: RhinoObject) -> TopoDS_Shape | None:
    """An object as a shape of the kernel, or None where it is neither of faces nor a curve."""
    if isinstance(geometry, rhino.Extrusion):
        geometry = geometry.ToBrep(True)
        if geometry is None:
            raise ConversionError("its extrusion cannot be made a polysurface")
    if isinstance(geometry, rhino.Brep):
        return brep_shape(geometry)
    if isinstance(geometry, rhino.Surface):
        return surface_face(geometry)
    if isinstance(geometry, rhino.Curve):
        return curve_edge(geometry)
    return None


def _kind(geometry: RhinoObject) -> str:
    return f"{type(geometry).__name__} (only surfaces, polysurfaces, extrusions and curves are read)"


RHINO = Format(
    name="Rhino",
    suffixes=(".3dm",),
    recognises=lambda head: MAGIC.match(head) is not None,
    check=check_nothing,
    read=_read,
)
