"""Drawings read back: is what is cut the exact contour, do the bends lie where they should, does ezdxf find a fault?

ezdxf reads and audits the drawing with all parts. That stands for every file, as the frames of all drawings of a
delivery are the same bytes, and the entities of each are those of that one, moved: both are proved. The entities of
each are read and measured.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.drawing.dxf import MARK
from cadpanel.delivery.drawing.part import bend_lines, roll_lines
from cadpanel.delivery.drawing.reading import SAME_PLACE, Drawn, drawn_in, moved_only
from cadpanel.delivery.drawing.redrawn import digest_of, drawings_of, holds
from cadpanel.delivery.records.flat_parts import ALL, FlatPart
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError
from cadpanel.garbage import garbage_left
from cadpanel.geometry.biarcs import arc_contour_area, off_arcs

_ENDING = ".dxf"
_ENTITIES = b"  2\r\nENTITIES\r\n"
_END = b"  0\r\nENDSEC\r\n"
# Places on each curve of the exact contour that are looked for in the drawing.
_PLACES = 33


def prove_drawings(folder: Path, contents: Contents) -> Proof:
    """Read every drawing of a delivery back.

    Raises:
        DeliveryError: one of them is missing or cannot be read.
    """
    written = dict(contents.drawn)
    contents.drawn.clear()
    whole = folder / f"{ALL}{_ENDING}"
    with garbage_left():
        errors, contours = _audited(whole, contents.shop)
        frame, text = _split(whole)
        together, place, elsewhere = _read(whole, text), 0, list[str]()
    failures = [f"'{whole.name}': ezdxf finds {error}." for error in errors]
    if len(contours) != len(contents.parts):
        failures.append(f"'{whole.name}' holds {len(contours)} contours, expected {len(contents.parts)}.")
    off, area_off = 0.0, abs(sum(map(arc_contour_area, contours)) - sum(part.size.area for part in contents.parts))
    allowed = sum(_area_allowed(part, contents.shop) for part in contents.parts)
    if area_off > allowed:
        failures.append(f"'{whole.name}': its contours enclose {area_off:.3g} mm2 too much or too little.")
    for part in contents.parts:
        path = folder / f"{part.blank.file}{_ENDING}"
        own_frame, text = _split(path)
        if own_frame != frame:
            failures.append(f"'{path.name}': what stands about its entities is not what '{whole.name}' has.")
        entities = _read(path, text)
        found = list(_part_faults(part, _on_layers(entities), contents.shop))
        failures += [f"'{path.name}': {fault}." for _, fault in found if fault]
        if not moved_only(entities, together[place : (place := place + len(entities))]):
            elsewhere.append(f"'{path.name}' holds other entities than '{whole.name}' has of this part.")
        off = max([off, *(measured for measured, _ in found)])
    strange = sorted({path.name for path in folder.iterdir()} - {whole.name} - _files(contents.parts))
    if place != len(together):
        elsewhere.append(f"'{whole.name}' holds {len(together)} entities, and those of the parts are {place}.")
    failures = failures or elsewhere
    if not failures:
        failures += _redrawn_faults(folder, contents, written)
    failures += [f"'{name}' stands among the drawings, and no panel of the report is drawn there." for name in strange]
    return Proof(
        numbers={"drawings": len(contents.parts) + 1, "audit_errors": len(errors), "contour_error": off},
        failures=tuple(failures),
    )


def _redrawn_faults(folder: Path, contents: Contents, written: Mapping[str, str]) -> Iterator[str]:
    """What is drawn besides contours and bends, and how, where these are as they should be."""
    names = [part.blank.file for part in contents.parts]
    if written:
        # What has just been drawn by the same numbers need not be drawn again to be known.
        other = [
            name for name in (*names, ALL) if digest_of((folder / f"{name}{_ENDING}").read_bytes()) != written.get(name)
        ]
    else:
        other = [
            name
            for name, drawing in drawings_of(contents).items()
            if not holds(_split(folder / f"{name}{_ENDING}")[1], drawing, contents.shop.dxf_entities)
        ]
    for name in other:
        yield f"'{name}{_ENDING}' does not hold just what the report's numbers and settings draw."


def _files(parts: Sequence[FlatPart]) -> set[str]:
    return {f"{part.blank.file}{_ENDING}" for part in parts}


def _area_allowed(part: FlatPart, shop: ShopSettings) -> float:
    bent = sum(length for length, curved in zip(part.size.pieces, part.pattern.curves.curved, strict=True) if curved)
    return shop.chord * bent + SAME_PLACE * sum(part.size.pieces)


def _part_faults(part: FlatPart, layers: dict[str, list[Drawn]], shop: ShopSettings) -> Iterator[tuple[float, str]]:
    """Distances that were measured, each with what is wrong with it, or nothing."""
    contours = _contours(layers.get(shop.layer("CUT"), []))
    if len(contours) != 1:
        yield 0.0, f"it holds {len(contours)} closed contours on the layer that is cut instead of one"
        return
    yield _hole_faults(part, layers.get(shop.layer("CUT"), []))
    curves, vertices = part.pattern.curves, contours[0]
    places = curves.points(np.broadcast_to(np.linspace(0.0, 1.0, _PLACES), (len(curves), _PLACES)))
    off = float(off_arcs(vertices, places.reshape(-1, 2)).max())
    yield off, f"its contour lies {off:.3g} mm off the exact one" if off > shop.chord + SAME_PLACE else ""
    corners = float(np.linalg.norm(curves.start[:, None] - vertices[:, :2], axis=-1).min(axis=1).max())
    yield 0.0, f"a corner of it is {corners:.3g} mm off" if corners > SAME_PLACE else ""
    area_off = abs(arc_contour_area(vertices) - part.size.area)
    yield 0.0, f"its area is off by {area_off:.3g} mm2" if area_off > _area_allowed(part, shop) else ""
    wanted = {} if shop.dxf_contour_only else {"BEND": bend_lines(part), "ROLL": roll_lines(part, shop.roll_pitch)}
    for role in {shop.layer(role): role for role in wanted}.values():
        alike = [lines for other, lines in wanted.items() if shop.layer(other) == shop.layer(role)]
        found = [entity.vertices for entity in layers.get(shop.layer(role), []) if entity.kind == "LINE"]
        drawn = np.array(found).reshape(-1, 2, 3)[..., :2]
        yield 0.0, "" if _same_lines(drawn, np.concatenate(alike)) else f"its lines on the layer {role} lie elsewhere"


def _hole_faults(part: FlatPart, entities: Sequence[Drawn]) -> tuple[float, str]:
    """How far off a circle that is cut lies, and what is wrong with circles, or nothing."""
    drawn = np.array([entity.vertices[0] for entity in entities if entity.kind == "CIRCLE"]).reshape(-1, 3)
    middles = np.empty((0, 2)) if part.fixings is None else part.fixings.middles
    if len(drawn) != len(middles):
        return 0.0, f"it holds {len(drawn)} circles on the layer that is cut instead of {len(middles)}"
    if part.fixings is None or not len(middles):
        return 0.0, ""
    apart = np.linalg.norm(drawn[:, None, :2] - middles, axis=-1)
    off = max(
        float(apart.min(axis=0).max()),
        float(apart.min(axis=1).max()),
        float(np.abs(drawn[:, 2] - 0.5 * part.fixings.rule.diameter).max()),
    )
    return off, f"a circle on the layer that is cut is {off:.3g} mm off" if off > SAME_PLACE else ""


def _same_lines(drawn: Array, wanted: Array) -> bool:
    """Whether every line that is wanted is drawn; marks may share its layer."""
    if not len(wanted) or len(drawn) < len(wanted):
        return not len(wanted)
    apart = np.abs(drawn[:, None] - wanted).max(axis=(-1, -2)).min(axis=0)
    return bool(apart.max() <= SAME_PLACE)


def _audited(path: Path, shop: ShopSettings) -> tuple[list[str], list[Array]]:
    """What ezdxf's audit says of the drawing of all parts, and its contours as ezdxf reads them."""
    from ezdxf.filemanagement import readfile
    from ezdxf.lldxf.const import DXFError

    try:
        document = readfile(path)
    except (OSError, DXFError, ValueError) as error:
        raise DeliveryError(f"'{path}' cannot be read: {error}.") from error
    audit = document.audit()
    errors = [problem.message for problem in (*audit.errors, *audit.fixes)]
    layers = _on_layers(list(map(_by_ezdxf, document.modelspace())))
    return errors, _contours(layers.get(shop.layer("CUT"), []))


