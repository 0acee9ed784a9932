"""What a FreeCAD document is made of: objects in groups, with typed properties that users read and do not change.

A kind of property is one class: its type's name in FreeCAD, and its value as FreeCAD writes it. Types are those that
FreeCAD 0.20 knows; a mass is a number there. Lengths are millimetres, angles degrees, as FreeCAD keeps them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from cadpanel.delivery.schedule.csv_text import Row

Color = tuple[float, float, float]
NumberKind = Literal["Length", "Distance", "Angle", "Area", "Volume", "Float"]
"""A distance may be negative, a length may not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Property:
    """A property of an object.

    Attributes:
        name: its identifier, in which every word begins with a capital: FreeCAD shows it as words.
        group: the heading under which it is shown.
        tip: what it is, in a few words.
    """

    name: str
    group: str
    tip: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Number(Property):
    """A quantity."""

    kind: NumberKind
    value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Words(Property):
    """A text."""

    value: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Lines(Property):
    """Several texts."""

    value: Sequence[str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Yes(Property):
    """A yes or no."""

    value: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Place(Property):
    """A point, mm."""

    value: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice(Property):
    """One of several texts, the only kind of property that users may change."""

    options: Sequence[str]
    value: str


AnyProperty = Number | Words | Lines | Yes | Place | Choice


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """How an object is shown.

    Attributes:
        visible: whether it is.
        faces, lines: colours, sRGB; None for FreeCAD's own.
        line_width: in pixels; None for FreeCAD's own.
    """

    visible: bool = True
    faces: Color | None = None
    lines: Color | None = None
    line_width: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """A folder in the tree.

    Attributes:
        name: its identifier in the document.
        label: what users read.
        parent: the group in which it stands; None at the top.
        look: how it is shown; groups of hidden objects are hidden.
        properties: its own.
    """

    name: str
    label: str
    parent: str | None = None
    look: Look = field(default_factory=Look)
    properties: Sequence[AnyProperty] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Body(Group):
    """An object with a shape.

    Attributes:
        file: name of the file in the archive that holds the shape.
    """

    file: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet(Group):
    """A spreadsheet.

    Attributes:
        cells: the rows.
    """

    cells: Sequence[Row]


DocumentObject = Group | Body | Sheet
