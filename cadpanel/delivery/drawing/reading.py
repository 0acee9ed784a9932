"""The entities of a drawing, read tag by tag: a tag is a line with a code and a line with a value.

ezdxf reads and audits the drawing of all parts as any program would, which takes a millisecond a part. What stands in
the drawing of one part is in that one as well, only elsewhere; so it is read plainly here, and held against that.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from cadpanel.arrays import Array

SAME_PLACE = 1e-6
"""Distance in mm of two points that are meant to be one."""
HANDLE = 5
_LAYER, _FLAGS, _BULGE = 8, 70, 42
_CLOSED = 1
_CODES = 1072
"""Codes are below it."""
_NUMBERS, _WHOLE = range(10, 60), (*range(60, 80), *range(90, 100))
_KINDS: tuple[Callable[[str], Any], ...] = tuple(
    float if code in _NUMBERS else int if code in _WHOLE else str for code in range(_CODES)
)


class Drawn(NamedTuple):
    """An entity of a drawing.

    Attributes:
        kind: as drawings call it.
        layer: on which it lies.
        vertices: x, y and the bulge of what begins there: of a polyline, of both ends of a line or an arc. Of a circle
            its middle and its radius, of others nothing.
        closed: whether a polyline is.
        form: its codes, and all values that are no numbers, but for its handle.
        across, along, rest: its numbers: x, y, and those that stay as they are where it is moved.
    """

    kind: str
    layer: str
    vertices: Sequence[tuple[float, float, float]]
    closed: bool = False
    form: Sequence[object] = ()
    across: Sequence[float] = ()
    along: Sequence[float] = ()
    rest: Sequence[float] = ()


def drawn_in(entities: bytes) -> list[Drawn]:
    """The entities in a part of a file.

    Raises:
        ValueError: it is none: a tag is not whole, a number is none, or a line, an arc or a circle lacks one.
    """
    from ezdxf.lldxf.encoding import decode_dxf_unicode

    lines = entities.decode("cp1252", errors="surrogateescape").split("\r\n")
    if lines.pop() or len(lines) % 2:
        raise ValueError("its last tag is not whole")
    codes = list(map(int, lines[::2]))
    if codes and not (codes[0] == 0 and min(codes) >= 0 and max(codes) < _CODES):
        raise ValueError("it holds codes that are none")
    values = [_KINDS[code](value) for code, value in zip(codes, lines[1::2], strict=True)]
    starts = [place for place, code in enumerate(codes) if code == 0]
    layers: dict[str, str] = {}
    found = []
    for start, stop in zip(starts, [*starts[1:], len(codes)], strict=True):
        entity = _entity(codes[start:stop], values[start:stop])
        if entity.layer not in layers:
            layers[entity.layer] = decode_dxf_unicode(entity.layer)
        found.append(entity._replace(layer=layers[entity.layer]))
    return found


def _entity(codes: list[int], values: list[Any]) -> Drawn:
    kind = values[0]
    numbers = [(code, value) for code, value in zip(codes, values, strict=True) if code in _NUMBERS]
    words = [value for code, value in zip(codes, values, strict=True) if code not in _NUMBERS and code != HANDLE]
    across = [value for code, value in numbers if code < 20]
    along = [value for code, value in numbers if 20 <= code < 30]
    rest = [value for code, value in numbers if code >= 30]
    own, closed = dict(zip(codes, values, strict=True)), False
    vertices: Sequence[tuple[float, float, float]] = ()
    try:
        if kind == "LWPOLYLINE":
            vertices, closed = _polyline(numbers), bool(own.get(_FLAGS, 0) & _CLOSED)
        elif kind == "LINE":
            vertices = (own[10], own[20], 0.0), (own[11], own[21], 0.0)
        elif kind == "CIRCLE":
            vertices = ((own[10], own[20], own[40]),)
        elif kind == "ARC":
            vertices = _arc(own)
            # Of a flat arc the middle is far away, and says little of where it lies; its ends do.
            across, along, rest = ([one[way] for one in vertices] for way in range(3))
    except KeyError as error:
        raise ValueError(f"a {kind} of it has no code {error}") from None
    return Drawn(kind, own.get(_LAYER, "0"), vertices, closed, [codes, words], across, along, rest)


def _polyline(numbers: Sequence[tuple[int, float]]) -> list[tuple[float, float, float]]:
    found: list[list[float]] = []
    for code, value in numbers:
        if code == 10:
            found.append([value, 0.0, 0.0])
        elif found and code == 20:
            found[-1][1] = value
        elif found and code == _BULGE:
            found[-1][2] = value
    return [(x, y, bulge) for x, y, bulge in found]


def _arc(own: dict[int, float]) -> list[tuple[float, float, float]]:
    """Both ends, the bulge with the first one."""
    first, last = own[50], own[51]
    bulge = math.tan(0.25 * math.radians((last - first) % 360.0))
    ways = [(math.cos(math.radians(angle)), math.sin(math.radians(angle))) for angle in (first, last)]
    ends = [(own[10] + own[40] * x, own[20] + own[40] * y) for x, y in ways]
    return [(*ends[0], bulge), (*ends[1], 0.0)]


def moved_only(one: Sequence[Drawn], other: Sequence[Drawn]) -> bool:
    """Whether entities are those of another drawing in turn, but for handles, and that all were moved as one."""
    if [(entity.kind, entity.form) for entity in one] != [(entity.kind, entity.form) for entity in other]:
        return False
    off = [_numbers(other, way) - _numbers(one, way) for way in ("across", "along", "rest")]
    shifts = [apart[0] if len(apart) else 0.0 for apart in off[:2]] + [0.0]
    return all(bool((np.abs(apart - shift) <= SAME_PLACE).all()) for apart, shift in zip(off, shifts, strict=True))


def _numbers(entities: Sequence[Drawn], way: str) -> Array:
    return np.array([number for entity in entities for number in getattr(entity, way)], dtype=np.float64)
