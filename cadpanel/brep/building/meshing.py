"""Exact solids as triangles, by the CAD kernel's own mesher."""

from __future__ import annotations

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepLib import BRepLib_ToolTriangulatedShape
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.geometry.triangles import Triangles

WIDEST_ANGLE = 0.2
"""Radians between the normals of neighbouring facets, so that bends look round however small they are."""


def triangles_of(shape: TopoDS_Shape, chord: float, widest_angle: float = WIDEST_ANGLE) -> Triangles:
    """A shape's faces as triangles that lie within `chord` mm of them, with the faces' own normals."""
    BRepMesh_IncrementalMesh(shape, chord, False, widest_angle, False)
    points: list[Array] = []
    normals: list[Array] = []
    corners: list[IntArray] = []
    count = 0
    for face in faces_of(shape):
        own_points, own_normals, own_corners = _face(face)
        points.append(own_points)
        normals.append(own_normals)
        corners.append(own_corners + count)
        count += len(own_points)
    BRepTools.Clean_s(shape)
    return Triangles(points=np.concatenate(points), normals=np.concatenate(normals), corners=np.concatenate(corners))


def _face(face: TopoDS_Face) -> tuple[Array, Array, IntArray]:
    mesh = BRep_Tool.Triangulation_s(face, TopLoc_Location())
    BRepLib_ToolTriangulatedShape.ComputeNormals_s(face, mesh)
    places = range(1, mesh.NbNodes() + 1)
    points = np.array([mesh.Node(place).Coord() for place in places])
    normals = np.array([mesh.Normal(place).Coord() for place in places])
    corners = np.array([mesh.Triangle(place).Get() for place in range(1, mesh.NbTriangles() + 1)], dtype=np.intp) - 1
    # Both are those of the surface, which a reversed face looks against.
    if face.Orientation() == TopAbs_REVERSED:
        return points, -normals, corners[:, ::-1]
    return points, normals, corners
