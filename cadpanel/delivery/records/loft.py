"""loft.json: what was spanned between two rails, how far it is from developable, and what its files show."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegative, Positive, Record, Vector, read_json, write_json
from cadpanel.delivery.records.report import UnitsModel
from cadpanel.lofting.kinds import Kind
from cadpanel.lofting.loft import MEASURED, Loft
from cadpanel.lofting.rail import Rail

SCHEMA: Literal["cadpanel.lofting/1"] = "cadpanel.lofting/1"
Share = Annotated[float, Field(ge=0.0, le=1.0)]
_TOLD_EVERY = 8
"""Of the rulings at which warp was measured, each of these is told."""


class RailModel(Record):
    """A rail: its name, its length in mm, and how many corners it has."""

    name: str
    length: Positive
    corners: int


class LoftPieceModel(Record):
    """A part of the surface.

    Attributes:
        kind: what it is.
        fan_from: name of the rail from a point of which it fans out; None where it does not.
        radius: of a cylinder, or of a cone half way, mm.
        half_angle: of a cone, degrees.
        off: how far its edges lie off that plane, cylinder or cone at most, mm.
        face: what it is built as; beside other pieces a hair off its kind is a ruled face.
        shares: of the lengths of both rails at its first and its last ruling.
        max_warp: degrees.
        worst: the middle of the ruling with the largest warp, mm.
        warp: along it, at rulings a fixed step of its parameter apart, degrees.
    """

    kind: Literal["plane", "cylinder", "cone", "ruled"]
    fan_from: str | None
    radius: Positive | None
    half_angle: NonNegative | None
    off: NonNegative | None
    face: Literal["plane", "cylinder", "cone", "ruled"]
    shares: tuple[tuple[Share, Share], tuple[Share, Share]]
    max_warp: NonNegative
    worst: Vector
    warp: tuple[NonNegative, ...]


class LoftFlatModel(Record):
    """The flat pattern, mm and mm2.

    Attributes:
        area: of the surface.
        area_error: by how much its image in the plane is too small.
        length_error: the largest difference between the length of a rail, or of a part of it, and that of its image.
        chord: how far the arcs of the drawing may lie from the image.
    """

    area: Positive
    area_error: float
    length_error: NonNegative
    chord: Positive


class LoftProofModel(Record):
    """What the files show when they are read back.

    Attributes:
        faces: kinds of the faces in the STEP file.
        area: of these faces, by the kernel, mm2.
        drawn_area: inside the contour of the drawing, mm2.
        audit_errors: what ezdxf finds wrong with the drawing.
    """

    faces: tuple[str, ...]
    area: Positive
    drawn_area: Positive
    audit_errors: int


class LoftModel(Record):
    """loft.json as a whole.

    Attributes:
        name: of the product.
        file: that the rails were read from; None where a program gave them.
        notes: on its reading.
        origin: what was taken off all its coordinates, mm.
        rails: both.
        size: the diagonal of a box about them, mm.
        distance: what the pairing made small.
        cost: of the best of all pairings of places on both rails, summed over the parts between corners.
        exact: whether every ruling was moved to where it has one tangent plane.
        max_warp: the largest angle between the tangent planes at both ends of a ruling, or of a crease, degrees.
        allowed_warp: what it may be, degrees.
        tolerance_met: whether it is.
        max_crease: the largest angle between pieces that meet where the rails have no corner, degrees.
        off: how far the surface leaves the rails at most, mm.
        pieces: in order.
        flat: the flat pattern.
        proof: what the files show.
    """

    schema_name: Literal["cadpanel.lofting/1"] = Field(default=SCHEMA, alias="schema")
    units: UnitsModel = UnitsModel()
    name: str
    file: str | None
    notes: tuple[str, ...]
    origin: Vector
    rails: tuple[RailModel, RailModel]
    size: Positive
    distance: Literal["warp", "tangent-planes"]
    cost: NonNegative
    exact: bool
    max_warp: NonNegative
    allowed_warp: NonNegative
    tolerance_met: bool
    max_crease: NonNegative
    off: NonNegative
    pieces: tuple[LoftPieceModel, ...]
    flat: LoftFlatModel
    proof: LoftProofModel


def loft_record(
    loft: Loft,
    *,
    allowed_warp: float,
    chord: float,
    proof: LoftProofModel,
    file: str | None = None,
    notes: Sequence[str] = (),
    origin: Vector = (0.0, 0.0, 0.0),
) -> LoftModel:
    """What loft.json holds.

    Args:
        loft: the surface.
        allowed_warp: degrees.
        chord: of the drawing, mm.
        proof: what the files show.
        file: that the rails were read from.
        notes: on its reading.
        origin: what was taken off its coordinates, mm.
    """
    error = loft.flat[1]
    worst = float(np.degrees(loft.max_warp))
    return LoftModel(
        name=loft.name,
        file=file,
        notes=tuple(notes),
        origin=origin,
        rails=(_rail(loft.rails[0]), _rail(loft.rails[1])),
        size=loft.size,
        distance=loft.distance,
        cost=sum(segment.cost for segment in loft.segments),
        exact=loft.exact,
        max_warp=worst,
        allowed_warp=allowed_warp,
        tolerance_met=worst <= allowed_warp,
        max_crease=float(np.degrees(loft.creases.max(initial=0.0))),
        off=loft.off,
        pieces=tuple(_piece(loft, place, np.degrees(warps).tolist()) for place, warps in enumerate(loft.warps)),
        flat=LoftFlatModel(area=error.surface, area_error=error.area, length_error=error.length, chord=chord),
        proof=proof,
    )


def _rail(rail: Rail) -> RailModel:
    return RailModel(name=rail.name, length=rail.length, corners=len(rail.corners()))


def _word(kind: Kind) -> Literal["plane", "cylinder", "cone", "ruled"]:
    return "ruled" if kind is None else kind.word


def _piece(loft: Loft, place: int, warps: list[float]) -> LoftPieceModel:
    piece, kind = loft.pieces[place], loft.kinds[place]
    worst = int(np.argmax(warps))
    a, b = piece.jets(np.array([worst / (MEASURED - 1.0)]))
    x, y, z = (0.5 * (a.point + b.point))[0].tolist()
    (a0, b0), (a1, b1) = np.clip(piece.shares, 0.0, 1.0).tolist()
    numbers = {} if kind is None else kind.numbers()
    return LoftPieceModel(
        kind=_word(kind),
        face=_word(loft.faces[place]),
        fan_from=None if piece.apex is None else loft.rails[piece.apex].name,
        radius=numbers.get("radius"),
        half_angle=numbers.get("half_angle"),
        off=None if kind is None else kind.off,
        shares=((a0, b0), (a1, b1)),
        max_warp=warps[worst],
        worst=(x, y, z),
        warp=tuple(warps[::_TOLD_EVERY]),
    )


def write_loft(record: LoftModel, path: Path) -> None:
    """Write loft.json.

    Raises:
        DeliveryError: the file cannot be written.
    """
    write_json(record, path)


def read_loft(path: Path) -> LoftModel:
    """Read loft.json.

    Raises:
        DeliveryError: the file cannot be read, or is no such record.
    """
    return read_json(path, LoftModel, schema=SCHEMA, what="a record of a loft")
