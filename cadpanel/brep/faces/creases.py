"""Tangent breaks inside a face: a spline may hold a crease that no edge of the face tells of."""

from __future__ import annotations

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_C1

from cadpanel.arrays import Array
from cadpanel.brep.faces.boundary import evaluate, unit_normals
from cadpanel.brep.faces.face_patch import Patch
from cadpanel.brep.kernel.splines import breaks_of, spans_of

# Places along a parameter line at which both sides of it are compared, and how far beside it they are looked at, as a
# part of the parameter range.
PLACES = np.linspace(0.1, 0.9, 9)
BESIDE = 1e-7
# Normals that differ by more than this are a crease, degrees; splines that were converted differ by a hundredth.
LEAST = 0.5


def crease_of(patch: Patch) -> float:
    """The largest angle by which a face breaks along one of its parameter lines, degrees; 0 where it is smooth."""
    most = 0.0
    for axis in (0, 1):
        low, high = patch.bounds[axis]
        for value in breaks_of(patch.surface, axis, GeomAbs_C1)[1:-1].tolist():
            if not low + 2.0 * BESIDE * (high - low) < value < high - 2.0 * BESIDE * (high - low):
                continue
            part = (value - low) / (high - low)
            normals = [_normals(patch, axis, part + side) for side in (-BESIDE, BESIDE)]
            cosines = np.clip(np.sum(normals[0] * normals[1], axis=-1), -1.0, 1.0)
            defined = np.linalg.norm(normals[0], axis=-1) * np.linalg.norm(normals[1], axis=-1) > 0.5
            most = max(most, float(np.degrees(np.arccos(cosines[defined])).max(initial=0.0)))
    return most if most > LEAST else 0.0


def has_breaks(surface: BRepAdaptor_Surface) -> bool:
    """Whether a surface is not C1 somewhere inside its range; only such a one can have a crease, and few do."""
    return max(spans_of(surface, GeomAbs_C1)) > 1


def _normals(patch: Patch, axis: int, part: float) -> Array:
    _, along_u, along_v = evaluate(patch.surface, patch.at(axis, np.array(part), PLACES))
    return unit_normals(along_u, along_v)[0]
