"""Points and first derivatives on the surfaces of many faces at once.

B-spline and Bezier surfaces, which is what references are made of, give their poles once and are evaluated together in
NumPy; planes are, too, and the kernel evaluates all others point by point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.Geom import Geom_BSplineSurface, Geom_Surface
from OCP.GeomAbs import GeomAbs_BezierSurface, GeomAbs_BSplineSurface, GeomAbs_Plane
from OCP.GeomConvert import GeomConvert
from OCP.gp import gp_Pln, gp_Pnt, gp_Vec

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.kernel.splines import numbers, surface_poles
from cadpanel.geometry.spline_surface import SplineSurface, SplineSurfaces


class SurfaceBatch:
    """The surfaces of F faces, to be evaluated together."""

    __slots__ = ("_group_of", "_groups", "_others", "_periods", "_place_of")

    def __init__(self, surfaces: Sequence[BRepAdaptor_Surface]) -> None:
        """Take the poles of those that have some.

        Arguments:
            surfaces: one a face, placed and trimmed.
        """
        self._others = tuple(surfaces)
        self._group_of = np.full(len(surfaces), -1)
        self._place_of = np.zeros(len(surfaces), dtype=np.intp)
        self._periods = np.full((len(surfaces), 2, 2), [0.0, np.inf])
        # Faces cut from one surface share its poles; the kernel's handles are kept, or others could take their place.
        taken: dict[tuple[int, tuple[float, ...]], tuple[Geom_Surface, Geom_BSplineSurface, SplineSurface]] = {}
        members: dict[tuple[int, int, int], list[SplineSurface]] = {}
        kinds: list[tuple[int, int, int]] = []
        for face, surface in enumerate(surfaces):
            if surface.GetType() not in (GeomAbs_BSplineSurface, GeomAbs_BezierSurface):
                continue
            handle = surface.Surface().Surface()
            place = (id(handle), _placement(surface))
            if place not in taken:
                found = _spline(surface)
                taken[place] = (handle, found, _plain(found))
            _, spline, whole = taken[place]
            own = _trimmed(whole, surface, spline)
            for way, periodic in enumerate((spline.IsUPeriodic(), spline.IsVPeriodic())):
                if periodic:
                    self._periods[face, way] = own.bounds[way, 0], np.ptp(own.bounds[way])
            kind = (*own.degrees, own.poles.shape[-1])
            if kind not in members:
                kinds.append(kind)
            group = members.setdefault(kind, [])
            self._group_of[face], self._place_of[face] = kinds.index(kind), len(group)
            group.append(own)
        self._groups = [SplineSurfaces(members[kind]) for kind in kinds]

    def evaluate(self, faces: IntArray, parameters: Array) -> tuple[Array, Array, Array]:
        """The points and the two first derivatives, each (..., 3) in mm.

        Arguments:
            faces: (...) the face of each point.
            parameters: (..., 2) where on its surface.
        """
        owners, flat = np.broadcast_to(faces, parameters.shape[:-1]).ravel(), parameters.reshape(-1, 2)
        groups = self._group_of[owners]
        values = np.empty((len(flat), 3, 3))
        for group, splines in enumerate(self._groups):
            # Mostly there is one group only, and nothing to pick out.
            chosen = slice(None) if (groups == group).all() else groups == group
            own = owners[chosen]
            values[chosen] = splines.evaluate(self._place_of[own], self._in_period(own, flat[chosen]))
        for face in np.unique(owners[groups < 0]).tolist():
            own = owners == face
            values[own] = kernel_values(self._others[face], flat[own])
        shaped = values.reshape(*parameters.shape[:-1], 3, 3)
        return shaped[..., 0, :], shaped[..., 1, :], shaped[..., 2, :]

    def slopes_on_grids(self, faces: IntArray, u: Array, v: Array) -> tuple[Array, Array]:
        """The two first derivatives on a grid of each of some faces, each (k, n, m, 3) in mm.

        Args:
            faces: (k,) which.
            u: (k, n) parameters along u of each grid.
            v: (k, m) the same along v.
        """
        groups = self._group_of[faces]
        values = np.empty((*u.shape, v.shape[1], 2, 3))
        for group, splines in enumerate(self._groups):
            chosen = np.flatnonzero(groups == group)
            own = faces[chosen]
            along = [_within(at[chosen], self._periods[own, None, way]) for way, at in enumerate((u, v))]
            values[chosen] = splines.slopes_on_grids(self._place_of[own], *along)
        for place in np.flatnonzero(groups < 0).tolist():
            grid = np.stack(np.meshgrid(u[place], v[place], indexing="ij"), axis=-1).reshape(-1, 2)
            values[place] = kernel_values(self._others[faces[place]], grid)[:, 1:].reshape(values.shape[1:])
        return values[..., 0, :], values[..., 1, :]

    def _in_period(self, owners: IntArray, parameters: Array) -> Array:
        """The parameters, those of periodic surfaces within the period that has the poles."""
        return _within(parameters, self._periods[owners])


def _within(parameters: Array, periods: Array) -> Array:
    """Parameters within periods (..., 2), each a start and a length, infinite where there is none."""
    start, length = np.moveaxis(periods, -1, 0)
    if np.isinf(length).all():
        return parameters
    whole = np.where(np.isfinite(length), length, 1.0)
    return np.where(np.isfinite(length), start + np.remainder(parameters - start, whole), parameters)


def kernel_values(surface: BRepAdaptor_Surface, parameters: Array) -> Array:
    """(p, 3, 3) the point and the derivatives by u and by v, mm, at (p, 2) parameters.

    On a plane they are known; on any other surface the kernel is asked for one after the other.
    """
    if surface.GetType() == GeomAbs_Plane:
        return _plane_values(surface.Plane(), parameters)
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    values: list[float] = []
    for u, v in parameters.tolist():
        surface.D1(u, v, point, along_u, along_v)
        values += point.Coord()
        values += along_u.Coord()
        values += along_v.Coord()
    return np.array(values, dtype=np.float64).reshape(-1, 3, 3)


def _plane_values(plane: gp_Pln, parameters: Array) -> Array:
    """The same on a plane."""
    along_u, along_v = plane.XAxis().Direction().Coord(), plane.YAxis().Direction().Coord()
    values = np.empty((len(parameters), 3, 3))
    values[:, 0] = parameters[:, :1] * along_u + parameters[:, 1:] * along_v + plane.Location().Coord()
    values[:, 1], values[:, 2] = along_u, along_v
    return values


def _placement(surface: BRepAdaptor_Surface) -> tuple[float, ...]:
    """The 12 numbers of where a face's surface is placed."""
    placed = surface.Trsf()
    return tuple(placed.Value(row, column) for row in (1, 2, 3) for column in (1, 2, 3, 4))


