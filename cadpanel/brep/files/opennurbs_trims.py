"""The trims of a Rhino polysurface: which curves of the parameter plane bound each face, as the file has them.

rhino3dm shows of a trim only the edge that it lies on. All else it gives away in the form in which openNURBS writes a
polysurface (ON_Brep, chunk version 3): arrays of curves and surfaces, which it reads itself one by one, then of
vertices, edges, trims, loops and faces, which are plain numbers. Source: opennurbs_brep_io.cpp of openNURBS 8.
"""

from __future__ import annotations

import struct
from base64 import b64decode, b64encode
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.files.opennurbs import ConversionError, RhinoObject

# A chunk begins with what it is (4 bytes) and how long it is (8 bytes).
CHUNK = struct.Struct("<Iq")
MAJOR_VERSION = 3
UUID_BYTES, TRIM_SPARE_BYTES, VERSION_BYTES = 16, 31, 1
SEAM, SINGULAR = 3, 4
"""Kinds of trims: along the line where a surface closes, and along a side that has shrunk to a point."""
OUTER, INNER = 1, 2
"""Kinds of loops that bound a face; others are slits and curves that lie on it."""
_T = TypeVar("_T")


@dataclass(frozen=True, slots=True, kw_only=True)
class Trim:
    """A stretch of a face's border.

    Attributes:
        curve: rhino3dm's, in the parameter plane.
        domain: from where to where it is followed.
        backwards: whether it is followed from its end to its beginning.
        edge: index of the edge that it lies on; -1 where it has none.
        vertices: indices of those where it begins and ends.
        against_edge: whether it runs against the edge.
        kind: SEAM, SINGULAR or another one.
    """

    curve: RhinoObject
    domain: tuple[float, float]
    backwards: bool
    edge: int
    vertices: tuple[int, int]
    against_edge: bool
    kind: int

    def at(self, parts: Array) -> Array:
        """(k, 2) parameters of the surface at (k,) parts of the way along the border."""
        low, high = self.domain
        places = low + (1.0 - parts if self.backwards else parts) * (high - low)
        if self.curve.Degree == 1 and self.curve.SpanCount == 1:  # mostly, and rhino3dm takes its time for each point
            first, last = self._points([low, high])
            return np.asarray(first + (places[:, None] - low) / (high - low) * (last - first), dtype=np.float64)
        return self._points(places.tolist())

    def _points(self, places: list[float]) -> Array:
        points = [self.curve.PointAt(place) for place in places]
        return np.array([(point.X, point.Y) for point in points])


@dataclass(frozen=True, slots=True, kw_only=True)
class Trims:
    """How the faces of a polysurface are bounded.

    Attributes:
        edge_vertices: for each edge the indices of the vertices where it begins and ends.
        loops: for each face its loops, each of trims that follow each other, the face on their left.
    """

    edge_vertices: tuple[tuple[int, int], ...]
    loops: tuple[tuple[tuple[Trim, ...], ...], ...]


def trims_of(brep: RhinoObject, decode: Callable[[dict[str, Any]], RhinoObject]) -> Trims:
    """The trims of a polysurface.

    Args:
        brep: rhino3dm's Brep.
        decode: rhino3dm's CommonObject.Decode.

    Raises:
        ConversionError: they are not written as this version of openNURBS writes them.
    """
    written = brep.Encode()
    try:
        return _read(_Walk(b64decode(written["data"])), written, decode)
    except (struct.error, IndexError, KeyError) as error:
        raise ConversionError("its trimming curves cannot be read") from error


def _read(walk: _Walk, written: dict[str, Any], decode: Callable[[dict[str, Any]], RhinoObject]) -> Trims:
    walk.enter()  # the object
    walk.skip()  # its class
    walk.enter()  # its data
    if walk.byte() >> 4 != MAJOR_VERSION:
        raise ConversionError("its trimming curves are written in an unknown way")
    curves = [
        None if one is None else decode({**written, "data": b64encode(one).decode()})
        for one in walk.array(walk.optional_object)
    ]
    for _ in ("curves in space", "surfaces", "vertices"):
        walk.skip()
    edges = walk.array(walk.edge)
    trims = walk.array(lambda: walk.trim(curves))
    loops = walk.array(walk.loop)
    faces = walk.array(walk.face)
    bounding = {
        index: tuple(trims[trim] for trim in own) for index, (own, kind) in enumerate(loops) if kind in (OUTER, INNER)
    }
    return Trims(
        edge_vertices=tuple(edges),
        loops=tuple(tuple(bounding[loop] for loop in own if loop in bounding) for own in faces),
    )


class _Walk:
    """A place in what openNURBS has written, and how to go on from there."""

    def __init__(self, data: bytes) -> None:
        self._data, self._place = data, 0

    def _take(self, form: str) -> tuple[Any, ...]:
        packed = struct.Struct("<" + form)
        found = packed.unpack_from(self._data, self._place)
        self._place += packed.size
        return found

    def byte(self) -> int:
        return int(self._take("B")[0])

    def enter(self) -> int:
        """Go into the next chunk, and return where it ends."""
        _, length = CHUNK.unpack_from(self._data, self._place)
        self._place += CHUNK.size
        return self._place + int(length)

    def skip(self) -> None:
        self._place = self.enter()

    def array(self, member: Callable[[], _T]) -> list[_T]:
        """The members of the array that is the next chunk."""
        end = self.enter()
        self._place += VERSION_BYTES
        found = [member() for _ in range(self._take("i")[0])]
        self._place = end
        return found

    def optional_object(self) -> bytes | None:
        """The bytes of an object, which is a chunk, or None where there is none."""
        if not self._take("i")[0]:
            return None
        start = self._place
        self.skip()
        return self._data[start : self._place]

    def indices(self) -> tuple[int, ...]:
        return self._take(f"{self._take('i')[0]}i")

    def edge(self) -> tuple[int, int]:
        """The vertices of an edge."""
        _, _, _, _, _, first, last = self._take("iiiddii")
        self.indices()
        self._take("ddd")
        return first, last

    def trim(self, curves: list[RhinoObject | None]) -> Trim:
        _, curve, low, high, edge, first, last, against, kind, _, _ = self._take("iiddiiiiiii")
        self._take("dddd")
        backwards = self.byte() == 1
        self._place += TRIM_SPARE_BYTES
        self._take("dd")
        if curves[curve] is None:
            raise ConversionError("one of its trimming curves is missing")
        return Trim(
            curve=curves[curve],
            domain=(low, high),
            backwards=backwards,
            edge=edge,
            vertices=(first, last),
            against_edge=against != 0,
            kind=kind,
        )

    def loop(self) -> tuple[tuple[int, ...], int]:
        """The trims of a loop, and its kind."""
        self._take("i")
        trims = self.indices()
        kind, _ = self._take("ii")
        return trims, int(kind)

    def face(self) -> tuple[int, ...]:
        """The loops of a face."""
        self._take("i")
        loops = self.indices()
        self._take("iii")
        return loops
