"""How a reference is to be read, checked when it is made."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from numbers import Integral, Real
from pathlib import Path
from typing import Literal, TypedDict, get_args

from cadpanel.errors import SettingsError
from cadpanel.setting import Option, setting

By = Literal["length", "parameter"]

MILLIMETRES = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "dm": 100.0, "m": 1000.0, "in": 25.4, "ft": 304.8, "yd": 914.4}
"""What the units that may be given for a file without one have in mm."""
MOST_PANELS = 1_000_000
WAYS = ("divide", "grid", "stations", "network", "mesh")
"""The ways to cut a surface into panels, of which one may be asked for."""

# One choice of faces and the comma behind it: what holds a comma stands in quotation marks, "" for one of them.
CHOICE = re.compile(
    r'\s*(?:(?P<key>\w+\s*=\s*)?"(?P<quoted>(?:[^"]|"")*)"|(?P<bare>(?!\w+\s*=\s*")[^",][^,]*|))\s*(?:,|$)'
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceSettings:
    """How to read a reference. Without a way to cut it, each product of the file is one panel.

    Attributes:
        seam_tolerance: how far panels that meet may lie apart in the file, mm.
        unit: of every file that has none (.brep, meshes): "mm", "cm", "m", "in", "ft" and so on.
        faces: which faces of the file are the skin, each "NAME", "name=NAME", "layer=LAYER", "color=#RRGGBB", a number
            or a range of numbers ("3", "2-5"), as `inspect` lists them; all faces if None. * stands for
            anything, and a name that is written so in the file counts before it.
        divide: cut each strip into so many panels of equal length.
        lip: with `divide`, keep only a band of this width about the strip's lip, measured along the surface, mm.
        grid: cut each surface into so many by so many panels along its two parameters.
        by: are the parts of a grid equal in length or in parameter? In length if None.
        stations: cut by planes at these lengths along the strip or the spine, mm.
        spine: a file with the curve along which the stations are measured; the middle of the strip if None.
        network: a file with curves that cut the surface; the reference itself if its own loose curves do.
        mesh: an OBJ or OFF file whose faces become panels.
        junctions: part the sides of panels where corners of others lie on them, as in a brick bond?
    """

    seam_tolerance: float = setting(
        1.0, option=Option(metavar="MM", help="How far panels that meet may lie apart in the file.")
    )
    unit: str | None = setting(
        None, option=Option(metavar="UNIT", help="Of every file that has none (.brep, meshes): m, in ...")
    )
    faces: tuple[str, ...] | None = setting(
        None,
        option=Option(
            takes=str,
            metavar="CHOICE,...",
            help="Which faces are the skin: 3, 2-5, NAME, layer=NAME, color=#RRGGBB; see 'cadpanel inspect'. "
            """A name with a comma stands in double quotes: '"Roof, north",layer="Skin, east"'.""",
        ),
    )
    divide: int | None = setting(
        None, option=Option(metavar="N", help="Cut each strip, or ring, into so many panels of equal length.")
    )
    lip: float | None = setting(
        None,
        option=Option(metavar="MM", help="With --divide: keep only a band of this width about the strip's lip."),
    )
    grid: tuple[int, int] | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: parse_grid(text),
            metavar="UxV",
            help="Cut each surface into so many by so many panels.",
        ),
    )
    by: By | None = setting(
        None, option=Option(help="Are the grid's parts equal in length or in parameter? In length if not given.")
    )
    stations: tuple[float, ...] | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: parse_stations(text),
            metavar="MM,MM,...",
            help="Cut by planes at these lengths along the strip.",
        ),
    )
    spine: Path | None = setting(
        None, option=Option(metavar="FILE", help="Measure the stations along the curve in this file.")
    )
    network: Path | None = setting(
        None,
        option=Option(metavar="FILE", help="Cut along the curves in this file; it may be the reference itself."),
    )
    mesh: Path | None = setting(None, option=Option(metavar="FILE", help="One panel a face of this OBJ or OFF mesh."))
    junctions: bool = setting(
        False,
        option=Option(
            help="Part sides where corners of other panels lie on them, as in a brick bond; goes with planar-polygon.",
        ),
    )

    def __post_init__(self) -> None:
        """Check every setting, and bring lists and paths into one form.

        Raises:
            SettingsError: a setting is out of its range, or contradicts another one.
        """
        if not _is_positive(self.seam_tolerance):
            raise SettingsError(f"The seam tolerance must be a positive length in mm, not {self.seam_tolerance!r}.")
        if self.unit is not None and str(self.unit) not in MILLIMETRES:
            raise SettingsError(f"there is no unit '{self.unit}'; choose one of: {', '.join(MILLIMETRES)}")
        if self.by is not None and self.by not in get_args(By):
            raise SettingsError(f"a grid is cut by length or by parameter, not by {self.by!r}")
        for name in ("spine", "network", "mesh"):
            given = getattr(self, name)
            object.__setattr__(self, name, None if given is None else file_named(given, name))
        object.__setattr__(self, "faces", _words(self.faces))
        asked = [way for way in WAYS if getattr(self, way) is not None]
        if len(asked) > 1:
            raise SettingsError(f"{' and '.join(asked)} are ways to cut the same surface: choose one of them")
        if self.divide is not None:
            _require_count("number of panels to divide a strip into", self.divide, least=1)
        object.__setattr__(self, "grid", _grid(self.grid))
        object.__setattr__(self, "stations", _stations(self.stations))
        if self.lip is not None:
            if not _is_positive(self.lip):
                raise SettingsError(f"the band about a lip must have a positive width in mm, not {self.lip!r}")
            if self.divide is None:
                raise SettingsError("a band about the lip is divided along its length: give the number of panels, too")
        if self.by is not None and self.grid is None:
            raise SettingsError("'by' says how a grid is cut: give a grid, too")
        if not _is_switch(self.junctions):
            raise SettingsError(f"'junctions' is yes or no, True or False, not {self.junctions!r}")
        if self.spine is not None and self.stations is None:
            raise SettingsError("a spine is what stations are measured along: give stations, too")

    @property
    def way(self) -> str | None:
        """Which way the surface is to be cut, None for not at all."""
        return next((way for way in WAYS if getattr(self, way) is not None), None)

    def beside(self, reference: Path) -> Path | None:
        """The file that is read beside a reference to cut it; None where there is none, or it is the reference."""
        file = self.spine or self.network or self.mesh
        return None if file is None or os.path.realpath(file) == os.path.realpath(reference) else file

    @property
    def millimetres(self) -> float | None:
        """How many mm the given unit has, None where none is given."""
        return None if self.unit is None else MILLIMETRES[self.unit]


def file_named(value: object, what: str) -> Path:
    """The file that a name stands for.

    Args:
        value: the name, a string or a path.
        what: the file's part in the reading, for messages ("network").

    Raises:
        SettingsError: it is nothing that the kernel could open.
    """
    name = os.fspath(value) if isinstance(value, str | os.PathLike) else value
    if not isinstance(name, str) or not name or "\0" in name:
        raise SettingsError(f"the {what} must be the name of a file, not {value!r}")
    if name.encode(errors="ignore").decode() != name:
        raise SettingsError(f"the name of the {what}, {name!r}, is not UTF-8: rename the file")
    return Path(name)


def choices_of(text: str, what: str = "faces") -> tuple[str, ...]:
    """The choices in a text with commas between them: '3, layer="Skin, north"' are 3 and layer=Skin, north.

    Args:
        text: as users write it.
        what: is chosen, for messages.

    Raises:
        SettingsError: a quotation mark is not closed, or something follows it.
    """
    found, start = [], 0
    while start <= len(text):
        choice = CHOICE.match(text, start)
        if choice is None:
            raise SettingsError(
                f"{what}: the quotation marks in {text!r} do not enclose one choice each; write them like "
                '\'"Roof, north",layer="Skin, east",3\''
            )
        quoted = choice["quoted"]
        found.append(choice["bare"] if quoted is None else (choice["key"] or "") + quoted.replace('""', '"'))
        start = choice.end() if choice[0].endswith(",") else len(text) + 1
    return tuple(found)


def parse_grid(text: str) -> tuple[int, int]:
    """Two numbers of panels from "20x10".

    Raises:
        SettingsError: the text is not of that form.
    """
    found = re.fullmatch(r"\s*(\d{1,7})\s*[xX]\s*(\d{1,7})\s*", text)
    if found is None:
        raise SettingsError(f"--grid is two numbers of panels like 20x10, not '{text}'.")
    return int(found[1]), int(found[2])


def parse_stations(text: str) -> tuple[float, ...]:
    """Lengths from "1200,2400,3600".

    Raises:
        SettingsError: one of them is no number.
    """
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError:
        raise SettingsError(f"--stations are lengths in mm like 1200,2400,3600, not '{text}'.") from None


def choice_named(word: str) -> str:
    """How a name or layer is written among choices."""
    found = CHOICE.fullmatch(word)
    return word if found is not None and found["bare"] == word else '"{}"'.format(word.replace('"', '""'))


def _is_switch(value: object) -> bool:
    """True and False count as numbers in Python, but nobody means them so."""
    return isinstance(value, bool)


def _is_positive(value: object) -> bool:
    return not _is_switch(value) and isinstance(value, Real) and 0.0 < float(value) < math.inf


def _require_count(what: str, value: object, least: int) -> None:
    if _is_switch(value) or not isinstance(value, Integral) or not least <= int(value) <= MOST_PANELS:
        raise SettingsError(f"the {what} must be a whole number from {least} to {MOST_PANELS}, not {value!r}")


def _words(value: object) -> tuple[str, ...] | None:
    if value is None:
        return None
    given = choices_of(value) if isinstance(value, str) else value
    words = tuple(str(word).strip() for word in given) if isinstance(given, Iterable) else ()
    if not words or not all(words):
        raise SettingsError(f"faces are chosen by names, layers, colors or numbers, not by {value!r}")
    return words


def _grid(value: object) -> tuple[int, int] | None:
    if value is None:
        return None
    counts = tuple(value) if isinstance(value, Iterable) and not isinstance(value, str) else ()
    if len(counts) != 2:
        raise SettingsError(f"a grid is two numbers of panels, like (20, 10), not {value!r}")
    for count in counts:
        _require_count("number of panels along a side of the grid", count, least=1)
    if int(counts[0]) * int(counts[1]) > MOST_PANELS:
        raise SettingsError(f"a grid may have {MOST_PANELS} panels, not {int(counts[0]) * int(counts[1])}")
    return int(counts[0]), int(counts[1])


def _stations(value: object) -> tuple[float, ...] | None:
    if value is None:
        return None
    given = list(value) if isinstance(value, Iterable) and not isinstance(value, str) else []
    if not given or not all(_is_positive(place) for place in given):
        raise SettingsError(f"stations are positive lengths along the strip in mm, like (1200, 2400), not {value!r}")
    places = tuple(float(place) for place in given)
    if any(second <= first for first, second in pairwise(places)):
        raise SettingsError("stations must rise from one to the next")
    return places


class ReferenceKeywords(TypedDict, total=False):
    """The fields of `ReferenceSettings` as keywords, which type checkers want written out; a test holds them alike."""

    seam_tolerance: float
    unit: str | None
    faces: str | Sequence[str] | None
    divide: int | None
    lip: float | None
    grid: tuple[int, int] | None
    by: By | None
    stations: Sequence[float] | None
    spine: str | Path | None
    network: str | Path | None
    mesh: str | Path | None
    junctions: bool
