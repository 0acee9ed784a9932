"""Aerofoil strips that come to a knife edge at the back, of any number of segments with one profile."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BezierSurface
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.kernel.splines import pole_grid

# Half the profile as a cubic, round at the front: x back, z up, as parts of the chord.
HALF = np.array([(0.0, 0.0), (0.0, 0.09), (0.5, 0.09), (1.0, 0.0)])


def aerofoil_faces(stations: Sequence[float], chord: float = 1500.0, taper: float = 0.0) -> list[TopoDS_Shape]:
    """The upper and the lower face of each segment between two stations along y, mm."""
    faces: list[TopoDS_Shape] = []
    for low, high in pairwise(stations):
        for side in (1.0, -1.0):
            rows = [
                [(x * own, station, side * z * own) for station, own in _ends(low, high, chord, taper)] for x, z in HALF
            ]
            surface = Geom_BezierSurface(pole_grid(np.array(rows)))
            faces.append(BRepBuilderAPI_MakeFace(surface, 1e-7).Face())
    return faces


def _ends(low: float, high: float, chord: float, taper: float) -> list[tuple[float, float]]:
    return [(station, chord - taper * station) for station in (low, high)]
