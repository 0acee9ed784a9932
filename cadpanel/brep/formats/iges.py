"""IGES files: entities with names, colours and levels, in whatever unit their header gives."""

from __future__ import annotations

import re
from pathlib import Path

from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.Standard import Standard_Failure

from cadpanel.brep.formats.format import Format
from cadpanel.brep.formats.xcaf import new_document, parts_of
from cadpanel.brep.model import Model
from cadpanel.brep.silence import silence_kernel
from cadpanel.errors import ReferenceFileError

# The start section's first line, in columns 73 to 80; and the terminate section's only one.
FIRST_LINE = re.compile(rb"[^\r\n]{72}S[ 0]{0,6}[01]\b")
LAST_LINE = re.compile(rb"S[ 0-9]{7}G[ 0-9]{7}D[ 0-9]{7}P[ 0-9]{7}[^\r\n]{0,40}T[ 0]{0,6}1\s*\Z")
MARGIN_BYTES = 256
UNITS = {
    "IN": "inch",
    "INCH": "inch",
    "MM": "millimetre",
    "FT": "foot",
    "MI": "mile",
    "M": "metre",
    "KM": "kilometre",
    "MIL": "mil",
    "UM": "micrometre",
    "CM": "centimetre",
    "UIN": "microinch",
}


def _check(path: Path, text: bytes) -> None:
    if not LAST_LINE.search(text[-MARGIN_BYTES:]):
        raise ReferenceFileError(
            f"'{path.name}' breaks off before its end (the terminate section is missing): copy or export it again."
        )


def _read(path: Path, _millimetres: float | None) -> Model:
    silence_kernel()
    document = new_document()
    reader = IGESCAFControl_Reader()
    for carry in (reader.SetNameMode, reader.SetColorMode, reader.SetLayerMode):
        carry(True)
    try:
        if reader.ReadFile(str(path)) != IFSelect_RetDone:
            raise ReferenceFileError(f"'{path.name}' is damaged: the CAD kernel cannot read it; export it again.")
        word = str(reader.IGESModel().GlobalSection().UnitName().ToCString()).strip().upper()
        if not reader.Transfer(document):
            raise ReferenceFileError(
                f"'{path.name}' holds nothing that the CAD kernel can read: export the faces of the skin again."
            )
        _check_transfer(path.name, reader)
        parts = parts_of(document)
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({error}): repair the reference and export it again."
        ) from error
    if word not in UNITS:
        raise ReferenceFileError(
            f"'{path.name}' is in a unit that it calls '{word}', which IGES does not have: export it in millimetres."
        )
    return Model(source=path.name, format=IGES.name, unit=UNITS[word], parts=parts)


def _check_transfer(name: str, reader: IGESCAFControl_Reader) -> None:
    """Refuse what was read only in part."""
    checks = reader.WS().TransferReader().LastCheckList()
    checks.Start()
    while checks.More():
        if checks.Value().HasFailed():
            said = str(checks.Value().CFail(1)).strip().rstrip(".")
            raise ReferenceFileError(
                f"'{name}' holds an entity that the CAD kernel cannot read (number {checks.Number()} of its directory: "
                f"{said}): repair it and export the reference again."
            )
        checks.Next()


IGES = Format(
    name="IGES",
    suffixes=(".iges", ".igs"),
    recognises=lambda head: FIRST_LINE.match(head) is not None,
    check=_check,
    read=_read,
)
