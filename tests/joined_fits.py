"""Fits whose panels meet all along their edges: a lip, and three grids that fit exactly or nearly so."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import cadpanel as cp
from cadpanel.arrays import Array
from cadpanel.fitting.result import FitResult
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import RawPanel
from tests.grids import dome, write_grid, write_honeycomb
from tests.reference_shapes import Surface, polygon_face, sheet_of

FIXTURES = Path(__file__).parents[1] / "fixtures"
FITS = ("lip", "quadrilaterals", "cylinders", "hexagons")


def barrel() -> Surface:
    """A vault whose rows are straight: cylinders fit exactly."""

    def surface(u: Array, v: Array) -> Array:
        turn = 0.8 * (np.asarray(v) - 0.5)
        return np.stack([1500.0 * np.asarray(u), 5000.0 * np.sin(turn), 5000.0 * np.cos(turn)], axis=-1)

    return surface


def tapered() -> Surface:
    """A vault that widens along its rows: cones fit exactly."""

    def surface(u: Array, v: Array) -> Array:
        along, turn = 1500.0 * np.asarray(u), 0.8 * (np.asarray(v) - 0.5)
        reach = 4000.0 + 0.2 * along
        return np.stack([along, reach * np.sin(turn), reach * np.cos(turn)], axis=-1)

    return surface


@cache
def cones() -> FitResult:
    """Cones on a vault that widens."""
    with TemporaryDirectory() as folder:
        return cp.fit(cp.read(write_grid(Path(folder) / "reference.step", tapered())), feature="cone")


@cache
def bricks(*, junctions: bool) -> FitResult:
    """Flat bricks on a dome, in two rows that are shifted by half a brick; without junctions a row at a time meets."""
    roof = sheet_of(lambda u, v: 600.0 * np.cos(1.2 * (v - 0.5)) * np.cos(1.2 * (u - 0.5)))
    rows = [np.linspace(0.0, 1.0, 4), np.array([0.0, 1.0, 3.0, 5.0, 6.0]) / 6.0]
    panels = [
        RawPanel(name=f"{row}/{place}", faces=(polygon_face(roof, _corners(row, first, last)),))
        for row, joints in enumerate(rows)
        for place, (first, last) in enumerate(pairwise(joints.tolist()))
    ]
    feature = "planar-polygon" if junctions else "planar-quadrilateral"
    return cp.fit(assemble(panels, "bricks.step", junctions=junctions), feature=feature)


def _corners(row: int, first: float, last: float) -> Array:
    low, high = 0.5 * row, 0.5 * (row + 1)
    return np.array([[first, low], [last, low], [last, high], [first, high]])


@cache
def fitted(name: str) -> FitResult:
    """The fit of one of FITS: the lip NW, quadrilaterals or hexagons under a roof arched both ways, or a vault."""
    if name == "lip":
        return cp.fit(cp.read(FIXTURES / "kai_tak_nw.step"))
    with TemporaryDirectory() as folder:
        path = Path(folder) / "reference.step"
        if name == "hexagons":
            return cp.fit(cp.read(write_honeycomb(path, dome(20_000.0, 30_000.0, 0.01))), feature="planar-polygon")
        if name == "cylinders":
            return cp.fit(cp.read(write_grid(path, barrel())), feature="cylinder")
        roof = cp.read(write_grid(path, dome(20_000.0, 30_000.0)))
        return cp.fit(roof, feature="planar-quadrilateral", gap_tolerance=0.01)