def _by_ezdxf(entity: Any) -> Drawn:
    """An entity as ezdxf reads it; of those that make no contour just where it lies."""
    from ezdxf.lldxf.encoding import decode_dxf_unicode

    kind, layer = entity.dxftype(), decode_dxf_unicode(entity.dxf.layer)
    if kind == "LWPOLYLINE":
        return Drawn(kind, layer, entity.get_points("xyb"), closed=entity.closed)
    if kind == "LINE":
        return Drawn(kind, layer, [(*end.vec2, 0.0) for end in (entity.dxf.start, entity.dxf.end)])
    if kind == "ARC":
        bulge = float(np.tan(0.25 * np.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0)))
        return Drawn(kind, layer, [(*entity.start_point.vec2, bulge), (*entity.end_point.vec2, 0.0)])
    return Drawn(kind, layer, ())


def _split(path: Path) -> tuple[bytes, bytes]:
    """What stands before and behind the entities of a drawing, and these."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror}.") from error
    head, mark, rest = data.partition(_ENTITIES)
    entities, _, tail = rest.partition(_END)
    if not (data.startswith(MARK) and mark and tail):
        raise DeliveryError(f"'{path}' cannot be read: it is not a whole drawing of cadpanel.")
    return head + tail, entities


def _read(path: Path, entities: bytes) -> list[Drawn]:
    try:
        return drawn_in(entities)
    except ValueError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error}.") from error


def _on_layers(entities: Sequence[Drawn]) -> dict[str, list[Drawn]]:
    found: dict[str, list[Drawn]] = {}
    for entity in entities:
        found.setdefault(entity.layer, []).append(entity)
    return found


def _contours(entities: Sequence[Drawn]) -> list[Array]:
    """Closed contours (v, 3): polylines, and lines and arcs each of which begins where the one before ends.

    None if a line or an arc goes on from nowhere, or a contour does not close.
    """
    found = [
        np.array(entity.vertices)
        for entity in entities
        if entity.kind == "LWPOLYLINE" and entity.closed and len(entity.vertices) > 1
    ]
    pieces = [_ways(entity) for entity in entities if entity.kind in ("LINE", "ARC")]
    chain: list[_Piece] = []
    for place, ways in enumerate(pieces):
        if chain:
            fitting = [way for way in ways if _apart(chain[-1].stop, way.start) <= SAME_PLACE]
        else:  # whichever way leads on to the next one
            onwards = [way.start for way in pieces[(place + 1) % len(pieces)]]
            fitting = [way for way in ways if min(_apart(way.stop, start) for start in onwards) <= SAME_PLACE]
        if not fitting:
            return []
        chain.append(fitting[0])
        if _apart(chain[0].start, chain[-1].stop) <= SAME_PLACE:
            found.append(np.array([[*one.start, one.bulge] for one in chain]))
            chain = []
    return [] if chain else found


def _apart(one: Array, other: Array) -> float:
    return float(np.linalg.norm(one - other))


class _Piece(NamedTuple):
    start: Array
    stop: Array
    bulge: float


def _ways(entity: Drawn) -> list[_Piece]:
    """A line or an arc, followed one way and the other."""
    rows = np.array(entity.vertices)
    start, stop, bulge = rows[0, :2], rows[1, :2], float(rows[0, 2])
    return [_Piece(start, stop, bulge), _Piece(stop, start, -bulge)]