def _spline(surface: BRepAdaptor_Surface) -> Geom_BSplineSurface:
    """The placed B-spline under a face on a B-spline or Bezier surface."""
    if surface.GetType() == GeomAbs_BSplineSurface:
        return surface.BSpline()
    return GeomConvert.SurfaceToBSplineSurface_s(surface.Bezier())


def _plain(spline: Geom_BSplineSurface) -> SplineSurface:
    """The same as arrays, its periods cut open; the bounds are those of the whole surface."""
    if spline.IsUPeriodic() or spline.IsVPeriodic():
        spline = cast(Geom_BSplineSurface, spline.Copy())
        spline.SetUNotPeriodic()
        spline.SetVNotPeriodic()
    return SplineSurface(
        degrees=(spline.UDegree(), spline.VDegree()),
        knots=(numbers(spline.UKnotSequence()), numbers(spline.VKnotSequence())),
        poles=surface_poles(spline),
        bounds=np.array(spline.Bounds()).reshape(2, 2),
    )


def _trimmed(whole: SplineSurface, surface: BRepAdaptor_Surface, spline: Geom_BSplineSurface) -> SplineSurface:
    """A surface with the bounds of a face on it; in a way in which it is periodic, with those of a whole period."""
    bounds = np.array(
        [
            [surface.FirstUParameter(), surface.LastUParameter()],
            [surface.FirstVParameter(), surface.LastVParameter()],
        ]
    )
    periodic = np.array([spline.IsUPeriodic(), spline.IsVPeriodic()])
    bounds[periodic] = whole.bounds[periodic]
    return replace(whole, bounds=bounds)
