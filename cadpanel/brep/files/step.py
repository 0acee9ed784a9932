"""STEP files: products with names, and what they say of single faces.

A panel is a product of the file. Assemblies are flattened. Programs differ in what they make of a compound of faces:
some write one product, some an assembly with a nameless product for each face; both are one panel here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from OCP.Standard import Standard_Failure

from cadpanel.brep.files.format import Format
from cadpanel.brep.files.model import Label, Model, NamedShape, Part, Products
from cadpanel.brep.files.names import call_panels
from cadpanel.brep.files.step_lost import LostFace, lost_faces
from cadpanel.brep.files.step_reader import StepFault, read_document
from cadpanel.brep.files.text_check import START, check_step_text, contents
from cadpanel.brep.files.units import unit_missing, unit_taken
from cadpanel.brep.files.xcaf import parts_of
from cadpanel.brep.kernel.said import said_by
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError


@dataclass(frozen=True, slots=True, kw_only=True)
class _Read:
    """What may be a panel each, mm; the file's unit; and the faces that the kernel cannot make."""

    parts: tuple[Part, ...]
    unit: str | None
    lost: tuple[LostFace, ...] = ()


def read_products(path: Path, millimetres: float | None = None) -> Products:
    """Return the file's panels.

    They are called as `call_panels` says. One of which a face cannot be read is left out.

    Args:
        path: the file.
        millimetres: how many the unit has, where the file says none; None for one.

    Raises:
        ReferenceFileError: the kernel cannot read the file, or none of its panels as a whole.
    """
    read = _parts(path, millimetres, labels=False)
    lost = {face.product for face in read.lost}
    parts = [part for part in read.parts if part.product not in lost]
    if read.lost and not (parts and lost <= {part.product for part in read.parts}):
        raise _unreadable(path.name, read.lost[0].said)
    names = call_panels([(part.product, part.instance) for part in parts])
    shapes = tuple(NamedShape(name, part.shape) for name, part in zip(names, parts, strict=True))
    notes = [unit_missing(path.name)] if read.unit is None and millimetres is None else []
    notes += [
        f"Panel '{face.product}' of '{path.name}' is left out, as a face of it cannot be read: {face.why}."
        for face in {face.product: face for face in read.lost}.values()
    ]
    return Products(source=path.name, shapes=shapes, unit=read.unit, notes=tuple(notes))


def read_plain_products(path: Path, count: int) -> tuple[tuple[Part, ...], str] | None:
    """The products of a file that holds so many, each of which may be a panel, and the file's unit of length.

    Returns:
        None where they are others, or anything must be said of the file.

    Raises:
        ReferenceFileError: the kernel cannot read it.
    """
    read = _parts(path, None, labels=False)
    if read.lost or read.unit is None or len(read.parts) != count:
        return None
    return read.parts, read.unit


def _read(path: Path, millimetres: float | None) -> Model:
    read = _parts(path, millimetres, labels=True)
    parts = _with_lost(read)
    if read.unit is not None:
        return Model(source=path.name, format=STEP.name, unit=read.unit, parts=parts)
    return Model(
        source=path.name,
        format=STEP.name,
        unit=unit_taken(millimetres),
        own_unit=False,
        parts=parts,
        notes=() if millimetres else (unit_missing(path.name),),
    )


def _with_lost(read: _Read) -> tuple[Part, ...]:
    """The parts, each with its unreadable faces after all others; what belongs to none is one more."""
    parts = list(read.parts)
    for face in read.lost:
        place = next((place for place, part in enumerate(parts) if part.product == face.product), len(parts))
        if place == len(parts):
            nothing = Part(label=Label(name=face.product), shape=compound_of([]), face_labels=(), product=face.product)
            parts.append(nothing)
        part = parts[place]
        number = len(part.face_labels) + len(part.unreadable)
        parts[place] = replace(part, unreadable={**part.unreadable, number: face.why})
    return tuple(parts)


def _parts(path: Path, millimetres: float | None, *, labels: bool) -> _Read:
    """What the file holds, with or without what it says beside names of products."""
    try:
        step = read_document(path, labels=labels)
        failures, lost = step.failures(), None
        if failures:
            lost = lost_faces(contents(path), step.reader.Reader().StepModel(), failures)
            if lost is None:
                raise _unreadable(path.name, failures[0].said)
        parts = parts_of(step.document, as_panels=True, labels=labels)
    except StepFault as error:
        why = f" ({error.fault}): export the reference" if error.fault else ": the CAD kernel cannot read it; export it"
        raise ReferenceFileError(f"'{path.name}' is damaged{why} again.") from error
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({said_by(error)}): repair the reference and export it again."
        ) from error
    unit = step.unit
    factor = 1.0 if unit is not None or millimetres is None else millimetres
    placed = tuple(replace(part, shape=scaled(part.shape, factor)) for part in parts)
    return _Read(parts=placed, unit=unit, lost=tuple(lost or ()))


def _unreadable(name: str, why: str) -> ReferenceFileError:
    return ReferenceFileError(
        f"'{name}' holds a shape that the CAD kernel cannot read ({why}): repair it and export the reference again."
    )


STEP = Format(
    name="STEP",
    suffixes=(".step", ".stp", ".p21"),
    recognises=lambda head: START in head,
    check=check_step_text,
    read=_read,
)
