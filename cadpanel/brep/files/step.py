"""STEP files: products with names, and what they say of single faces."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from OCP.Interface import Interface_Static
from OCP.Standard import Standard_Failure
from OCP.STEPCAFControl import STEPCAFControl_Reader

from cadpanel.brep.files.format import Format
from cadpanel.brep.files.model import Model
from cadpanel.brep.files.step_products import file_unit, transfer
from cadpanel.brep.files.text_check import START, check_step_text
from cadpanel.brep.files.units import unit_missing, unit_taken
from cadpanel.brep.files.xcaf import new_document, parts_of
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError

# The kernel's switch for names below products; off by default.
NAMES_OF_FACES = "read.stepcaf.subshapes.name"


def _read(path: Path, millimetres: float | None) -> Model:
    silence_kernel()
    document = new_document()
    reader = STEPCAFControl_Reader()
    Interface_Static.SetIVal_s(NAMES_OF_FACES, 1)
    try:
        transfer(path, document, reader)
        parts = parts_of(document, as_panels=True)
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({error}): repair the reference and export it again."
        ) from error
    finally:
        Interface_Static.SetIVal_s(NAMES_OF_FACES, 0)
    unit = file_unit(reader)
    if unit is not None:
        return Model(source=path.name, format=STEP.name, unit=unit, parts=parts)
    return Model(
        source=path.name,
        format=STEP.name,
        unit=unit_taken(millimetres),
        own_unit=False,
        parts=tuple(replace(part, shape=scaled(part.shape, millimetres or 1.0)) for part in parts),
        notes=() if millimetres else (unit_missing(path.name),),
    )


STEP = Format(
    name="STEP",
    suffixes=(".step", ".stp", ".p21"),
    recognises=lambda head: START in head,
    check=check_step_text,
    read=_read,
)
