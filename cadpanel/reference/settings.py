"""How a reference is to be read, checked when it is made."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from numbers import Integral, Real
from pathlib import Path
from typing import Literal, TypedDict, get_args

from cadpanel.errors import SettingsError
from cadpanel.reference.texts import (
    BY_FITS,
    STRIPS,
    Auto,
    choices_of,
    parse_divide,
    parse_grid,
    parse_panel_size,
    parse_stations,
)
from cadpanel.setting import Option, Range, check_ranges, setting

By = Literal["length", "parameter"]
Seams = Literal["square", "level", "conjugate", "free"]

MILLIMETRES = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "dm": 100.0, "m": 1000.0, "in": 25.4, "ft": 304.8, "yd": 914.4}
"""What the units that may be given for a file without one have in mm."""
MOST_PANELS = 1_000_000
CUT_TURN = 15.0
WAYS = ("divide", "panel_length", "grid", "panel_size", "stations", "network", "mesh")
"""The ways to cut a surface into panels, of which one may be asked for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceSettings:
    """How to read a reference. Without a way to cut it, each product of the file is one panel.

    Attributes:
        seam_tolerance: how far panels that meet may lie apart in the file, mm.
        unit: of every file that has none (.brep, meshes): "mm", "cm", "m", "in", "ft" and so on.
        faces: which faces of the file are the skin, each "NAME", "name=NAME", "layer=LAYER", "color=#RRGGBB", a number
            or a range of numbers ("3", "2-5"), as `inspect` lists them; all faces if None. * stands for
            anything, and a name that is written so in the file counts before it.
        divide: cut each strip into so many panels of equal length; "auto" for as few as hold what is asked of a fit,
            "strips" for panels one after the other, each as wide as a largest deviation allows.
        panel_length: cut each strip into as few equal panels as are no longer than this along either long edge, mm.
        seams: with one of these two, "square" cuts the strip square to it; "level" at equal heights, in level planes;
            "conjugate" where panels can meet, as the surface bends, as near to square as `cut_turn` says. A fit holds
            seams where they were cut, within its limits on seams, and level ones in their planes; with "free", of any
            seams, it holds neither their turn nor how even and level they are, and strips are cut square.
        cut_turn: by how much a plane of conjugate seams may be turned from square, degrees.
        lip: with `divide` or `panel_length`, keep only a band of this width about the strip's lip, measured along the
            surface, mm.
        grid: cut each surface into so many by so many panels along its two parameters.
        panel_size: cut each surface into as few equal panels as are no larger than this along its parameters, mm.
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
        None, option=Option(metavar="UNIT", help="Unit of files that carry none (.brep, meshes): mm, cm, m, in, ft ...")
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
    divide: int | Auto | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: parse_divide(text),
            metavar="N|auto|strips",
            help="Cut each strip, or ring, into so many panels of equal length; auto: as few as hold what is asked; "
            "strips: each as wide as --max-deviation allows.",
        ),
    )
    panel_length: float | None = setting(
        None,
        option=Option(
            metavar="MM", help="Cut each strip, or ring, into as few equal panels as are no longer than this."
        ),
    )
    seams: Seams = setting(
        "square",
        option=Option(
            help="Cut strips square to them, in level planes, or where panels can meet as the surface bends, and keep "
            "seams there; or let them turn freely?"
        ),
    )
    cut_turn: float = setting(
        CUT_TURN,
        within=Range(what="turn of a cut", least=0.0, most=45.0, unit=" degrees"),
        option=Option(metavar="DEG", help="With --seams conjugate: how far a cut may be turned from square."),
    )
    lip: float | None = setting(
        None,
        option=Option(
            metavar="MM",
            help="With --divide or --panel-length: keep only a band of this width about the strip's lip.",
        ),
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
    panel_size: tuple[float, float] | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: parse_panel_size(text),
            metavar="UxV",
            help="Cut each surface into as few equal panels as are no larger than this, mm.",
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
        """Check every setting, and bring numbers, lists and paths into one form.

        Raises:
            SettingsError: a setting is out of its range, or contradicts another one.
        """
        check_ranges(self)
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
            ways = " and ".join(way.replace("_", " ") for way in asked)
            raise SettingsError(f"{ways} are ways to cut the same surface: choose one of them")
        if self.divide is not None and self.divide not in BY_FITS:
            _require_count("number of panels to divide a strip into", self.divide, least=1)
            object.__setattr__(self, "divide", int(self.divide))
        self._check_lengthwise()
        for name in ("seam_tolerance", "panel_length", "lip"):
            given = getattr(self, name)
            object.__setattr__(self, name, None if given is None else float(given))
        object.__setattr__(self, "grid", _grid(self.grid))
        object.__setattr__(self, "panel_size", _panel_size(self.panel_size))
        object.__setattr__(self, "stations", _stations(self.stations))
        if self.by is not None and self.grid is None and self.panel_size is None:
            raise SettingsError("'by' says how a grid is cut: give a grid, too, or the size of its panels")
        if not _is_switch(self.junctions):
            raise SettingsError(f"'junctions' is yes or no, True or False, not {self.junctions!r}")
        if self.spine is not None and self.stations is None:
            raise SettingsError("a spine is what stations are measured along: give stations, too")

    def _check_lengthwise(self) -> None:
        """Check what goes with a strip that is divided along its length."""
        lengthwise = self.divide is not None or self.panel_length is not None
        if self.panel_length is not None and not _is_positive(self.panel_length):
            raise SettingsError(f"the length of a panel must be a positive number of mm, not {self.panel_length!r}")
        if self.lip is not None:
            if not _is_positive(self.lip):
                raise SettingsError(f"the band about a lip must have a positive width in mm, not {self.lip!r}")
            if not lengthwise:
                raise SettingsError(
                    "a band about the lip is divided along its length: give the number of panels, too, or their length"
                )
        if self.divide == STRIPS and (self.lip is not None or self.seams not in ("square", "free")):
            raise SettingsError("strips are cut square to the whole surface: leave 'lip' and the kind of seams out")
        if self.seams not in get_args(Seams):
            raise SettingsError(
                f"seams are {', '.join(get_args(Seams)[:-1])} or {get_args(Seams)[-1]}, not {self.seams!r}"
            )
        if self.seams not in ("square", "free") and not lengthwise:
            raise SettingsError(
                f"{self.seams} seams part a strip that is divided along its length: give the number of panels, too, or "
                "their length"
            )
        if self.cut_turn != CUT_TURN and self.seams != "conjugate":
            raise SettingsError(
                "how far a cut may be turned from square counts for conjugate seams: ask for these, too"
            )

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


def _panel_size(value: object) -> tuple[float, float] | None:
    if value is None:
        return None
    sizes = tuple(value) if isinstance(value, Iterable) and not isinstance(value, str) else ()
    if len(sizes) != 2 or not all(map(_is_positive, sizes)):
        raise SettingsError(f"the size of a panel is two positive lengths in mm, like (1500, 800), not {value!r}")
    return float(sizes[0]), float(sizes[1])


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
    divide: int | Auto | None
    panel_length: float | None
    seams: Seams
    cut_turn: float
    lip: float | None
    grid: tuple[int, int] | None
    panel_size: tuple[float, float] | None
    by: By | None
    stations: Sequence[float] | None
    spine: str | Path | None
    network: str | Path | None
    mesh: str | Path | None
    junctions: bool
