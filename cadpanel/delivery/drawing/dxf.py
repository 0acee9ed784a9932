"""Drawings as DXF of release 2000, which every cutter's software reads: the frame from ezdxf, the entities as text.

ezdxf takes 12 ms to make and write a document of its own for every part; one frame for all of them and plain text take
a twentieth of that. Frames hold neither the time of day nor random numbers: the same drawing gives the same bytes,
dated as SOURCE_DATE_EPOCH says.
"""

from __future__ import annotations

import io
import math
import re
import uuid
from collections.abc import Iterable, Iterator
from datetime import datetime
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.drawing.entities import Circle, Contour, Entity, Line, Text
from cadpanel.delivery.shop_settings import LAYERS, DxfEntities, ShopSettings
from cadpanel.delivery.source_date import source_date
from cadpanel.geometry.biarcs import all_but_straight, arc_circle

MARK = b"999\r\ncadpanel\r\n"
"""How every drawing of ours begins: a comment."""
_RELEASE, _MILLIMETRES = "R2000", 4
_COLOURS = dict(zip(LAYERS, (7, 1, 8, 3, 5), strict=True))
# Handles of entities; those of the frame are below, and the next free one is above.
_FIRST_HANDLE, _NEXT_HANDLE = 0x1000, 0x10000000
_DATES = re.compile(r"(\$TD(?:U?CREATE|U?UPDATE)\n 40\n)[^\n]*")
_GUIDS = re.compile(r"(\$(?:FINGERPRINT|VERSION)GUID\n  2\n)[^\n]*")
_WRITTEN = re.compile(r"( @ )\d{4}-\d\d-\d\dT[^\n]*")
_SEED = re.compile(r"(\$HANDSEED\n  5\n)[^\n]*")


class Frame(NamedTuple):
    """What stands before and behind the entities, and the handle of what they belong to."""

    head: str
    tail: str
    owner: str


def frame_of(shop: ShopSettings) -> Frame:
    """The frame of all drawings under some settings.

    Raises:
        SettingsError: SOURCE_DATE_EPOCH is no number of seconds.
    """
    layers = {shop.layer(role): _COLOURS[role] for role in reversed(LAYERS)}
    return _frame(tuple(layers.items()), source_date())


def dxf_bytes(drawing: Iterable[Entity], frame: Frame, entities: DxfEntities) -> bytes:
    """A whole file."""
    found: list[str] = []
    handle = _FIRST_HANDLE
    for entity in drawing:
        for kind, tags in _written(entity, entities):
            # Every entity begins alike: its kind, its handle, what it belongs to, its layer.
            begin = f"  0\n{kind}\n  5\n{handle:X}\n330\n{frame.owner}\n100\nAcDbEntity\n  8\n{entity.layer}\n"
            found.append(begin + tags)
            handle += 1
    text = f"{frame.head}{''.join(found)}{frame.tail}".replace("\n", "\r\n")
    return MARK + text.encode("cp1252", errors="dxfreplace")


@lru_cache(maxsize=8)
def _frame(layers: tuple[tuple[str, int], ...], date: datetime) -> Frame:
    from ezdxf.filemanagement import new
    from ezdxf.tools.juliandate import juliandate

    document = new(_RELEASE, setup=False, units=_MILLIMETRES)
    for name, colour in layers:
        if not document.layers.has_entry(name):
            document.layers.add(name, color=colour)
    stream = io.StringIO()
    document.write(stream)
    text = stream.getvalue()
    own = uuid.uuid5(uuid.NAMESPACE_URL, "cadpanel")
    for pattern, value in (
        (_DATES, f"{juliandate(date)}"),
        (_GUIDS, f"{{{str(own).upper()}}}"),
        (_WRITTEN, date.isoformat()),
        (_SEED, f"{_NEXT_HANDLE:X}"),
    ):
        text = pattern.sub(rf"\g<1>{value}", text)
    mark = "  2\nENTITIES\n"
    head, _, tail = text.partition(mark)
    return Frame(head + mark, tail, document.modelspace().block_record_handle)


def _written(entity: Entity, entities: DxfEntities) -> Iterator[tuple[str, str]]:
    """Kind and own tags of what an entity becomes."""
    if isinstance(entity, Line):
        yield "LINE", _line(entity.start, entity.stop)
    elif isinstance(entity, Circle):
        yield "CIRCLE", f"100\nAcDbCircle\n{_point(10, entity.middle)} 40\n{entity.radius!r}\n"
    elif isinstance(entity, Text):
        yield "TEXT", _text(entity)
    elif entities == "polyline":
        yield "LWPOLYLINE", _polyline(entity.vertices)
    else:
        yield from _lines_and_arcs(entity)


def _line(start: Array, stop: Array) -> str:
    return f"100\nAcDbLine\n{_point(10, start)}{_point(11, stop)}"


def _text(entity: Text) -> str:
    place, aligned = entity.place, 0 if entity.left else 1
    return (
        f"100\nAcDbText\n{_point(10, place)} 40\n{entity.height:.4f}\n  1\n{_escaped(entity.words)}\n"
        f" 50\n{math.degrees(entity.angle):.6f}\n 72\n{aligned}\n{_point(11, place)}100\nAcDbText\n 73\n2\n"
    )


def _polyline(vertices: Array) -> str:
    corners = [
        f" 10\n{x!r}\n 20\n{y!r}\n" + (f" 42\n{bulge!r}\n" if bulge else "") for x, y, bulge in vertices.tolist()
    ]
    return f"100\nAcDbPolyline\n 90\n{len(vertices)}\n 70\n1\n 43\n0.0\n{''.join(corners)}"


def _lines_and_arcs(contour: Contour) -> Iterator[tuple[str, str]]:
    starts = contour.vertices[:, :2]
    for start, stop, bulge in zip(starts, np.roll(starts, -1, axis=0), contour.vertices[:, 2].tolist(), strict=True):
        if all_but_straight(start, stop, bulge):
            yield "LINE", _line(start, stop)
            continue
        centre, radius = arc_circle(start, stop, bulge)
        # Arcs run counterclockwise, whichever way the contour goes.
        first, last = (start, stop) if bulge > 0.0 else (stop, start)
        angles = [math.degrees(math.atan2(end[1] - centre[1], end[0] - centre[0])) % 360.0 for end in (first, last)]
        yield (
            "ARC",
            f"100\nAcDbCircle\n{_point(10, centre)} 40\n{radius!r}\n"
            f"100\nAcDbArc\n 50\n{angles[0]!r}\n 51\n{angles[1]!r}\n",
        )


def _point(code: int, place: Array) -> str:
    x, y = place.tolist()
    return f" {code}\n{x!r}\n {code + 10}\n{y!r}\n {code + 20}\n0.0\n"


def _escaped(words: str) -> str:
    """Words as drawings write them: signs that begin a code are doubled up, what cannot be shown is a blank."""
    shown = "".join(sign if sign.isprintable() else " " for sign in words)
    return shown.replace("^", "^ ").replace("%%", "%%%%%%")
