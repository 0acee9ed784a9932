"""From the faces of one panel to samples: exact surface points and normals, spread evenly by area.

Each face gets a grid in its parameters whose lines are spaced evenly along the surface, with a sample in the middle of
every cell. A trimmed face keeps the samples that lie inside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt2d
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_FACE, TopAbs_IN, TopAbs_REVERSED
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from cadpanel.brep.boundary import Edge, evaluate, sample_edges, unit_normals
from cadpanel.reference.model import FaceSamples
from cadpanel.reference.polyline import cross, norm

Array = NDArray[np.float64]

SAMPLES_PER_PANEL = 125
FEWEST_SAMPLES_PER_FACE = 9
# Grid lines each way on which a face is measured before it is sampled.
MEASURING_GRID = 5
# Where the speed along the lines changes by more than this factor, the face is measured again on a finer grid.
SPEED_RATIO = 1.5
FINE_MEASURING_GRID = 25
# How closely a boundary must follow the border of the parameter range for the face to count as untrimmed,
# as a part of that range.
BORDER = 1e-6
# Tolerance of the inside test, as a part of the parameter range.
INSIDE = 1e-9
# A trimmed face's grid has this many times the wanted samples at most, where only a small part of it lies inside.
LARGEST_GRID = 40


@dataclass(frozen=True, slots=True)
class _MeasuredFace:
    """A face with what is needed to lay a grid on it.

    Attributes:
        face: the kernel's face.
        surface: its surface, placed.
        side: -1 where the face is reversed against its surface, else 1.
        bounds: (2, 2) least and largest parameter, by u and v.
        reach: two times (k + 1,): the length walked along u (and v) on the surface up to each of k even steps, mm.
        edges: its boundary.
        trimmed: whether the boundary cuts into the parameter range.
        area: mm^2.
        full_area: the area of the whole parameter range, mm^2.
    """

    face: TopoDS_Face
    surface: BRepAdaptor_Surface
    side: float
    bounds: Array
    reach: tuple[Array, Array]
    edges: tuple[Edge, ...]
    trimmed: bool
    area: float
    full_area: float


def sample_faces(shape: TopoDS_Shape) -> tuple[FaceSamples, ...]:
    """Return the samples of all faces of one panel's shape, in the shape's order, mm.

    A face without area has no samples; what to say about it is left to the caller.
    """
    faces = []
    explorer = TopExp_Explorer(shape, TopAbs_FACE)
    while explorer.More():
        faces.append(_measure(TopoDS.Face_s(explorer.Current())))
        explorer.Next()
    total = sum(face.area for face in faces)
    return tuple(_sample(face, SAMPLES_PER_PANEL * face.area / total if total > 0.0 else 0.0) for face in faces)


def _measure(face: TopoDS_Face) -> _MeasuredFace:
    """Measure one face on a coarse grid."""
    surface = BRepAdaptor_Surface(face)
    side = -1.0 if face.Orientation() == TopAbs_REVERSED else 1.0
    u_min, u_max, v_min, v_max = BRepTools.UVBounds_s(face)
    bounds = np.array([[u_min, u_max], [v_min, v_max]])
    edges = sample_edges(face, surface, bounds.mean(axis=1), side)
    reach, full_area = _measure_range(surface, bounds, MEASURING_GRID)
    if any(steps.max() > SPEED_RATIO * steps.min() for steps in map(np.diff, reach)):
        reach, full_area = _measure_range(surface, bounds, FINE_MEASURING_GRID)
    trimmed = _is_trimmed(edges, bounds)
    return _MeasuredFace(
        face=face,
        surface=surface,
        side=side,
        bounds=bounds,
        reach=reach,
        edges=edges,
        trimmed=trimmed,
        area=_exact_area(face) if trimmed else full_area,
        full_area=full_area,
    )


def _measure_range(surface: BRepAdaptor_Surface, bounds: Array, lines: int) -> tuple[tuple[Array, Array], float]:
    """Return the reach along u and v, as in `_MeasuredFace`, and the area of a parameter range."""
    middles = (np.arange(lines) + 0.5) / lines
    _, along_u, along_v = evaluate(surface, _grid(bounds, middles, middles))
    steps = (bounds[:, 1] - bounds[:, 0]) / lines
    reach_u = np.concatenate([[0.0], np.cumsum(steps[0] * norm(along_u).reshape(lines, lines).mean(axis=1))])
    reach_v = np.concatenate([[0.0], np.cumsum(steps[1] * norm(along_v).reshape(lines, lines).mean(axis=0))])
    return (reach_u, reach_v), float(norm(cross(along_u, along_v)).sum() * steps.prod())


def _is_trimmed(edges: tuple[Edge, ...], bounds: Array) -> bool:
    """Tell whether any part of the boundary runs inside the parameter range instead of along its border."""
    if not edges:
        return False
    parameters = np.concatenate([edge.parameters for edge in edges])
    margin = BORDER * (bounds[:, 1] - bounds[:, 0])
    on_border = np.abs(parameters[:, :, None] - bounds[None]) <= margin[None, :, None]
    return not bool(on_border.any(axis=(1, 2)).all())


def _exact_area(face: TopoDS_Face) -> float:
    """Return the area of a trimmed face as the kernel integrates it, mm^2."""
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties)
    return abs(float(properties.Mass()))


def _sample(face: _MeasuredFace, wanted: float) -> FaceSamples:
    """Sample one face with about `wanted` points."""
    wanted = max(wanted, FEWEST_SAMPLES_PER_FACE)
    if face.trimmed and face.area > 0.0:
        wanted *= min(max(face.full_area / face.area, 1.0), LARGEST_GRID)
    length_u, length_v = face.reach[0][-1], face.reach[1][-1]
    aspect = length_u / length_v if length_u > 0.0 and length_v > 0.0 else 1.0
    count_u = max(2, round(np.sqrt(wanted * aspect)))
    count_v = max(2, round(wanted / count_u))
    (middles_u, widths_u), (middles_v, widths_v) = (
        _even_cells(reach, count) for reach, count in zip(face.reach, (count_u, count_v), strict=True)
    )
    parameters = _grid(face.bounds, middles_u, middles_v)
    points, along_u, along_v = evaluate(face.surface, parameters)
    cells = np.outer(widths_u, widths_v).ravel() * (face.bounds[:, 1] - face.bounds[:, 0]).prod()
    normals, sizes, keep = unit_normals(along_u, along_v)
    weights = cells * sizes
    if face.trimmed:
        keep &= _inside(face, parameters)
        covered = weights[keep].sum()
        weights *= face.area / covered if covered > 0.0 else 1.0
    return FaceSamples(
        points=points[keep],
        normals=face.side * normals[keep],
        weights=weights[keep],
        edges=tuple(edge.points for edge in face.edges),
        edge_normals=tuple(edge.normals for edge in face.edges),
    )


def _grid(bounds: Array, parts_u: Array, parts_v: Array) -> Array:
    """Return the (k_u * k_v, 2) parameters of a grid given by parts (0 to 1) of the range, v running fastest."""
    u = bounds[0, 0] + parts_u * (bounds[0, 1] - bounds[0, 0])
    v = bounds[1, 0] + parts_v * (bounds[1, 1] - bounds[1, 0])
    return np.column_stack([np.repeat(u, len(v)), np.tile(v, len(u))])


def _even_cells(reach: Array, count: int) -> tuple[Array, Array]:
    """Cut a parameter range into cells equally long on the surface; return their middles and widths as parts of it."""
    if reach[-1] > 0.0:
        borders = np.interp(np.linspace(0.0, reach[-1], count + 1), reach, np.linspace(0.0, 1.0, len(reach)))
    else:
        borders = np.linspace(0.0, 1.0, count + 1)
    return 0.5 * (borders[1:] + borders[:-1]), np.diff(borders)


def _inside(face: _MeasuredFace, parameters: Array) -> NDArray[np.bool_]:
    """Tell for each of the (m, 2) parameters whether it lies inside the trimmed face."""
    classifier = BRepTopAdaptor_FClass2d(face.face, INSIDE * float(np.ptp(face.bounds)))
    return np.array([classifier.Perform(gp_Pnt2d(u, v)) == TopAbs_IN for u, v in parameters.tolist()], dtype=np.bool_)
