"""What every way to cut a surface gives: named panels of faces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array
from cadpanel.brep.kernel.shapes import compound_of

FEWEST_DIGITS = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class CutPanel:
    """One panel: its name, which says where it sits, and its faces."""

    name: str
    faces: tuple[TopoDS_Face, ...]


def middle_of(faces: Iterable[TopoDS_Face]) -> Array:
    """(3,) the centre of gravity of all edges of faces, mm: a middle for which no area must be integrated."""
    properties = GProp_GProps()
    BRepGProp.LinearProperties_s(compound_of(faces), properties)
    return np.array(properties.CentreOfMass().Coord())


def along_name(surface: str, place: int, count: int) -> str:
    """The name of the panel at a place, from 0, of so many along a strip: "S1-03"."""
    return f"{surface}-{_padded(place, count)}"


def grid_name(surface: str, row: int, column: int, counts: tuple[int, int]) -> str:
    """The name of the panel in a row and column, from 0: "S1-R02-C05"."""
    return f"{surface}-R{_padded(row, counts[0])}-C{_padded(column, counts[1])}"


def along_panels(surface: str, groups: Sequence[Sequence[TopoDS_Face]]) -> tuple[CutPanel, ...]:
    """Panels that follow each other along a strip."""
    return tuple(
        CutPanel(name=along_name(surface, place, len(groups)), faces=tuple(faces)) for place, faces in enumerate(groups)
    )


def _padded(place: int, count: int) -> str:
    return str(place + 1).zfill(max(FEWEST_DIGITS, len(str(count))))
