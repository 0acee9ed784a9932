"""Trimmed faces on surfaces that are closed, or shrink to a point, as Rhino writes them: seams, and sides without edge.

rhino3dm makes no trims; so the polysurface is written here in openNURBS' own form and read back by rhino3dm, which then
says whether it is valid.
"""

from __future__ import annotations

import struct
import zlib
from base64 import b64decode, b64encode
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from cadpanel.arrays import Array

rhino = pytest.importorskip("rhino3dm")

ANONYMOUS, CLASS, UUID, DATA, END = 0x40008000, 0x00027FFA, 0x0002FFFB, 0x0002FFFC, 0x80027FFF
WITH_SUM = 0x8000
BOUNDARY, SEAM, SINGULAR = 1, 3, 4
UNSET_ISO = 0
W_ISO, S_ISO, E_ISO, N_ISO = 3, 4, 5, 6
EDGE_POINTS = 481
TOLERANCE = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Tube:
    """A surface of revolution about z, radius mm at its foot, that goes round once from angle 0.

    Attributes:
        radius: at its foot, mm.
        height: mm.
        apex: whether it shrinks to a point at the top, as a cone does.
        round_v: whether it closes along its parameter v, and not along u.
        wave: how far the lower border, at a fifth of the height, waves up and down, as a part of the height.
        slip: by how much the border's curve in the parameter plane lies above the one in space, as a part of the
            height: it is none of this face's then.
    """

    radius: float = 500.0
    height: float = 2000.0
    apex: bool = False
    round_v: bool = False
    wave: float = 0.1
    slip: float = 0.0

    def surface(self) -> Any:
        """The whole of it, as a NURBS surface."""
        half = np.sqrt(0.5)
        ring = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0))
        knots = (0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0)
        orders, counts = ((2, 3), (2, 9)) if self.round_v else ((3, 2), (9, 2))
        found = rhino.NurbsSurface.Create(3, True, *orders, *counts)
        around, along = (found.KnotsV, found.KnotsU) if self.round_v else (found.KnotsU, found.KnotsV)
        for place, knot in enumerate(knots):
            around[place] = knot
        along[0], along[1] = 0.0, 1.0
        for i, (x, y) in enumerate(ring):
            weight = half if i % 2 else 1.0
            for j, (scale, z) in enumerate(((1.0, 0.0), (0.0 if self.apex else 1.0, self.height))):
                reach = weight * self.radius * scale
                found.Points[(j, i) if self.round_v else (i, j)] = rhino.Point4d(
                    reach * x, reach * y, weight * z, weight
                )
        return found

    def lower(self, around: Array) -> Array:
        """The part of the height at which the lower border lies at (k,) parts of the way round."""
        return 0.2 + self.wave * np.sin(2.0 * np.pi * around)

    @property
    def area(self) -> float:
        """Of the face above its lower border, mm^2."""
        around = np.linspace(0.0, 1.0, 20_001)
        surface = self.surface()
        points = [surface.PointAt(*self.place(part, 0.0)) for part in around.tolist()]
        angles = np.unwrap([np.arctan2(point.Y, point.X) for point in points])
        above = 1.0 - self.lower(around)
        slant = float(np.hypot(self.radius, self.height)) if self.apex else self.height
        heights = 0.5 * above**2 if self.apex else above
        return float(self.radius * slant * np.sum(np.diff(angles) * 0.5 * (heights[1:] + heights[:-1])))

    def place(self, around: float, up: float) -> tuple[float, float]:
        """The surface's parameters."""
        return (up, around) if self.round_v else (around, up)

    def brep(self, reverse: bool = False, change: Callable[[bytes], bytes] = bytes) -> Any:
        """The face as a polysurface of one face: its lower border waves, and its seam is one edge on both sides.

        Args:
            reverse: whether it lies against its surface.
            change: what is done to the bytes of its trims.
        """
        around = np.linspace(0.0, 1.0, EDGE_POINTS)
        wave = [*zip(around.tolist(), self.lower(around).tolist(), strict=True)]
        foot = wave[0][1]
        # Counterclockwise: along the lower border, up the seam, back along the top, and down the seam.
        walk = [(wave, 0, 0), ([(1.0, foot), (1.0, 1.0)], 1, 0), ([(1.0, 1.0), (0.0, 1.0)], 2, 1)]
        walk.append(([(0.0, 1.0), (0.0, foot)], 1, 1))
        surface = self.surface()
        edges: dict[int, list[Any]] = {}
        trims: list[tuple[list[tuple[float, float]], int, int]] = []
        for line, edge, against in walk:
            # The top goes all the way round, however short its trim is said.
            drawn = [*zip(around.tolist(), [1.0] * len(around), strict=True)] if edge == 2 else line
            edges.setdefault(edge, [surface.PointAt(*self.place(*point)) for point in drawn])
            lift = self.slip * np.sin(np.pi * around) if edge == 0 else np.zeros(len(line))
            slipped = [(part, up + by) for (part, up), by in zip(line, lift.tolist(), strict=True)]
            trims.append(([self.place(*point) for point in slipped], edge, against))
        if self.round_v:  # the other way round in the parameter plane
            trims = [(line[::-1], edge, 1 - against) for line, edge, against in trims[::-1]]
        return _decoded(_written(surface, edges, trims, self, reverse, change))


