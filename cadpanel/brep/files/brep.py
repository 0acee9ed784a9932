"""The kernel's own .brep files, as text or binary: shapes alone, without names and without a unit."""

from __future__ import annotations

import re
from pathlib import Path

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_COMPOUND, TopAbs_COMPSOLID, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.files.format import Format
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.files.units import no_unit, unit_taken
from cadpanel.brep.kernel.said import said_by
from cadpanel.brep.kernel.shapes import children, shapes_of
from cadpanel.brep.kernel.transforms import scaled
from cadpanel.errors import ReferenceFileError

TEXT = re.compile(rb"\s*(DBRep_DrawableShape|CASCADE Topology V\d)")
BINARY = re.compile(rb"\s*Open CASCADE Topology V\d")
# The last line of a text names the whole: its orientation, number and place. The kernel's console writes its own header
# before the text, and a 0 behind it: no more shapes follow.
LAST_LINE = re.compile(rb"[-+ie]\d+ \d+\s*(?:\n0\s*)?\Z")
MARGIN_BYTES = 64
GROUPS = (TopAbs_COMPOUND, TopAbs_COMPSOLID, TopAbs_SOLID, TopAbs_SHELL)
NOT_A_NUMBER = re.compile(rb"(?<=\s)[-+]?(?:nan|inf|infinity|1\.#\w+)(?=\s)", re.IGNORECASE)


def _check(path: Path, text: bytes) -> None:
    if BINARY.match(text):
        return
    if not LAST_LINE.search(text[-MARGIN_BYTES:]):
        raise ReferenceFileError(f"'{path.name}' breaks off before its end: copy or export it again.")
    found = NOT_A_NUMBER.search(text)
    if found is not None:
        raise ReferenceFileError(
            f"'{path.name}' holds a coordinate that is not a number ({found.group().decode()} in line "
            f"{text.count(bytes([10]), 0, found.start()) + 1}): repair the shape and write it again."
        )


def _read(path: Path, millimetres: float | None) -> Model:
    shape = TopoDS_Shape()
    try:
        with path.open("rb") as file:
            binary = BINARY.match(file.read(MARGIN_BYTES)) is not None
        done = BinTools.Read_s(shape, str(path)) if binary else BRepTools.Read_s(shape, str(path), BRep_Builder())
        if not done or shape.IsNull():
            raise ReferenceFileError(f"'{path.name}' is damaged: the CAD kernel cannot read it; write it again.")
        shape = scaled(shape, millimetres or 1.0)
    except (Standard_Failure, RuntimeError) as error:
        raise ReferenceFileError(
            f"'{path.name}' makes the CAD kernel fail ({said_by(error)}): repair the reference and write it again."
        ) from error
    notes = () if millimetres else (no_unit(path.name, ".brep"),)
    unit = unit_taken(millimetres)
    parts = tuple(
        Part(label=Label(), shape=part, face_labels=(Label(),) * len(shapes_of(part, TopAbs_FACE)))
        for part in _parts(shape)
    )
    return Model(source=path.name, format=BREP.name, unit=unit, own_unit=False, parts=parts, notes=notes)


def _parts(shape: TopoDS_Shape) -> list[TopoDS_Shape]:
    """A compound's members are parts, but for one of loose faces."""
    while shape.ShapeType() == TopAbs_COMPOUND:
        members = list(children(shape))
        if len(members) != 1:
            groups = [member for member in members if member.ShapeType() in GROUPS]
            return members if len(groups) == len(members) or not groups else [shape]
        shape = members[0]
    return [shape]


BREP = Format(
    name="BREP",
    suffixes=(".brep", ".brp"),
    recognises=lambda head: bool(TEXT.match(head) or BINARY.match(head)),
    check=_check,
    read=_read,
)
