"""Triangles that a shape has besides its faces, to be shown by: whether they show the faces, all of them, and no more.

Of every face, corners lie on its surface at their parameters. Its triangles look all to one side in the parameter
plane, every side of them is run through once each way or is one of the boundary, and those of the boundary are the
polygons of the face's edges, run through as the edges are, whose corners follow each other along the edge from end to
end. So triangles cover in the plane what that boundary encloses, once: winding numbers are 1 inside it and 0 outside.
In the middle of every side, of every triangle and of every edge's piece, surface and edge are within the distance that
FreeCAD asks for, and that distance is said everywhere, so that FreeCAD shows what was proved and makes nothing anew.
Nothing is compared with triangles made again: which of two diagonals a mesher takes may hang on a last bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.Poly import Poly_Triangulation
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.building.facets import NEXT, corners_of, middles, near, nodes_of, on
from cadpanel.brep.kernel.shapes import edges_of, faces_of
from cadpanel.geometry.triangles import shown_deflection

# How far corners may lie off their surface or edge, mm: the mesher takes those of edges for those of faces.
_OFF = 1e-6
# Of the distance that is asked for, and of an edge's parameters, by which what is said may differ: rounding.
_SAID_SHARE = 1e-9
# Of the products that make a triangle's area, which it has at least, or rounding might have turned it over.
_LEAST_SHARE = 1e-12

Coordinates = tuple[float, float, float]


class _Facets(NamedTuple):
    """Triangles of some faces, and where their surfaces are.

    Attributes:
        points: (n, 3) corners, mm.
        places: (n, 2) their parameters, each on its face's surface.
        corners: (t, 3) of each triangle.
        seen: (n + 3 t + t, 3) their surfaces at corners, and near the middle of sides and of triangles, mm.
    """

    points: Array
    places: Array
    corners: IntArray
    seen: Array


class _Rim(NamedTuple):
    """The polygons of edges, piece by piece.

    Attributes:
        sides: (s, 2) the corners of each piece, run through as the face beside it is to the left.
        points: (s, 3, 3) the edge where the piece begins, in its middle and where it ends, mm, as the edge runs.
        forward: (s,) whether the edge runs as the face does.
    """

    sides: IntArray
    points: Array
    forward: BoolArray


class _UntrueError(Exception):
    """Triangles are none of their faces; says why."""


def has_triangles(shape: TopoDS_Shape) -> bool:
    """Whether a shape is shown by anything that it brings with itself."""
    nowhere = TopLoc_Location()
    return any(BRep_Tool.Triangulation_s(face, nowhere) is not None for face in faces_of(shape)) or any(
        BRep_Tool.Polygon3D_s(edge, nowhere) is not None for edge in edges_of(shape)
    )


def shown_fault(shape: TopoDS_Shape) -> str:
    """What is wrong with a shape's triangles, as the rest of a sentence about them; empty if nothing is."""
    faces = faces_of(shape)
    meshes = [BRep_Tool.Triangulation_s(face, TopLoc_Location()) for face in faces]
    try:
        if not faces or any(mesh is None for mesh in meshes):
            raise _UntrueError("leave out a face")
        wanted = shown_deflection(nodes_of(meshes))
        facets, starts = _facets(faces, meshes, wanted)
        rim = _rim(faces, meshes, starts)
        _check_said(faces, meshes, wanted)
        _check_facets(facets, wanted)
        _check_rim(facets, rim, wanted)
    except _UntrueError as error:
        return str(error)
    return ""


def _facets(
    faces: Sequence[TopoDS_Face], meshes: Sequence[Poly_Triangulation], wanted: float
) -> tuple[_Facets, list[int]]:
    """The triangles of all faces, and which corner is the first of each face."""
    points, places, corners, seen, starts, count = [], [], [], [], [], 0
    for face, mesh in zip(faces, meshes, strict=True):
        placed = TopLoc_Location()
        BRep_Tool.Triangulation_s(face, placed)
        if not placed.IsIdentity() or not mesh.HasUVNodes() or not mesh.NbTriangles():
            raise _UntrueError("have no place on their face")
        own, at, named = corners_of(mesh)
        if named.min() < 0 or named.max() >= len(own):
            raise _UntrueError("have corners that there are not")
        if not np.isfinite(at).all():
            raise _UntrueError("have no place on their face")
        points.append(own)
        places.append(at)
        surface = BRepAdaptor_Surface(face)
        beside = near(surface, middles(at, named), middles(own, named), wanted)
        seen.append([on(surface, at), *np.split(beside, [3 * len(named)])])
        corners.append(named + count)
        starts.append(count)
        count += len(own)
    everywhere = np.concatenate([part[kind] for kind in range(3) for part in seen])
    return _Facets(np.concatenate(points), np.concatenate(places), np.concatenate(corners), everywhere), starts


