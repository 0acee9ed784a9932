"""Which points of a surface lie on its face, and not beyond the face's border, in a notch or a hole of it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.TopAbs import TopAbs_IN, TopAbs_OUT, TopAbs_State
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array, BoolArray
from cadpanel.brep.faces.face_patch import Patch
from cadpanel.brep.kernel import points as kernel
from cadpanel.geometry.polyline import distances_to_polylines
from cadpanel.geometry.vectors import norm, side_of

# Tolerance of the test whether a point lies inside the border of a face, as a part of the parameter range's
# shorter side.
INSIDE = 1e-9
# Segments whose crossings with a border are looked for at once: few enough to take little memory.
AT_ONCE = 64


class InsideTest:
    """The kernel's test of points of a face's parameter plane, set up once to be used again and again."""

    def __init__(self, face: TopoDS_Face, bounds: Array) -> None:
        """Set it up for a face with its least and largest parameters (2, 2), by u and v."""
        self._test = BRepTopAdaptor_FClass2d(face, INSIDE * float(np.ptp(bounds, axis=1).min()))

    def inside(self, parameters: Array) -> BoolArray:
        """Which of (m, 2) parameters lie on the face, and not on its border."""
        return self._states(parameters, lambda state: state == TopAbs_IN)

    def encloses(self, parameters: Array) -> BoolArray:
        """Which of (m, 2) parameters lie on the face or on its border."""
        return self._states(parameters, lambda state: state != TopAbs_OUT)

    def _states(self, parameters: Array, fits: Callable[[TopAbs_State], bool]) -> BoolArray:
        found = [fits(self._test.Perform(kernel.point_2d(*place))) for place in parameters.tolist()]
        return np.array(found, dtype=np.bool_)


class Trim:
    """The border of a face that does not fill its parameter range."""

    def __init__(self, patch: Patch) -> None:
        """Set up the test for the face of a patch."""
        self._patch = patch
        self._test = InsideTest(patch.face, patch.bounds)

    def encloses(self, parameters: Array) -> BoolArray:
        """Which of (m, 2) parameters lie on the face or on its border."""
        return self._test.encloses(parameters)

    def leaves_out(self, parameters: Array, clearance: float) -> bool:
        """Whether a line of (m, 2) parameters outside the face goes farther than a clearance away, and never inside.

        Args:
            parameters: each outside.
            clearance: from the border, mm. What stays closer may have been meant to run along it.
        """
        points = self._patch.points(parameters)[None]
        edges = [edge.points for edge in self._patch.edges]
        away = np.min([distances_to_polylines(points, edge[None])[0] - _height(edge) for edge in edges], axis=0)
        return bool(away.max() > clearance) and not self._crossed(parameters)

    def _crossed(self, line: Array) -> bool:
        """Whether a line in the parameter plane crosses the border."""
        starts = np.concatenate([edge.parameters[:-1] for edge in self._patch.edges])
        stops = np.concatenate([edge.parameters[1:] for edge in self._patch.edges])
        for first in range(0, len(line) - 1, AT_ONCE):
            ends = line[first : first + AT_ONCE + 1, None]
            from_line = side_of(ends[:-1], ends[1:], starts) * side_of(ends[:-1], ends[1:], stops) < 0.0
            from_border = side_of(starts, stops, ends[:-1]) * side_of(starts, stops, ends[1:]) < 0.0
            if (from_line & from_border).any():
                return True
        return False


def _height(polyline: Array) -> float:
    """How far the curve through a polyline's points may rise above its segments, mm; twice that of an arc."""
    ways = np.diff(polyline, axis=0)
    lengths = np.maximum(norm(ways), np.finfo(float).tiny)
    turns = norm(np.diff(ways / lengths[:, None], axis=0))
    return 0.25 * float((turns * np.maximum(lengths[1:], lengths[:-1])).max(initial=0.0))
