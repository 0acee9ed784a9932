"""IGES files: entities with names, colours and levels, in whatever unit their header gives."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.IGESData import IGESData_IGESModel
from OCP.Standard import Standard_Failure

from cadpanel.brep.files.format import Format
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.files.units import unit_taken
from cadpanel.brep.files.xcaf import new_document, parts_of
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.brep.kernel.said import said_by
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError

# The start section's first line, in columns 73 to 80; and the terminate section's only one.
FIRST_LINE = re.compile(rb"[^\r\n]{72}S[ 0]{0,6}[01]\b")
LAST_LINE = re.compile(rb"S[ 0-9]{7}G[ 0-9]{7}D[ 0-9]{7}P[ 0-9]{7}[^\r\n]{0,40}T[ 0]{0,6}1\s*\Z")
MARGIN_BYTES = 256
# The units of IGES 5.3 (2.2.4.3.14) by their flags: the word here, and the names that flag 3 leaves them to.
UNITS = {
    1: ("inch", ("INCH", "IN")),
    2: ("millimetre", ("MM",)),
    4: ("foot", ("FT",)),
    5: ("mile", ("MI",)),
    6: ("metre", ("M",)),
    7: ("kilometre", ("KM",)),
    8: ("mil", ("MIL",)),
    9: ("micrometre", ("UM",)),
    10: ("centimetre", ("CM",)),
    11: ("microinch", ("UIN",)),
}
INCHES, MILLIMETRES, BY_NAME = 1, 2, 3
# Untrimmed surfaces: without one there is no face. Where a trimmed one fails, a face may be left, cut otherwise.
SURFACES = {114, 118, 120, 122, 128, 140, 190, 192, 194, 196, 198}


@dataclass(frozen=True, slots=True, kw_only=True)
class _Unit:
    """The unit as a word, whether the file itself says so, and what should be known of it."""

    word: str
    own: bool
    notes: tuple[str, ...] = ()


def _check(path: Path, text: bytes) -> None:
    if not LAST_LINE.search(text[-MARGIN_BYTES:]):
        raise ReferenceFileError(
            f"'{path.name}' breaks off before its end (the terminate section is missing): copy or export it again."
        )


def _read(path: Path, millimetres: float | None) -> Model:
    silence_kernel()
    document = new_document()
    reader = IGESCAFControl_Reader()
    for carry in (reader.SetNameMode, reader.SetColorMode, reader.SetLayerMode):
        carry(True)
    try:
        if reader.ReadFile(str(path)) != IFSelect_RetDone:
            raise ReferenceFileError(f"'{path.name}' is damaged: the CAD kernel cannot read it; export it again.")
        unit = _unit(path.name, reader.IGESModel(), millimetres)
        if not reader.Transfer(document):
            raise ReferenceFileError(
                f"'{path.name}' holds nothing that the CAD kernel can read: export the faces of the skin again."
            )
        lost = _lost(path.name, reader)
        parts = parts_of(document)
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({said_by(error)}): repair the reference and export it again."
        ) from error
    factor = 1.0 if unit.own or millimetres is None else millimetres
    return Model(
        source=path.name,
        format=IGES.name,
        unit=unit.word,
        own_unit=unit.own,
        parts=(*(replace(part, shape=scaled(part.shape, factor)) for part in parts), *lost),
        notes=unit.notes,
    )


def _unit(name: str, model: IGESData_IGESModel, millimetres: float | None) -> _Unit:
    """What the header says of the unit, and make the kernel read in it, or in mm where the user gives it.

    The flag counts, and the name where the flag is 3. Of a flag that is empty the kernel makes that of the name.
    """
    section = model.GlobalSection()
    flag, said = section.UnitFlag(), section.UnitName()
    called = "" if said is None else str(said.ToCString()).strip()
    named = next((number for number, (_, names) in UNITS.items() if called.upper() in names), None)
    if flag == BY_NAME and named is not None:
        flag = named
    # Of an empty name the kernel makes flag 1, whether the flag was 3, 0, or empty.
    says_nothing = flag == INCHES and not called
    if millimetres is not None and (flag not in UNITS or says_nothing):
        unit, flag = _Unit(word=unit_taken(millimetres), own=False), MILLIMETRES
    elif flag not in UNITS:
        what = f"that it calls '{called}'" if flag == BY_NAME else f"with the flag {flag}"
        raise ReferenceFileError(
            f"'{name}' is in a unit {what}, which IGES does not have: give the unit, or export it in millimetres."
        )
    else:
        unit = _Unit(word=UNITS[flag][0], own=not says_nothing)
        if says_nothing:
            note = f"'{name}' does not name its unit, which in IGES stands for inches: give the unit if that is wrong."
            unit = replace(unit, notes=(note,))
        elif called and named != flag:
            note = (
                f"'{name}' says by its unit flag that it is in the unit {unit.word}, and by name '{called}'; "
                "the flag counts."
            )
            unit = replace(unit, notes=(note,))
    section.SetUnitFlag(flag)
    model.SetGlobalSection(section)
    return unit


def _lost(name: str, reader: IGESCAFControl_Reader) -> tuple[Part, ...]:
    """The faces that the kernel cannot make, as parts that hold nothing else.

    Raises:
        ReferenceFileError: what it cannot make is no surface, so that a face may have been made without it.
    """
    checks, found = reader.WS().TransferReader().LastCheckList(), []
    checks.Start()
    while checks.More():
        if checks.Value().HasFailed():
            said = str(checks.Value().CFail(1)).strip().rstrip(".")
            entity = reader.IGESModel().Entity(checks.Number())
            if entity is None or entity.TypeNumber() not in SURFACES:
                raise ReferenceFileError(
                    f"'{name}' holds an entity that the CAD kernel cannot read (number {checks.Number()} of its "
                    f"directory: {said}): repair it and export the reference again."
                )
            why = f"the CAD kernel cannot make it (entity {checks.Number()} of the directory: {said})"
            found.append(Part(label=Label(), shape=compound_of([]), face_labels=(), unreadable={0: why}))
        checks.Next()
    return tuple(found)


IGES = Format(
    name="IGES",
    suffixes=(".iges", ".igs"),
    recognises=lambda head: FIRST_LINE.match(head) is not None,
    check=_check,
    read=_read,
)
