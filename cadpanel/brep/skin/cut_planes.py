"""The planes that cut a strip across."""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Cuts:
    """Planes across a surface, in order along it.

    Attributes:
        origins: (k, 3) a point of each, mm.
        normals: (k, 3) unit normals, along the surface.
        reach: (k,) how far each plane reaches from its origin, mm.
        line: (q, 3) points along the middle of the surface.
        places: (q,) at which place among the planes each of them lies: 1.5 is half-way between the first two.
    """

    origins: Array
    normals: Array
    reach: Array
    line: Array
    places: Array
