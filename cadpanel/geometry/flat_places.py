"""Places on a flat pattern and the same places on the panel, patch by patch. Millimetres and radians.

The generatrices of a cone lie in the plane where rolling puts them (see `flat_curves`): with x and y the way across and
along the patch's first ruling, k the sine of the half angle and rho the distance of the ruling's point from the axis,
the height along the generatrix and the angle about the axis are

    height = (2 rho y + k (x^2 + y^2)) / (rho + s hypot(k x, rho + k y)),    k phi = atan2(s k x, s (rho + k y)),

s the sign of rho; with k = 0 that is y and x / rho.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import AxisFrame, axis_frame
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.unroll import FlatPattern
from cadpanel.geometry.unroll_trays import flat_tray
from cadpanel.geometry.vectors import cross


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatPlace:
    """One patch of a panel, on its skin and in the plane.

    Attributes:
        origin: (2,) where the point of its first ruling lies in the plane.
        along: (2,) the way of that ruling there.
        point, direction, normal: (3,) of that ruling on the skin.
        frame: the skin's patch seen from its axis; None of a plane.
        offset: of the surface that is unrolled, mm along the skin's normals.
    """

    origin: Array
    along: Array
    point: Array
    direction: Array
    normal: Array
    frame: AxisFrame | None
    offset: float

    def on_skin(self, places: Array) -> tuple[Array, Array]:
        """Points of the skin and its unit normals there, (m, 3) each, at places (m, 2) of the plane."""
        x, y = ((places - self.origin) @ way for way in (self._across, self.along))
        if self.frame is None:
            points = self.point + np.outer(y, self.direction) + np.outer(x, cross(self.direction, self.normal))
            return points, np.broadcast_to(self.normal, points.shape)
        k, rho = self._taper
        side = np.sign(rho)
        reach = side * np.hypot(k * x, rho + k * y)
        heights = (2.0 * rho * y + k * (x**2 + y**2)) / (rho + reach)
        angles = x / rho if k == 0.0 else np.arctan2(side * k * x, side * (rho + k * y)) / k
        return self.frame.points(angles, heights), self.frame.normals(angles)

    def in_plane(self, points: Array, lift: float) -> Array:
        """Places (m, 2) of the plane, of points (m, 3) on the surface at `lift` mm along the skin's normals."""
        if self.frame is None:
            way = points - self.point
            x, y = way @ cross(self.direction, self.normal), way @ self.direction
        else:
            k, rho = self._taper
            cosine = np.cos(self.frame.half_angle)
            way = points - self.frame.center
            heights = (way @ self.frame.axis + lift * k) / cosine
            side = np.sign(rho)
            phi = np.arctan2(side * (way @ self.frame.tangential), side * (way @ self.frame.radial))
            theta = k * phi
            x = heights * np.sin(theta) + rho * phi * np.sinc(theta / np.pi)
            y = heights * np.cos(theta) - 0.5 * rho * theta * phi * np.sinc(0.5 * theta / np.pi) ** 2
        placed: Array = self.origin + np.outer(x, self._across) + np.outer(y, self.along)
        return placed

    def normal_radii(self, places: Array) -> Array:
        """(m,) radius of the unrolled surface about the axis along its normal; infinite on a plane."""
        if self.frame is None:
            return np.full(len(places), np.inf)
        k, rho = self._taper
        x, y = ((places - self.origin) @ way for way in (self._across, self.along))
        radii: Array = np.sign(rho) * np.hypot(k * x, rho + k * y) / np.cos(self.frame.half_angle)
        return radii

    @property
    def _across(self) -> Array:
        return np.array([self.along[1], -self.along[0]])

    @property
    def _taper(self) -> tuple[float, float]:
        """Sine of the half angle, and the unrolled surface's distance from the axis at the first ruling's point."""
        assert self.frame is not None
        cosine = float(np.cos(self.frame.half_angle))
        return float(np.sin(self.frame.half_angle)), self.frame.level_radius + self.offset * cosine


def flat_places(shape: Panel, pattern: FlatPattern, offset: float) -> tuple[FlatPlace, ...]:
    """The patches of a panel, of which the surface at `offset` mm along the skin's normals was unrolled."""
    if isinstance(shape, TrayShape):
        return _tray_places(shape, offset)
    points, directions, normals = shape.rulings()
    if not shape.four_sided:
        # Polygons lie with their first edge, which is that of their one ruling, along x.
        along = cross(normals[0], directions[0])
        origin, way = pattern.curves.start[0], np.array([0.0, 1.0])
        return (_place((origin, way), (points[0], along, normals[0]), None, offset),)
    found = []
    for index, patch in enumerate(shape.patches):
        row, ruling = pattern.owners.index(index), (points[index], directions[index], normals[index])
        frame = axis_frame(*ruling, patch) if isinstance(patch, ConePatch) else None
        found.append(_place((pattern.curves.origin[row], pattern.curves.along[row]), ruling, frame, offset))
    return tuple(found)


def _tray_places(shape: TrayShape, offset: float) -> tuple[FlatPlace, ...]:
    """The flat part from its first corner; of each fold the cylinder and the leg, from the lines where they begin."""
    plan, flat = shape.plan, flat_tray(shape.offset(offset))
    rulings = [(plan.corners[0], cross(plan.normal, plan.along[0]), plan.normal)]
    for edge in np.flatnonzero(plan.folded).tolist():
        along, away = plan.along[edge], plan.away[edge]
        bent = plan.starts[edge] + shape.radius * (away - plan.normal)
        rulings += [(plan.starts[edge], along, plan.normal), (bent, along, away)]
    return tuple(
        _place(plane, ruling, axis_frame(*ruling, patch) if isinstance(patch, ConePatch) else None, offset)
        for plane, ruling, patch in zip(zip(flat.origins, flat.ways, strict=True), rulings, shape.patches, strict=True)
    )


def _place(
    plane: tuple[Array, Array], ruling: tuple[Array, Array, Array], frame: AxisFrame | None, offset: float
) -> FlatPlace:
    return FlatPlace(
        origin=plane[0],
        along=plane[1],
        point=ruling[0],
        direction=ruling[1],
        normal=ruling[2],
        frame=frame,
        offset=offset,
    )
