"""Rhino .3dm files, read by rhino3dm: surfaces, polysurfaces, extrusions and curves, with blocks placed.

What lies on a layer that is switched off, or is hidden, is left out with a note, as are meshes and subdivision objects.
"""

from __future__ import annotations

from collections import Counter
from importlib import import_module
from pathlib import Path
from typing import Any

from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cadpanel.brep.faces.pcurve_repair import sharpen_trims
from cadpanel.brep.files.format import Format, check_nothing
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.files.opennurbs import ConversionError, curve_edge, surface_face
from cadpanel.brep.files.opennurbs_faces import Faces, brep_faces
from cadpanel.brep.files.rhino_objects import Placed, RhinoFile, RhinoObject, placed_objects, put
from cadpanel.brep.files.text_check import RHINO_START
from cadpanel.brep.files.units import unit_taken
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError

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
        part = _part(rhino, placed, factor, path.name)
        if part is None:
            left_out[_kind(placed.geometry)] += 1
        else:
            parts.append(part)
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


def _part(rhino: Any, placed: Placed, factor: float, source: str) -> Part | None:
    """An object as a part, or None where it is neither of faces nor a curve.

    Raises:
        ReferenceFileError: it is a curve that cannot be read.
    """
    if isinstance(placed.geometry, rhino.Curve):
        return _curve_part(placed, factor, source)
    faces = _faces(rhino, placed.geometry, factor)
    if faces is None:
        return None
    shape, unreadable = compound_of([]) if faces.shape is None else faces.shape, faces.unreadable
    if placed.matrix is not None:
        try:
            shape = put(shape, placed.matrix)
        except (ConversionError, Standard_Failure) as error:
            count = len(shapes_of(shape, TopAbs_FACE)) + len(unreadable)
            shape, unreadable = compound_of([]), dict.fromkeys(range(count), str(error))
    shape = scaled(shape, factor)
    own = shapes_of(shape, TopAbs_FACE)
    # Only now are lengths millimetres, of which a trim may run a whole one beside its edge.
    for face in own:
        sharpen_trims(TopoDS.Face_s(face))
    return Part(label=placed.label, shape=shape, face_labels=(Label(),) * len(own), unreadable=unreadable)


def _curve_part(placed: Placed, factor: float, source: str) -> Part:
    try:
        edge = curve_edge(placed.geometry)
        shape = edge if placed.matrix is None else put(edge, placed.matrix)
    except (ConversionError, Standard_Failure) as error:
        raise ReferenceFileError(
            f"'{source}' holds a curve that cannot be read (number {placed.place}"
            f"{f', {chr(39)}{placed.label.name}{chr(39)}' if placed.label.name else ''}: {error}): "
            "repair or rebuild it in Rhino and save again."
        ) from error
    return Part(label=placed.label, shape=scaled(shape, factor), face_labels=())


def _faces(rhino: Any, geometry: RhinoObject, factor: float) -> Faces | None:
    """The faces of a surface, polysurface or extrusion; None of what is none of these."""
    count = len(geometry.Faces) if isinstance(geometry, rhino.Brep) else 1
    try:
        if isinstance(geometry, rhino.Extrusion):
            geometry = geometry.ToBrep(True)
            if geometry is None:
                raise ConversionError("it is an extrusion that cannot be made a polysurface")
        if isinstance(geometry, rhino.Brep):
            return brep_faces(geometry, rhino, factor)
        if isinstance(geometry, rhino.Surface):
            return Faces(shape=surface_face(geometry), unreadable={})
    except (ConversionError, Standard_Failure) as error:
        return Faces(shape=None, unreadable=dict.fromkeys(range(count), str(error)))
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
    recognises=lambda head: RHINO_START.match(head) is not None,
    check=check_nothing,
    read=_read,
)
