"""Grids that are fitted once for all tests."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from cadpanel.brep.read import read_reference
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.shape import PolygonShape
from cadpanel.reference.model import Seam
from tests.grids import dome, write_grid, write_honeycomb
from tests.known_panels import alone
from tests.shapes import folded_panel

# The feature of every panel, and the surface: its normals turn sideways, so that no panel fits its neighbour by itself.
CASES = {
    "planar-quadrilateral": (write_grid, dome(20_000.0, 30_000.0, 0.008)),
    "cylinder": (write_grid, dome(60_000.0, 6000.0, 0.003)),
    "cone": (write_grid, dome(60_000.0, 6000.0, 0.003)),
    "planar-polygon": (write_honeycomb, dome(20_000.0, 30_000.0, 0.01)),
}


def asked(name):
    """Gaps as narrow as they come, and panels that may drift as far as it takes."""
    return FitSettings(feature=name, gap_tolerance=1.0, drift_along=0.05)


@cache
def fitted(name):
    return fit(reference(name), asked(name))


def gable(open_by):
    """A folded panel, and a pentagon beside its last flange that stands off it by `open_by` mm, out of its plane."""
    fold = folded_panel(length=1500.0)
    first, last = fold.corners()[:, -1]
    along, across, up = fold.directions[-1], fold.binormals()[-1], fold.normals[-1]
    outline = np.array(
        [last, first, first + 600.0 * across, first + 900.0 * across + 750.0 * along, last + 600.0 * across]
    )
    plate = PolygonShape(name="plate", feature="planar-polygon", outline=outline + open_by * up, normal=up)
    apart = alone(fold, plate)
    return replace(apart, seams=(Seam(panels=(0, 1), edges=(3, 0), reversed=True),))


@cache
def reference(name):
    write, surface = CASES[name]
    return read(write, surface)


def read(write, *how):
    with TemporaryDirectory() as folder:
        return read_reference(write(Path(folder) / "reference.step", *how))
