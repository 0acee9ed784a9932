"""The drawings that a delivery's numbers and settings ask for, and whether a file holds just that.

What is cut and where it bends is measured by the proof of drawings. Here the rest shows: words, marks, layers, how
contours are written, and how finely arcs and rulings stand.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.drawing.dxf import MARK, Frame, dxf_bytes
from cadpanel.delivery.drawing.entities import Drawing, Entity, moved
from cadpanel.delivery.drawing.layout import in_rows
from cadpanel.delivery.drawing.part import part_drawings
from cadpanel.delivery.records.flat_parts import ALL
from cadpanel.delivery.shop_settings import DxfEntities

SAME_NUMBER = 1e-6
"""Millimetres, degrees or bulge by which a number may differ that another processor has worked out."""
_NO_FRAME = Frame("", "", "")
_OWNER = re.compile(rb"(\r\n330\r\n)[^\r]*")
_NUMBERS = {str(code) for code in range(10, 60)}


def drawings_of(contents: Contents) -> dict[str, Drawing]:
    """Every drawing by its file's name without the ending; the last one has all parts in rows."""
    drawings = part_drawings(contents.parts, contents.records, contents.seams, contents.sheet, contents.shop)
    rows = zip(drawings, in_rows(drawings), strict=True)
    together = tuple(entity for drawing, shift in rows for entity in moved(drawing, shift))
    own = {part.blank.file: drawing for part, drawing in zip(contents.parts, drawings, strict=True)}
    return {**own, ALL: together}


def digest_of(file: bytes) -> str:
    """By which a file is known again while it is proved."""
    return hashlib.sha256(file).hexdigest()


def holds(found: bytes, drawing: Sequence[Entity], entities: DxfEntities) -> bool:
    """Whether the entities of a file are those of a drawing, one after the other.

    Args:
        found: the text of its entities.
        drawing: what it is to hold.
        entities: how contours are to be written.
    """
    wanted = dxf_bytes(drawing, _NO_FRAME, entities).removeprefix(MARK)
    one, other = (_OWNER.sub(rb"\1", text) for text in (found, wanted))
    return one == other or _alike(one.decode("cp1252").split("\r\n"), other.decode("cp1252").split("\r\n"))


def _alike(one: list[str], other: list[str]) -> bool:
    """Whether lines are the same in turn, but for the last digits of numbers; each has its code in the line before."""
    if len(one) != len(other):
        return False
    codes = ["", *one[:-1]]
    return all(
        a == b or (code.strip() in _NUMBERS and _near(a, b)) for code, a, b in zip(codes, one, other, strict=True)
    )


def _near(one: str, other: str) -> bool:
    try:
        return abs(float(one) - float(other)) <= SAME_NUMBER
    except ValueError:
        return False
