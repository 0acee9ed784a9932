"""How a face is curved: flat, developable or doubly curved, by numbers that are measured on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from OCP.gp import gp_Pnt, gp_Vec

from cadpanel.arrays import Array
from cadpanel.brep.faces.face_patch import Patch
from cadpanel.brep.faces.inside_test import InsideTest
from cadpanel.brep.skin.face_cleanup import SkinFace
from cadpanel.geometry.vectors import cross, dot, norm

Class = Literal["flat", "developable", "doubly curved"]

FLAT = 0.1
"""A face is flat when all of it lies this close to one plane, mm."""
DEVELOPABLE = 1e-4
"""A face is developable when its total Gaussian curvature is no more than this, steradians: so much of the unit sphere
its normals cover, and a true cone's or cylinder's cover none. A square of 0.6 by 0.6 degrees is 1e-4."""
GRID = 31
DEGENERATE = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class Curvature:
    """What was measured on a face.

    Attributes:
        kind: the class that follows from the numbers below.
        off_plane: largest distance of the face to the plane that fits it best, mm.
        total_gaussian: integral of the absolute Gaussian curvature, steradians.
        smallest_radius: 1 over the largest principal curvature, mm; infinite on a plane.
    """

    kind: Class
    off_plane: float
    total_gaussian: float
    smallest_radius: float


def curvature_of(face: SkinFace) -> Curvature:
    """Measure a face on a grid of GRID x GRID points of its parameter range, where they lie inside."""
    points = np.concatenate([face.samples.points, *face.samples.edges])
    off_plane = _off_plane(points)
    gaussian, largest, areas = _principal(face.patch)
    total = float(np.abs(gaussian) @ areas) / max(float(areas.sum()), np.finfo(float).tiny) * face.area
    bend = float(largest.max(initial=0.0))
    kind: Class = "flat" if off_plane <= FLAT else "developable" if total <= DEVELOPABLE else "doubly curved"
    return Curvature(
        kind=kind,
        off_plane=off_plane,
        total_gaussian=total,
        smallest_radius=1.0 / bend if bend > DEGENERATE else np.inf,
    )


def _off_plane(points: Array) -> float:
    offsets = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(offsets, full_matrices=False)
    return float(np.abs(offsets @ axes[-1]).max())


def _principal(patch: Patch) -> tuple[Array, Array, Array]:
    """Gaussian curvature (m,), largest principal curvature (m,) and area (m,) of the cells whose middles lie inside."""
    bent = bending_of(patch, GRID)
    (e, f, g), (long, mixed, short) = bent.first, bent.second
    determinant = e * g - f * f
    gaussian = (long * short - mixed * mixed) / determinant
    mean = 0.5 * (e * short - 2.0 * f * mixed + g * long) / determinant
    root = np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
    return gaussian, np.abs(mean) + root, bent.areas


@dataclass(frozen=True, slots=True, kw_only=True)
class Bending:
    """How a face bends, at m points spread evenly over its parameters.

    Attributes:
        points: (m, 3) mm.
        normals: (m, 3) of unit length, to the side of its surface's own.
        along: (2, m, 3) the derivatives by both parameters.
        first, second: (3, m) coefficients of the two fundamental forms.
        areas: (m,) of the cells around the points, in units that are the same for all of them.
    """

    points: Array
    normals: Array
    along: Array
    first: Array
    second: Array
    areas: Array

    def turn(self, ways: Array) -> Array:
        """(m, 3) by how much the normal turns on (m, 3) ways along the tangent planes, per length, 1/mm."""
        (e, f, g), (long, mixed, short) = self.first, self.second
        determinant = e * g - f * f
        by_u, by_v = (dot(ways, along) for along in self.along)
        u, v = (g * by_u - f * by_v) / determinant, (e * by_v - f * by_u) / determinant
        on_u, on_v = long * u + mixed * v, mixed * u + short * v
        p, q = (g * on_u - f * on_v) / determinant, (e * on_v - f * on_u) / determinant
        turned: Array = -(p[:, None] * self.along[0] + q[:, None] * self.along[1])
        return turned


def joined(parts: Sequence[Bending]) -> Bending:
    """The points of several faces as one."""
    return Bending(
        points=np.concatenate([one.points for one in parts]),
        normals=np.concatenate([one.normals for one in parts]),
        along=np.concatenate([one.along for one in parts], axis=1),
        first=np.concatenate([one.first for one in parts], axis=1),
        second=np.concatenate([one.second for one in parts], axis=1),
        areas=np.concatenate([one.areas for one in parts]),
    )


def bending_of(patch: Patch, count: int) -> Bending:
    """Measure a face in the middles of count x count cells of its parameter range, where they lie inside."""
    parts = (np.arange(count) + 0.5) / count
    parameters = patch.at(0, np.repeat(parts, count), np.tile(parts, count))
    if not patch.whole:
        parameters = parameters[InsideTest(patch.face, patch.bounds).inside(parameters)]
    points, su, sv, suu, svv, suv = _derivatives(patch, parameters)
    normals = cross(su, sv)
    sizes = norm(normals)
    good = sizes > DEGENERATE * max(float(sizes.max(initial=0.0)), DEGENERATE)
    points, su, sv, suu, svv, suv, sizes = (values[good] for values in (points, su, sv, suu, svv, suv, sizes))
    normals = normals[good] / sizes[:, None]
    return Bending(
        points=points,
        normals=normals,
        along=np.array([su, sv]),
        first=np.array([dot(a, b) for a, b in ((su, su), (su, sv), (sv, sv))]),
        second=np.array([dot(twice, normals) for twice in (suu, suv, svv)]),
        areas=sizes,
    )


def _derivatives(patch: Patch, parameters: Array) -> tuple[Array, Array, Array, Array, Array, Array]:
    """Points, first and second derivatives Su, Sv, Suu, Svv, Suv, each (m, 3)."""
    point, vectors = gp_Pnt(), tuple(gp_Vec() for _ in range(5))
    numbers = []
    for u, v in parameters.tolist():
        patch.surface.D2(u, v, point, *vectors)
        numbers.append([point.Coord(), *(vector.Coord() for vector in vectors)])
    values = np.array(numbers, dtype=np.float64).reshape(-1, 6, 3)
    return values[:, 0], values[:, 1], values[:, 2], values[:, 3], values[:, 4], values[:, 5]