def _curve(points: list[Any], dimension: int) -> Any:
    """A spline of degree 1 or 3 through points: the same by the same parameters in space and in the plane."""
    coordinates = np.array([(p.X, p.Y, p.Z) if hasattr(p, "X") else (*p, 0.0) for p in points])
    degree = 1 if len(points) == 2 else 3
    spline = make_interp_spline(np.linspace(0.0, 1.0, len(points)), coordinates, k=degree)
    curve = rhino.NurbsCurve(dimension, False, degree + 1, len(points))
    for place, knot in enumerate(spline.t[1:-1].tolist()):
        curve.Knots[place] = knot
    for place, pole in enumerate(spline.c.tolist()):
        curve.Points[place] = rhino.Point4d(*pole, 1.0)
    return curve


def _written(
    surface: Any,
    edges: dict[int, list[Any]],
    trims: list[Any],
    tube: Tube,
    reverse: bool,
    change: Callable[[bytes], bytes],
) -> bytes:
    """ON_Brep of one face, chunk version 3.0."""
    singular = {2} if tube.apex else set()
    kept = [edge for edge in sorted(edges) if edge not in singular]
    ends = {0: (0, 0), 1: (0, 1), 2: (1, 1)}
    where = [edges[0][0], surface.PointAt(*tube.place(0.0, 1.0))]
    touching = [[place for place, edge in enumerate(kept) for end in ends[edge] if end == v] for v in (0, 1)]
    using = {edge: [place for place, (_, own, _) in enumerate(trims) if own == edge] for edge in kept}
    written_trims = b""
    for place, (line, edge, against) in enumerate(trims):
        first, last = ends[edge][::-1] if against else ends[edge]
        kind = SINGULAR if edge in singular else SEAM if edge == 1 else BOUNDARY
        index = -1 if edge in singular else kept.index(edge)
        written_trims += struct.pack("<iiddi", place, place, 0.0, 1.0, index)
        written_trims += struct.pack("<iiiiii", first, last, against if index >= 0 else 0, kind, _iso(line), 0)
        written_trims += struct.pack("<4d", TOLERANCE, TOLERANCE, 0.0, 1.0) + bytes(32)
        written_trims += struct.pack("<dd", TOLERANCE, TOLERANCE)
    body = b"\x30"
    body += _array([_object(_curve(line, 2)) for line, _, _ in trims])
    body += _array([_object(_curve(edges[edge], 3)) for edge in kept])
    body += _array([_object(surface)])
    body += _array(
        [
            struct.pack("<i3d", index, point.X, point.Y, point.Z)
            + _ints(touching[index])
            + struct.pack("<d", TOLERANCE)
            for index, point in enumerate(where)
        ]
    )
    body += _array(
        [
            struct.pack("<iiidd", place, place, 0, 0.0, 1.0)
            + struct.pack("<ii", *ends[edge])
            + _ints(using[edge])
            + struct.pack("<3d", TOLERANCE, 0.0, 1.0)
            for place, edge in enumerate(kept)
        ]
    )
    body += _chunk(ANONYMOUS, b"\x10" + struct.pack("<i", len(trims)) + change(written_trims))
    body += _array([struct.pack("<i", 0) + _ints(range(len(trims))) + struct.pack("<ii", 1, 0)])
    body += _array([struct.pack("<i", 0) + _ints([0]) + struct.pack("<iii", 0, int(reverse), 0)])
    reach = tube.radius
    body += struct.pack("<6d", -reach, -reach, 0.0, reach, reach, tube.height)
    return body


def _iso(line: list[tuple[float, float]]) -> int:
    """Along which side of the range a trim runs, in the words of openNURBS."""
    u, v = np.array(line).T
    for values, low, high in ((u, W_ISO, E_ISO), (v, S_ISO, N_ISO)):
        if np.ptp(values) == 0.0 and values[0] in (0.0, 1.0):
            return low if values[0] == 0.0 else high
    return UNSET_ISO


def _decoded(body: bytes) -> Any:
    model = rhino.Brep.CreateFromSphere(rhino.Sphere(rhino.Point3d(0.0, 0.0, 0.0), 1.0)).Encode()
    uuid = b64decode(model["data"])[12:44]  # the chunk that says that it is a polysurface
    data = _chunk(CLASS, uuid + _chunk(DATA, body) + struct.pack("<Iq", END, 0))
    return rhino.CommonObject.Decode({**model, "data": b64encode(data).decode()})


def _object(thing: Any) -> bytes:
    return struct.pack("<i", 1) + b64decode(thing.Encode()["data"])


def _array(members: list[bytes]) -> bytes:
    return _chunk(ANONYMOUS, b"\x10" + struct.pack("<i", len(members)) + b"".join(members))


def _ints(values: Iterable[int]) -> bytes:
    own = list(values)
    return struct.pack(f"<{len(own) + 1}i", len(own), *own)


def _chunk(kind: int, body: bytes) -> bytes:
    if kind & WITH_SUM:
        body += struct.pack("<I", zlib.crc32(body))
    return struct.pack("<Iq", kind, len(body)) + body
