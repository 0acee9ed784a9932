"""Fits whose panels meet all along their edges: a lip, and three grids that fit exactly or nearly so."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import cadpanel as cp
from cadpanel.arrays import Array
from cadpanel.fitting.result import FitResult
from tests.grids import dome, write_grid, write_honeycomb
from tests.reference_shapes import Surface

FIXTURES = Path(__file__).parents[1] / "fixtures"
FITS = ("lip", "quadrilaterals", "cylinders", "hexagons")


def barrel() -> Surface:
    """A vault whose rows are straight: cylinders fit exactly."""

    def surface(u: Array, v: Array) -> Array:
        turn = 0.8 * (np.asarray(v) - 0.5)
        return np.stack([1500.0 * np.asarray(u), 5000.0 * np.sin(turn), 5000.0 * np.cos(turn)], axis=-1)

    return surface


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
