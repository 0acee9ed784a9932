"""Rhino .3dm files, read by rhino3dm: surfaces, polysurfaces, extrusions and curves, with blocks placed.

What lies on a layer that is switched off, or is hidden, is left out with a note, as are meshes and subdivision objects.
"""

from __future__ import annotations

import re
from collections import Counter
from importlib import import_module
from pathlib import Path
from typing import Any

from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS, TopoDS_Shape

from cadpanel.brep.faces.pcurve_repair import sharpen_trims
from cadpanel.brep.files.format import Format, check_nothing
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.files.opennurbs import ConversionError, brep_shape, curve_edge, surface_face
from cadpanel.brep.files.rhino_objects import RhinoFile, RhinoObject, placed_objects, put
from cadpanel.brep.files.units import unit_taken
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError

MAGIC = re.compile(rb"\s*3D Geometry File Format")
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
MESH = "Mesh"
MESH_REMEDY = "meshes are not read: convert it to NURBS, or give it as OBJ with --mesh over a surface"


def _read(path: Path, millimetres: float | None) -> Model:
    rhino = load_rhino3dm(path.name)
    file = rhino.File3dm.Read(str(path))
    if file is None:
        raise ReferenceFileError(f"'{path.name}' is damaged: rhino3dm cannot read it; save it again in Rhino.")
    unit, factor, own = _unit(path.name, file, millimetres)
    parts: list[Part] = []
    left_out: Counter[str] = Counter()
    for placed in placed_objects(path.name, file, left_out):
        try:
            shape = _shape(rhino, placed.geometry)
            if shape is not None and placed.matrix is not None:
                shape = put(shape, placed.matrix)
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
    if left_out and not parts:
        raise _nothing_read(path.name, left_out)
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
    return unit_taken(millimetres), millimetres, False


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
    kind = type(geometry).__name__
    return f"{kind} ({MESH_REMEDY if kind == MESH else 'only surfaces, polysurfaces, extrusions and curves are read'})"


def _nothing_read(name: str, left_out: Counter[str]) -> ReferenceFileError:
    """The refusal of a file all of whose objects are left out."""
    what = "; ".join(f"{count} x {kind}" for kind, count in sorted(left_out.items()))
    return ReferenceFileError(
        f"'{name}' holds neither faces nor curves that are read, only what is left out, {what}: show or convert it in "
        "Rhino and save again."
    )


RHINO = Format(
    name="Rhino",
    suffixes=(".3dm",),
    recognises=lambda head: MAGIC.match(head) is not None,
    check=check_nothing,
    read=_read,
)
