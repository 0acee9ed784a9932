"""A face as a patch of a parameter plane: its range, whether it fills that range, and pieces cut exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_Surface
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Face
from scipy.interpolate import PchipInterpolator

from cadpanel.arrays import Array
from cadpanel.brep.faces.boundary import Edge, evaluate, sample_edges, unit_normals
from cadpanel.brep.faces.parameter_range import parameter_range
from cadpanel.brep.faces.pcurve_repair import sharpen_trims
from cadpanel.brep.faces.surface_batch import SurfaceBatch
from cadpanel.brep.kernel.points import TOLERANCE

# How closely a boundary must follow the border of the parameter range for the face to count as whole, as a part of it.
BORDER = 1e-6
# How closely a patch meets itself where it is closed, mm.
CLOSED = 1e-3
# Intervals and Gauss points in each by which lengths along parameter lines are integrated.
INTERVALS = 64
GAUSS_PLACES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)


@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """One face.

    Attributes:
        face: the kernel's face.
        surface: its surface, placed.
        side: -1 where the face is reversed against its surface, else 1.
        bounds: (2, 2) least and largest parameter, by u and v.
        edges: its boundary, without the seam of a closed surface.
        whole: whether it fills its parameter range, so that any part of that range is a part of the face.
    """

    face: TopoDS_Face
    surface: BRepAdaptor_Surface
    side: float
    bounds: Array
    edges: tuple[Edge, ...]
    whole: bool

    def closed(self, axis: int) -> bool:
        """Whether the patch meets itself where parameter `axis` (0 for u, 1 for v) begins and ends."""
        places = np.array([0.25, 0.5, 0.75])
        first, last = (self.points(self.at(axis, np.array([part]), places)) for part in (0.0, 1.0))
        return bool(np.abs(first - last).max() < CLOSED)

    def points(self, parameters: Array) -> Array:
        """The points (..., 3) at (..., 2) parameters, mm."""
        return evaluate(self.surface, parameters)[0]

    def normals(self, parameters: Array) -> Array:
        """The face's unit normals (..., 3) at (..., 2) parameters; zero where the surface has none."""
        _, along_u, along_v = evaluate(self.surface, parameters)
        return self.side * unit_normals(along_u, along_v)[0]

    def at(self, axis: int, along: Array, across: Array) -> Array:
        """The (..., 2) parameters with `along` as parameter `axis` and `across` as the other, as parts of the range."""
        parts = np.stack(np.broadcast_arrays(along, across), axis=-1)
        if axis == 1:
            parts = parts[..., ::-1]
        return self.bounds[:, 0] + parts * (self.bounds[:, 1] - self.bounds[:, 0])


def patch_of(face: TopoDS_Face) -> Patch:
    """Measure a face, its border laid along its edges first where it is coarse."""
    sharpen_trims(face)
    surface = BRepAdaptor_Surface(face)
    side = -1.0 if face.Orientation() == TopAbs_REVERSED else 1.0
    bounds = parameter_range(face)
    edges = tuple(sample_edges([face], SurfaceBatch([surface]), bounds[None], np.array([side]))[0])
    return Patch(face=face, surface=surface, side=side, bounds=bounds, edges=edges, whole=_is_whole(edges, bounds))


def _is_whole(edges: tuple[Edge, ...], bounds: Array) -> bool:
    if not edges:
        return True
    parameters = np.concatenate([edge.parameters for edge in edges])
    margin = BORDER * (bounds[:, 1] - bounds[:, 0])
    on_border = np.abs(parameters[:, :, None] - bounds[None]) <= margin[None, :, None]
    return bool(on_border.any(axis=(1, 2)).all())


def rectangle(patch: Patch, u_range: tuple[float, float], v_range: tuple[float, float]) -> TopoDS_Face:
    """The part of a whole patch over a rectangle of its parameters: the same surface, exactly."""
    return _sided(BRepBuilderAPI_MakeFace(geometry(patch), *u_range, *v_range, TOLERANCE).Face(), patch)


def geometry(patch: Patch) -> Geom_Surface:
    """The patch's surface, placed, as the kernel's geometry."""
    return BRep_Tool.Surface_s(patch.face)


def _sided(face: TopoDS_Face, patch: Patch) -> TopoDS_Face:
    return TopoDS.Face_s(face.Reversed()) if patch.side < 0.0 else face


def lengths_along(patch: Patch, axis: int, across: Array) -> Array:
    """Lengths walked along parameter `axis` at INTERVALS + 1 even steps of the range, mm.

    Args:
        patch: a whole patch.
        axis: 0 for u, 1 for v.
        across: (k,) where on the other parameter, as parts of its range.

    Returns:
        (k, INTERVALS + 1), from 0 to the whole length.
    """
    starts = np.arange(INTERVALS) / INTERVALS
    along = (starts[:, None] + (0.5 + 0.5 * GAUSS_PLACES) / INTERVALS).ravel()
    _, along_u, along_v = evaluate(patch.surface, patch.at(axis, along[None], across[:, None]))
    speeds = np.linalg.norm(along_u if axis == 0 else along_v, axis=-1) * np.ptp(patch.bounds[axis])
    steps = (speeds.reshape(len(across), INTERVALS, -1) * GAUSS_WEIGHTS).sum(axis=-1) * 0.5 / INTERVALS
    return np.concatenate([np.zeros((len(across), 1)), np.cumsum(steps, axis=1)], axis=1)


def equal_parts(reach: Array, parts: Array) -> Array:
    """Where, as parts of the parameter range, a length that grows as (INTERVALS + 1,) `reach` has its (k,) `parts`.

    The length between the steps is met by the monotone cubic through them (it has speeds that never turn back).
    """
    even = np.linspace(0.0, 1.0, len(reach))
    rising = np.concatenate([[True], np.diff(reach) > 0.0])
    return np.asarray(PchipInterpolator(reach[rising] / reach[-1], even[rising])(parts), dtype=np.float64)
