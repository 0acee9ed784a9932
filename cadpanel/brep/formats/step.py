"""STEP files: products with names, and what they say of single faces."""

from __future__ import annotations

from pathlib import Path

from OCP.Interface import Interface_Static
from OCP.Standard import Standard_Failure
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TColStd import TColStd_SequenceOfAsciiString

from cadpanel.brep.file_check import START, check_step_text
from cadpanel.brep.formats.format import Format
from cadpanel.brep.formats.xcaf import new_document, parts_of
from cadpanel.brep.model import Model
from cadpanel.brep.products import transfer
from cadpanel.brep.silence import silence_kernel
from cadpanel.errors import ReferenceFileError

# The kernel's switch for names below products; off by default.
NAMES_OF_FACES = "read.stepcaf.subshapes.name"


def _read(path: Path, _millimetres: float | None) -> Model:
    silence_kernel()
    document = new_document()
    reader = STEPCAFControl_Reader()
    Interface_Static.SetIVal_s(NAMES_OF_FACES, 1)
    try:
        transfer(path, document, reader)
        parts = parts_of(document)
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({error}): repair the reference and export it again."
        ) from error
    finally:
        Interface_Static.SetIVal_s(NAMES_OF_FACES, 0)
    return Model(source=path.name, format=STEP.name, unit=_unit(reader), parts=parts)


def _unit(reader: STEPCAFControl_Reader) -> str:
    """The file's units of length, in its own words."""
    lengths, angles, solid_angles = (TColStd_SequenceOfAsciiString() for _ in range(3))
    reader.Reader().FileUnits(lengths, angles, solid_angles)
    words = {str(lengths.Value(index).ToCString()).lower() for index in range(1, lengths.Length() + 1)}
    return " and ".join(sorted(words)) or "millimetre"


STEP = Format(
    name="STEP",
    suffixes=(".step", ".stp", ".p21"),
    recognises=lambda head: START in head,
    check=check_step_text,
    read=_read,
)
