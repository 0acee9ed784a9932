"""Solids with the triangles that FreeCAD shows them by, so that it need not make them when it opens a document.

FreeCAD asks the kernel's mesher for triangles within a distance of the shape (`geometry.triangles.shown_deflection`).
That mesher takes those which a shape has already if they say, face by face and edge by edge, that they were made for a
distance within a tenth of that.
"""

from __future__ import annotations

import math

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_VERTEX
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Solid

from cadpanel.arrays import Array
from cadpanel.brep.building.facets import farthest, nodes_of
from cadpanel.brep.kernel.kept import kept_binary
from cadpanel.brep.kernel.shapes import edges_of, faces_of, shapes_of
from cadpanel.geometry.triangles import shown_deflection

# Between neighbouring triangles, as FreeCAD asks for it.
_WIDEST_ANGLE = math.radians(28.65)
# Shares of the distance that the mesher is asked for, the largest that does: it exceeds what it is asked for here and
# there, as it looks at the middle of triangles alone, and what is shown has to be as close as it says.
_CLOSER = (0.6, 0.3, 0.15, 0.075)
_WITHIN = 0.95


def shown_binary(solid: TopoDS_Solid) -> bytes:
    """A solid as FreeCAD keeps it, with its triangles; the solid itself is left without."""
    vertices = [BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex)).Coord() for vertex in shapes_of(solid, TopAbs_VERTEX)]
    # Vertices are among the corners of triangles, whose distance so is at least theirs.
    asked, faces = shown_deflection(np.array(vertices)), faces_of(solid)
    for share in _CLOSER:
        BRepTools.Clean_s(solid)
        BRepMesh_IncrementalMesh(solid, share * asked, False, _WIDEST_ANGLE, False)
        if max(farthest(face, _WITHIN * asked) for face in faces) <= _WITHIN * asked:
            break
    say_deflection(solid, shown_deflection(corners_of(solid)))
    data = kept_binary(solid, triangles=True)
    BRepTools.Clean_s(solid)
    return data


def corners_of(solid: TopoDS_Solid) -> Array:
    """(n, 3) the corners of a solid's triangles, mm."""
    return nodes_of([BRep_Tool.Triangulation_s(face, TopLoc_Location()) for face in faces_of(solid)])


def say_deflection(solid: TopoDS_Solid, deflection: float) -> None:
    """Have all triangles of a solid and all polygons of its edges say how close they lie, mm."""
    for face in faces_of(solid):
        mesh = BRep_Tool.Triangulation_s(face, TopLoc_Location())
        mesh.Deflection(deflection)
        for edge in edges_of(face):
            BRep_Tool.PolygonOnTriangulation_s(edge, mesh, TopLoc_Location()).Deflection(deflection)
