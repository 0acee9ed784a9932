"""How far triangles of a face lie from its surface: looked at in the middle of their sides and of themselves. mm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Plane
from OCP.gp import gp_Pnt, gp_Vec
from OCP.Poly import Poly_Triangulation
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array, IntArray

NEXT = [1, 2, 0]
"""The corner behind each of a triangle's."""


def triangles_of(face: TopoDS_Face) -> Poly_Triangulation | None:
    """What a face is shown by, if by anything."""
    mesh: Poly_Triangulation | None = BRep_Tool.Triangulation_s(face, TopLoc_Location())
    return mesh


def nodes_of(meshes: Sequence[Poly_Triangulation]) -> Array:
    """(n, 3) the corners of all triangles, mm."""
    return np.array([mesh.Node(place).Coord() for mesh in meshes for place in range(1, mesh.NbNodes() + 1)])


def corners_of(mesh: Poly_Triangulation) -> tuple[Array, Array, IntArray]:
    """(n, 3) corners, mm, (n, 2) their parameters, and (t, 3) which of them each triangle has."""
    named = np.array([mesh.Triangle(place).Get() for place in range(1, mesh.NbTriangles() + 1)], dtype=np.intp) - 1
    places = np.array([mesh.UVNode(place).Coord() for place in range(1, mesh.NbNodes() + 1)])
    return nodes_of([mesh]), places, named


def middles(values: Array, named: IntArray) -> Array:
    """(3 t + t, k) the means of values (n, k) at both ends of the sides, and at the corners, of triangles (t, 3)."""
    met = values[named]
    return np.concatenate([0.5 * (met + met[:, NEXT]).reshape(-1, values.shape[1]), met.mean(axis=1)])


def near(surface: BRepAdaptor_Surface, places: Array, shown: Array, within: float) -> Array:
    """(n, 3) places of a surface near points (n, 3), mm: at parameters (n, 2), or a step nearer where that is far.

    In the middle of a long side aslant over a cone the middle of the parameters lies beside the nearest place.
    """
    seen = on(surface, places)
    far = np.flatnonzero(np.linalg.norm(seen - shown, axis=-1) > within)
    if len(far):
        step = np.linalg.pinv(_rates(surface, places[far])) @ (shown - seen)[far, :, None]
        seen[far] = on(surface, places[far] + step[..., 0])
    return seen


def on(surface: BRepAdaptor_Surface, places: Array) -> Array:
    """(n, 3) where a surface is at parameters (n, 2), mm."""
    if surface.GetType() == GeomAbs_Plane:
        plane = surface.Plane()
        axes = np.array([plane.XAxis().Direction().Coord(), plane.YAxis().Direction().Coord()])
        return np.asarray(places @ axes + plane.Location().Coord())
    return np.array([surface.Value(u, v).Coord() for u, v in places.tolist()])


def _rates(surface: BRepAdaptor_Surface, places: Array) -> Array:
    """(n, 3, 2) how a surface's places follow its parameters (n, 2), mm."""
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    rates = np.empty((len(places), 3, 2))
    for row, (u, v) in zip(rates, places.tolist(), strict=True):
        surface.D1(u, v, point, along_u, along_v)
        row[:, 0], row[:, 1] = along_u.Coord(), along_v.Coord()
    return rates


def farthest(face: TopoDS_Face, within: float) -> float:
    """How far a face's triangles lie from its surface, mm; told no closer than it takes to be within a distance."""
    mesh, surface = triangles_of(face), BRepAdaptor_Surface(face)
    if mesh is None or surface.GetType() == GeomAbs_Plane:
        return 0.0
    points, places, named = corners_of(mesh)
    shown = middles(points, named)
    return float(np.linalg.norm(near(surface, middles(places, named), shown, within) - shown, axis=-1).max())
