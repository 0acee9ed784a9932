"""Two files of solids through the kernel: which of the one are in the other, and how far they differ."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shape

from cadpanel.arrays import Array
from cadpanel.brep.building.mass_properties import areas_and_centroids, volume_and_centroid
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.kernel.shapes import compound_of, faces_of, shapes_of
from cadpanel.brep.proof.boundary import EDGE_POINTS, Boundary, edges_off
from cadpanel.brep.proof.inspection import boundary_of
from cadpanel.brep.proof.returned_solids import SolidBack, Solids, SolidsBack, pairs_by_place
from cadpanel.errors import ReferenceFileError

SAME_EDGES = 1e-3
"""Distance in mm up to which two edges count as one; those of splines run by another parameter than those of cones."""


class _Solid(NamedTuple):
    called: str
    shape: TopoDS_Shape


def find_back(file: Path, panels_step: Path, go_on: Callable[[], None]) -> SolidsBack:
    """See `solids_back`.

    Args:
        file: that came back.
        panels_step: as it was delivered.
        go_on: told when the next file is read, and when both are.
    """
    other = _solids(file)
    go_on()
    delivered = _solids(panels_step)
    go_on()
    numbers, others = _numbers(delivered), _numbers(other)
    pairs = pairs_by_place(numbers, others)
    return SolidsBack(
        found=tuple(
            SolidBack(
                name=delivered[one].called,
                called=other[two].called,
                apart=_apart(delivered[one].shape, other[two].shape),
                volume=float(others.volumes[two] / numbers.volumes[one] - 1.0),
                area=float(others.areas[two] / numbers.areas[one] - 1.0),
                valid=BRepCheck_Analyzer(other[two].shape).IsValid(),
            )
            for one, two in sorted(pairs.items())
        ),
        missing=tuple(solid.called for place, solid in enumerate(delivered) if place not in pairs),
        strange=tuple(solid.called for place, solid in enumerate(other) if place not in pairs.values()),
    )


def _solids(file: Path) -> list[_Solid]:
    model = load_model(file, near_origin=False)
    found = [
        _Solid(part.product or next(iter(part.names), ""), solid)
        for part in model.parts
        for solid in shapes_of(part.shape, TopAbs_SOLID)
    ]
    if not found:
        raise ReferenceFileError(f"'{file.name}' holds no solids: export the panels as solids.")
    return found


def _numbers(solids: list[_Solid]) -> Solids:
    volumes, centroids = zip(*(volume_and_centroid(solid.shape) for solid in solids), strict=True)
    return Solids(
        centroids=np.array(centroids),
        volumes=np.array(volumes),
        areas=np.array([areas_and_centroids(faces_of(solid.shape))[0].sum() for solid in solids]),
    )


def _apart(one: TopoDS_Shape, other: TopoDS_Shape) -> float:
    """How far places of the edges of either lie off the other, mm; edge by edge where both have the same ones."""
    first, second = boundary_of(one), boundary_of(other)
    off = edges_off(second, first)
    if off <= SAME_EDGES:
        return off
    return max(_off(_places(first), other), _off(_places(second), one))


def _places(boundary: Boundary) -> Array:
    """Corners, and the middle of every edge."""
    return np.concatenate([boundary.vertices, boundary.edges[:, EDGE_POINTS // 2]])


def _off(points: Array, shape: TopoDS_Shape) -> float:
    faces = compound_of(faces_of(shape))
    farthest = 0.0
    for point in points.tolist():
        measured = BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(gp_Pnt(*point)).Vertex(), faces)
        farthest = max(farthest, measured.Value() if measured.IsDone() else np.inf)
    return farthest
