"""What the shop gets besides the solids, and what its machines and its store take: checked when it is made."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, TypedDict, get_args

from cadpanel.errors import SettingsError
from cadpanel.geometry.limits import LEAST_DISTANCE, LEAST_PITCH
from cadpanel.reference.texts import choices_of
from cadpanel.setting import Option, Range, check_ranges, require, setting

Origin = Literal["local", "keep"]
DxfEntities = Literal["polyline", "lines"]
MeshColours = Literal["feature", "deviation"]
LAYERS = ("CUT", "BEND", "ROLL", "MARK", "INFO")
"""What a flat pattern is drawn of: contour, tangent and centre lines of bends, rulings, marks, and what is no mark."""
_SHEET = re.compile(r"\s*(\d+(?:\.\d+)?)\s*[xX]\s*(\d+(?:\.\d+)?)\s*")
_RETURNS = re.compile(r"\s*(\d+(?:\.\d+)?)\s*@\s*(\d+(?:\.\d+)?)\s*")
_FIXINGS = re.compile(r"\s*(\d+(?:\.\d+)?)\s*@\s*(\d+(?:\.\d+)?)\s*,\s*(\d+(?:\.\d+)?)\s*")
_NO_LAYER = re.compile(r'[<>/\\":;?*|=`,\x00-\x1f]')
_LONGEST_LAYER = 255
_LONGEST_WORDS = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class ShopSettings:
    """What is delivered, of which panels, and how flat patterns and schedules are made.

    Attributes:
        outputs: names of outputs; None for all that are made unasked.
        only: names of the panels to deliver, * for anything; all if empty.
        origin: where STEP files lie of a model far away: near their own origin, or where the model lies.
        k_factor: distance of the surface that keeps its lengths from a bend's inner face, a share of the thickness.
        chord: how far arcs in a drawing may lie from the exact contour, mm.
        roll_pitch: largest distance between two rulings of a bend, mm.
        dxf_entities: "polyline": the contour is one polyline with bulges; "lines": lines and arcs.
        dxf_layers: names for some of LAYERS, pairs of one of them and the name that it gets.
        dxf_contour_only: draw what is cut, and nothing else.
        dxf_name_length: longest name of a drawing's file, without its ending.
        density: of the sheet's material, kg/m3.
        stock: sheets that the store has, length and width, mm.
        facet_height: how far a bend that is pressed in facets may lie from the round one, mm.
        mesh_chord: how far the triangles of meshes may lie from the exact faces, mm.
        mesh_colours: what colours of meshes tell: "feature" or "deviation".
        material: what the sheet is made of, as files and drawings name it; empty to name nothing.
        author, organization: who files are from; empty to name nobody.
        fixings: fixing holes along edges: their diameter, largest pitch, and distance from the edge, mm; None for none.
        returns: legs folded inwards along straight edges of flat parts: their length on the outer face, and the inner
            radius of the fold, mm; None for none.
    """

    outputs: str | Sequence[str] | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: choices_of(text, "outputs"),
            metavar="NAME,...",
            help="What to write besides report.json: step, flats, schedule, setting-out, glb, html, freecad, xlsx, "
            "pdf, ifc; all but the last three if not given.",
        ),
    )
    only: str | Sequence[str] = setting(
        (),
        option=Option(
            takes=str,
            read=lambda _, text: choices_of(text, "panels"),
            metavar="NAME,...",
            help="Deliver only these panels, with commas between names and * for anything (NW-0*); all are fitted.",
            told=False,
        ),
    )
    origin: Origin = setting(
        "local", option=Option(help="STEP files of a model on a map: near their own origin, or where the model lies?")
    )
    k_factor: float = setting(
        0.5,
        within=Range(what="K-factor", least=0.0, most=1.0),
        option=Option(
            metavar="SHARE", help="Where the sheet keeps its lengths: a share of it, from the bends' inner face."
        ),
    )
    chord: float = setting(
        0.01,
        within=Range(what="chord tolerance", least=1e-3, most=10.0, unit=" mm"),
        option=Option(metavar="MM", help="How far arcs in drawings may lie from the exact contour."),
    )
    roll_pitch: float = setting(
        50.0,
        within=Range(what="pitch of the rulings", least=1.0, unit=" mm"),
        option=Option(metavar="MM", help="Largest distance between rulings drawn in a bend."),
    )
    dxf_entities: DxfEntities = setting(
        "polyline", option=Option(help="Contours as one polyline with bulges, or as lines and arcs?")
    )
    dxf_layers: Sequence[tuple[str, str]] = setting(
        (),
        option=Option(
            takes=str,
            read=lambda _, text: layers_of(text),
            metavar="CUT=NAME,...",
            help=f"Other names for the layers {', '.join(LAYERS)}.",
            told=False,
        ),
    )
    dxf_contour_only: bool = setting(False, option=Option(help="Draw what is cut, and nothing else."))
    dxf_name_length: int = setting(
        80,
        within=Range(what="longest name of a drawing", least=8, most=120, whole=True),
        option=Option(metavar="N", help="Longest name of a drawing's file, without its ending."),
    )
    density: float = setting(
        2700.0,
        within=Range(what="density", least=1.0, most=30_000.0, unit=" kg/m3"),
        option=Option(metavar="KG/M3", help="Of the sheet's material; aluminium if not given."),
    )
    stock: Sequence[tuple[float, float]] = setting(
        (),
        option=Option(
            takes=str,
            read=lambda _, text: stock_of(text),
            metavar="AxB,...",
            help="Sheets that the store has, in mm; panels that fit none are named.",
            told=False,
        ),
    )
    facet_height: float = setting(
        0.5,
        within=Range(what="facet height", least=1e-3, most=100.0, unit=" mm"),
        option=Option(metavar="MM", help="How far a bend pressed in facets may lie from the round one."),
    )
    mesh_chord: float = setting(
        0.5,
        within=Range(what="chord tolerance of meshes", least=1e-3, most=10.0, unit=" mm"),
        option=Option(metavar="MM", help="How far triangles of meshes may lie from the exact faces."),
    )
    mesh_colours: MeshColours = setting("feature", option=Option(help="What do colours of meshes tell?"))
    material: str = setting(
        "", option=Option(metavar="NAME", help="What the sheet is made of, as files name it.", told=False)
    )
    author: str = setting("", option=Option(metavar="NAME", help="Who the STEP files say they are from.", told=False))
    organization: str = setting(
        "", option=Option(metavar="NAME", help="Firm that STEP files name beside their author.", told=False)
    )

    fixings: Sequence[float] | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: fixings_of(text),
            metavar="D@PITCH,EDGE",
            help="Fixing holes: diameter, largest pitch, and distance of their middles from the edge, mm.",
        ),
    )

    returns: Sequence[float] | None = setting(
        None,
        option=Option(
            takes=str,
            read=lambda _, text: returns_of(text),
            metavar="MM@RADIUS",
            help="Fold straight edges of flat parts inwards: length on the outer face, and inner radius.",
        ),
    )

    def __post_init__(self) -> None:
        """Check every setting, and bring those of several parts into one form.

        Raises:
            SettingsError: a setting is out of range; the message says which and what it may be.
        """
        check_ranges(self)
        if self.dxf_entities not in get_args(DxfEntities):
            raise SettingsError(f"contours are drawn as polyline or lines, not as {self.dxf_entities!r}")
        if self.mesh_colours not in get_args(MeshColours):
            raise SettingsError(f"colours of meshes tell feature or deviation, not {self.mesh_colours!r}")
        if self.origin not in get_args(Origin):
            raise SettingsError(f"the origin is local or kept ('keep'), not {self.origin!r}")
        if not isinstance(self.dxf_contour_only, bool):
            raise SettingsError(f"'dxf_contour_only' is yes or no, True or False, not {self.dxf_contour_only!r}")
        if self.outputs is not None:
            object.__setattr__(self, "outputs", _names("outputs", self.outputs))
        object.__setattr__(self, "only", _names("panels", self.only) if self.only else ())
        object.__setattr__(self, "dxf_layers", _checked_layers(self.dxf_layers))
        for what in ("material", "author", "organization"):
            _check_words(what, getattr(self, what))
        object.__setattr__(self, "fixings", None if self.fixings is None else _checked_fixings(self.fixings))
        object.__setattr__(self, "returns", None if self.returns is None else _checked_returns(self.returns))
        object.__setattr__(self, "stock", tuple(_checked_sheet(sheet) for sheet in self.stock))

    def layer(self, role: str) -> str:
        """The name of a layer."""
        return dict(self.dxf_layers).get(role, role)


def stock_of(text: str) -> tuple[tuple[float, float], ...]:
    """Sheets from "1500x3000,2000x4000".

    Raises:
        SettingsError: the text is not of that form.
    """
    found = [_SHEET.fullmatch(part) for part in text.split(",")]
    if not all(found):
        raise SettingsError(f"sheets of the stock are written like 1500x3000,2000x4000, not {text!r}")
    return tuple((float(sheet[1]), float(sheet[2])) for sheet in found if sheet is not None)


def fixings_of(text: str) -> tuple[float, ...]:
    """Diameter, pitch and distance from the edge from "6.5@400,20".

    Raises:
        SettingsError: the text is not of that form.
    """
    found = _FIXINGS.fullmatch(text)
    if found is None:
        raise SettingsError(
            f"fixing holes are written like 6.5@400,20 (diameter, pitch, distance from edges), not {text!r}"
        )
    return tuple(map(float, found.groups()))


def returns_of(text: str) -> tuple[float, ...]:
    """Length and inner radius from "30@3".

    Raises:
        SettingsError: the text is not of that form.
    """
    found = _RETURNS.fullmatch(text)
    if found is None:
        raise SettingsError(f"returns are written like 30@3, length and inner radius, not {text!r}")
    return tuple(map(float, found.groups()))


def layers_of(text: str) -> tuple[tuple[str, str], ...]:
    """Names of layers from "CUT=0,BEND=V-groove".

    Raises:
        SettingsError: the text is not of that form.
    """
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(equals for _, equals, _ in pairs):
        raise SettingsError(f"names of layers are written like CUT=0,BEND=Folds, not {text!r}")
    return tuple((role.strip(), name.strip()) for role, _, name in pairs)


def _check_words(what: str, given: object) -> None:
    if not isinstance(given, str) or len(given) > _LONGEST_WORDS or not (given.isprintable() or not given):
        raise SettingsError(f"the {what} is a line of at most {_LONGEST_WORDS} characters, not {given!r}")


def _names(what: str, given: object) -> tuple[str, ...]:
    words = choices_of(given, what) if isinstance(given, str) else given
    found = tuple(str(word).strip() for word in words) if isinstance(words, Iterable) else ()
    if not found or not all(found):
        raise SettingsError(f"{what} are chosen by their names, not by {given!r}")
    return found


def _checked_layers(given: object) -> tuple[tuple[str, str], ...]:
    pairs = tuple(map(tuple, given)) if isinstance(given, Iterable) and not isinstance(given, str) else ()
    for role, name in pairs:
        if role not in LAYERS:
            raise SettingsError(f"there is no layer '{role}' to name; the layers are {', '.join(LAYERS)}")
        if not isinstance(name, str) or not 0 < len(name) <= _LONGEST_LAYER or _NO_LAYER.search(name):
            raise SettingsError(
                f"'{name}' is no name for a layer: leave out signs like / \\ : ; < > ? * | = and quotes"
            )
    if len(dict(pairs)) != len(pairs):
        raise SettingsError("a layer has one name: give it once")
    cut, *others = (dict(pairs).get(role, role).casefold() for role in LAYERS)
    if cut in others:
        raise SettingsError(f"what is cut needs a layer of its own, and '{cut}' is that of something else, too")
    return pairs


def _checked_sheet(given: object) -> tuple[float, float]:
    sides = tuple(given) if isinstance(given, Sequence) and not isinstance(given, str) else ()
    good = [isinstance(side, int | float) and 0.0 < side < math.inf for side in sides]
    if len(sides) != 2 or not all(good):
        raise SettingsError(f"a sheet of the stock has two sides in mm, like (1500, 3000), not {given!r}")
    return float(sides[0]), float(sides[1])


def _checked_fixings(given: object) -> tuple[float, float, float]:
    numbers = tuple(given) if isinstance(given, Sequence) and not isinstance(given, str) else ()
    good = [isinstance(number, int | float) and 0.0 < number < math.inf for number in numbers]
    if len(numbers) != 3 or not all(good):
        raise SettingsError(
            f"fixing holes have a diameter, a pitch and a distance from edges in mm, like (6.5, 400, 20), not {given!r}"
        )
    diameter, pitch, distance = map(float, numbers)
    require("diameter of fixing holes", diameter, least=0.5, most=1000.0, unit=" mm")
    require("pitch of fixing holes", pitch, least=LEAST_PITCH * diameter, unit=" mm")
    require("distance of fixing holes from the edge", distance, least=LEAST_DISTANCE * diameter, unit=" mm")
    return diameter, pitch, distance


def _checked_returns(given: object) -> tuple[float, float]:
    numbers = tuple(given) if isinstance(given, Sequence) and not isinstance(given, str) else ()
    good = [isinstance(number, int | float) and math.isfinite(number) for number in numbers]
    if len(numbers) != 2 or not all(good):
        raise SettingsError(f"returns have a length and an inner radius in mm, like (30, 3), not {given!r}")
    length, radius = map(float, numbers)
    require("length of returns", length, least=1.0, most=1000.0, unit=" mm")
    require("inner radius of returns", radius, least=0.1, most=1000.0, unit=" mm")
    return length, radius


class ShopKeywords(TypedDict, total=False):
    """The fields of `ShopSettings` as keywords, which type checkers want written out; a test holds the two alike."""

    outputs: str | Sequence[str] | None
    only: str | Sequence[str]
    origin: Origin
    k_factor: float
    chord: float
    roll_pitch: float
    dxf_entities: DxfEntities
    dxf_layers: Sequence[tuple[str, str]]
    dxf_contour_only: bool
    dxf_name_length: int
    density: float
    stock: Sequence[tuple[float, float]]
    facet_height: float
    mesh_chord: float
    mesh_colours: MeshColours
    material: str
    author: str
    organization: str
    fixings: Sequence[float] | None
    returns: Sequence[float] | None
