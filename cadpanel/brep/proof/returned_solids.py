"""Solids of a file that came back from another program, held against those that were delivered. Nothing of the kernel.

Names, order, units and colours are no part of a solid: each is found by where it lies. What differs is told in numbers,
as another program writes fewer digits, splits faces or makes splines of cones.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.isolation.client import READER
from cadpanel.brep.isolation.requests import SECONDS_TO_WORK, Request, Stage, looked_for_in, reading
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.vectors import norm

NEAR = 0.1
"""Distance of two centroids, and difference of two volumes, as parts of the root of the area and of the volume, within
which a solid may be the other one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SolidBack:
    """What became of a delivered solid.

    Attributes:
        name: as it was delivered.
        called: what the other file calls it; empty where it does not.
        apart: how far the farthest place of its edges, and of the other's, lies off the other's faces, mm.
        volume: relative difference of the volume.
        area: relative difference of the area of all faces.
        valid: whether it passes the kernel's check.
    """

    name: str
    called: str
    apart: float
    volume: float
    area: float
    valid: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class SolidsBack:
    """What a file holds of a delivery.

    Attributes:
        found: the delivered solids that are in it, in their order.
        missing: names of those that are not.
        strange: what it calls solids that were not delivered.
    """

    found: tuple[SolidBack, ...]
    missing: tuple[str, ...]
    strange: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Solids:
    """Solids of a file as numbers.

    Attributes:
        centroids: (n, 3) mm.
        volumes: (n,) mm3.
        areas: (n,) mm2.
    """

    centroids: Array
    volumes: Array
    areas: Array


def pairs_by_place(delivered: Solids, other: Solids) -> dict[int, int]:
    """Which of the other solids each delivered one may be, the nearest first; each serves once."""
    apart = norm(delivered.centroids[:, None] - other.centroids[None])
    with np.errstate(divide="ignore", invalid="ignore"):
        volume = np.abs(other.volumes[None] / delivered.volumes[:, None] - 1.0)
    may_be = (apart <= NEAR * np.sqrt(delivered.areas)[:, None]) & (volume <= NEAR)
    found: dict[int, int] = {}
    for place in np.argsort(np.where(may_be, apart, np.inf), axis=None, kind="stable"):
        one, two = (int(part) for part in np.unravel_index(place, apart.shape))
        if not may_be[one, two]:
            break
        if one not in found and two not in found.values():
            found[one] = two
    return found


def solids_back(file: Path, panels_step: Path) -> SolidsBack:
    """What a file holds of the solids of another one.

    Args:
        file: of any format that can be read.
        panels_step: as it was delivered.

    Raises:
        ReferenceFileError: one of them cannot be read, or the kernel crashes over it or does not end.
    """
    request = Request(
        work="back",
        folder=looked_for_in(file, ReferenceFileError),
        path=file,
        argument=panels_step.absolute(),
        stages=(
            reading(file),
            reading(panels_step),
            Stage(file=file.name, doing="measuring", seconds=SECONDS_TO_WORK),
        ),
    )
    return cast(SolidsBack, READER.ask(request))