def _rim(faces: Sequence[TopoDS_Face], meshes: Sequence[Poly_Triangulation], starts: Sequence[int]) -> _Rim:
    """The polygons of all edges of all faces, in the surfaces' own sense."""
    sides: list[tuple[int, int]] = []
    points: list[tuple[Coordinates, ...]] = []
    forward: list[bool] = []
    for face, mesh, start in zip(faces, meshes, starts, strict=True):
        for edge in edges_of(face.Oriented(TopAbs_FORWARD)):
            polygon = BRep_Tool.PolygonOnTriangulation_s(edge, mesh, TopLoc_Location())
            if polygon is None or not polygon.HasParameters() or polygon.NbNodes() < 2:
                raise _UntrueError("do not follow an edge")
            count = polygon.NbNodes()
            nodes = [polygon.Node(place) for place in range(1, count + 1)]
            if min(nodes) < 1 or max(nodes) > mesh.NbNodes():
                raise _UntrueError("have corners that there are not")
            curve = BRepAdaptor_Curve(edge)
            along = [polygon.Parameter(place) for place in range(1, count + 1)]
            first, last = curve.FirstParameter(), curve.LastParameter()
            near = _SAID_SHARE * (last - first)
            whole = abs(along[0] - first) <= near and abs(along[-1] - last) <= near
            if not whole or not all(before < after for before, after in pairwise(along)):
                raise _UntrueError("do not follow an edge")
            met = [curve.Value(where).Coord() for where in along]
            middles = [curve.Value(0.5 * (before + after)).Coord() for before, after in pairwise(along)]
            sides += [(start + before - 1, start + after - 1) for before, after in pairwise(nodes)]
            points += zip(met[:-1], middles, met[1:], strict=True)
            forward += [edge.Orientation() != TopAbs_REVERSED] * (count - 1)
    if not sides:
        raise _UntrueError("do not follow an edge")
    return _Rim(np.array(sides, dtype=np.intp), np.array(points), np.array(forward))


def _check_said(faces: Sequence[TopoDS_Face], meshes: Sequence[Poly_Triangulation], wanted: float) -> None:
    """All say the distance that FreeCAD asks for, and no edge is drawn by anything else."""
    for face, mesh in zip(faces, meshes, strict=True):
        edges = edges_of(face)
        polygons = [BRep_Tool.PolygonOnTriangulation_s(edge, mesh, TopLoc_Location()) for edge in edges]
        if not all(abs(one.Deflection() - wanted) <= _SAID_SHARE * wanted for one in (mesh, *polygons)):
            raise _UntrueError("say another distance than FreeCAD asks for")
        if any(BRep_Tool.Polygon3D_s(edge, TopLoc_Location()) is not None for edge in edges):
            raise _UntrueError("come with lines of their own")


def _check_facets(facets: _Facets, wanted: float) -> None:
    """Corners lie on surfaces, triangles look to one side and are close enough."""
    shown = np.concatenate([facets.points, middles(facets.points, facets.corners)])
    off = np.linalg.norm(facets.seen - shown, axis=-1)
    if not (off[: len(facets.points)] <= _OFF).all():
        raise _UntrueError("do not lie on their face")
    if not (off <= wanted).all():
        raise _UntrueError("lie farther from their face than they say")
    first, second, third = np.moveaxis(facets.places[facets.corners], 1, 0)
    across, along = second - first, third - first
    areas = across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0]
    if not (areas > _LEAST_SHARE * (np.abs(across) * np.abs(along)[:, ::-1]).sum(axis=-1)).all():
        raise _UntrueError("are turned over")


def _check_rim(facets: _Facets, rim: _Rim, wanted: float) -> None:
    """Polygons lie on edges, close enough, and are what bounds the triangles."""
    ends = facets.points[rim.sides]
    if not (np.linalg.norm(rim.points[:, [0, 2]] - ends, axis=-1) <= _OFF).all():
        raise _UntrueError("do not follow an edge")
    if not (np.linalg.norm(rim.points[:, 1] - ends.mean(axis=1), axis=-1) <= wanted).all():
        raise _UntrueError("lie farther from an edge than they say")
    bounds = np.where(rim.forward[:, None], rim.sides, rim.sides[:, ::-1])
    # With the boundary run through the other way, too, every side has one that goes back.
    sides = np.concatenate([*(facets.corners[:, [one, NEXT[one]]] for one in range(3)), bounds[:, ::-1]])
    ways, back = (np.sort(one @ [len(facets.points), 1]) for one in (sides, sides[:, ::-1]))
    if not ((np.diff(ways) > 0).all() and (ways == back).all()):
        raise _UntrueError("do not fill their face")
