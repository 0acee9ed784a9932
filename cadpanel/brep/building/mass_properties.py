"""Volumes, areas and centroids as the CAD kernel integrates them. Millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array
from cadpanel.brep.kernel.shapes import faces_of


def volume_and_centroid(shape: TopoDS_Shape) -> tuple[float, Array]:
    """Of a solid: mm3, positive where its faces point outwards, and (3,) mm."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    return float(properties.Mass()), np.array(properties.CentreOfMass().Coord())


def areas_and_centroids(faces: Sequence[TopoDS_Face]) -> tuple[Array, Array]:
    """(f,) mm2 and (f, 3) mm of every face."""
    found = np.empty((len(faces), 4))
    for place, face in enumerate(faces):
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, properties)
        found[place] = properties.Mass(), *properties.CentreOfMass().Coord()
    return found[:, 0], found[:, 1:]


def area_and_centroid(shape: TopoDS_Shape) -> tuple[float, Array]:
    """Of all faces of a shape together: mm2, and (3,) mm."""
    areas, centroids = areas_and_centroids(faces_of(shape))
    return float(areas.sum()), middle_of(areas, centroids)


def middle_of(weights: Array, points: Array) -> Array:
    """(3,) the weighted mean of points; not numbers where nothing weighs."""
    with np.errstate(invalid="ignore"):
        return np.asarray(weights @ points / weights.sum())
