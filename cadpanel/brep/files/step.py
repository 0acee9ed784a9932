"""STEP files: products with names, and what they say of single faces.

A panel is a product of the file. Assemblies are flattened. Programs differ in what they make of a compound of faces:
some write one product, some an assembly with a nameless product for each face; both are one panel here.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from OCP.Standard import Standard_Failure

from cadpanel.brep.files.format import Format
from cadpanel.brep.files.model import Model, NamedShape, Part, Products
from cadpanel.brep.files.names import call_panels
from cadpanel.brep.files.step_reader import StepFault, read_document
from cadpanel.brep.files.text_check import START, check_step_text
from cadpanel.brep.files.units import unit_missing, unit_taken
from cadpanel.brep.files.xcaf import parts_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError


def read_products(path: Path, millimetres: float | None = None) -> Products:
    """Return the file's panels.

    They are called as `call_panels` says.

    Args:
        path: the file.
        millimetres: how many the unit has, where the file says none; None for one.

    Raises:
        ReferenceFileError: the kernel cannot read the file, or only a part of it.
    """
    parts, unit = _parts(path, millimetres, labels=False)
    names = call_panels([(part.product, part.instance) for part in parts])
    shapes = tuple(NamedShape(name, part.shape) for name, part in zip(names, parts, strict=True))
    notes = (unit_missing(path.name),) if unit is None and millimetres is None else ()
    return Products(source=path.name, shapes=shapes, unit=unit, notes=notes)


def _read(path: Path, millimetres: float | None) -> Model:
    parts, unit = _parts(path, millimetres, labels=True)
    if unit is not None:
        return Model(source=path.name, format=STEP.name, unit=unit, parts=parts)
    return Model(
        source=path.name,
        format=STEP.name,
        unit=unit_taken(millimetres),
        own_unit=False,
        parts=parts,
        notes=() if millimetres else (unit_missing(path.name),),
    )


def _parts(path: Path, millimetres: float | None, *, labels: bool) -> tuple[tuple[Part, ...], str | None]:
    """What may be a panel each, mm, and the file's unit; with or without what the file says of them beside names."""
    try:
        step = read_document(path, labels=labels)
        failed = step.failed()
        parts = parts_of(step.document, as_panels=True, labels=labels) if failed is None else ()
    except StepFault as error:
        why = f" ({error.fault}): export the reference" if error.fault else ": the CAD kernel cannot read it; export it"
        raise ReferenceFileError(f"'{path.name}' is damaged{why} again.") from error
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({error}): repair the reference and export it again."
        ) from error
    if failed is not None:
        raise ReferenceFileError(
            f"'{path.name}' holds a shape that the CAD kernel cannot read ({failed}): "
            "repair it and export the reference again."
        )
    unit = step.unit
    factor = 1.0 if unit is not None or millimetres is None else millimetres
    return tuple(replace(part, shape=scaled(part.shape, factor)) for part in parts), unit


STEP = Format(
    name="STEP",
    suffixes=(".step", ".stp", ".p21"),
    recognises=lambda head: START in head,
    check=check_step_text,
    read=_read,
)
