"""What a shape read from a file really is, found out through the kernel; and files whose shapes are looked at so."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepTools import BRepTools
from OCP.GeomAbs import GeomAbs_Circle, GeomAbs_Cone, GeomAbs_Cylinder, GeomAbs_Ellipse, GeomAbs_Line, GeomAbs_Plane
from OCP.gp import gp_Ax2, gp_Dir, gp_Identity, gp_Pnt, gp_Translation
from OCP.TopAbs import TopAbs_EDGE, TopAbs_REVERSED, TopAbs_SHELL, TopAbs_SOLID, TopAbs_VERTEX, TopAbs_WIRE
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cadpanel.arrays import Array
from cadpanel.brep.building.mass_properties import areas_and_centroids, middle_of, volume_and_centroid
from cadpanel.brep.building.sheet import volume_of
from cadpanel.brep.kernel.shapes import edges_of, faces_of, packed, shapes_of, unpacked
from cadpanel.brep.proof.boundary import EDGE_POINTS, Boundary
from cadpanel.brep.proof.shape_facts import FACE_KINDS, SILENT, ShapeFacts
from cadpanel.brep.step.file import OpenStep, open_step
from cadpanel.brep.step.properties import Stated
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.sampled_curves import POINTS

# By so many radians nothing as large as a panel is turned.
_NO_TURN = 1e-13
_EDGE_POINTS = 24
RIM_POINTS = 2 * _EDGE_POINTS
"""Points on a rim, which is two edges."""
_ROUND = {GeomAbs_Cone: "cone", GeomAbs_Cylinder: "cylinder"}


Point = tuple[float, float, float]
"""Coordinates, mm."""
Packed = list[tuple[str, bytes, Stated]]
"""Named shapes in the kernel's binary form, which keeps every digit, and what the file says of them besides."""


class Inspector:
    """Inspects the shapes of a file, or packs them for another one to inspect. It keeps the file open in between."""

    def __init__(self) -> None:
        self._path: Path | None = None
        self._opened: OpenStep | None = None
        self._stated: dict[str, Stated] = {}

    def open(self, path: Path) -> int:
        """Read a file; returns the number of its shapes.

        Raises:
            DeliveryError: it cannot be read.
        """
        self.close()
        return len(self._shapes(path))

    def facts(self, path: Path, places: Iterable[int]) -> list[ShapeFacts]:
        """Facts of some of the file's shapes."""
        shapes = self._shapes(path)
        return [inspect(*shapes[place], self._stated.get(shapes[place][0], SILENT)) for place in places]

    def pack(self, path: Path, places: Iterable[int]) -> Packed:
        """Some of the file's shapes."""
        shapes = self._shapes(path)
        return [
            (shapes[place][0], packed(shapes[place][1]), self._stated.get(shapes[place][0], SILENT)) for place in places
        ]

    def common(self, path: Path, pairs: Iterable[tuple[int, int]]) -> list[float]:
        """Volume that pairs of the file's shapes share, mm3."""
        shapes = self._shapes(path)
        return [abs(volume_of(BRepAlgoAPI_Common(shapes[i][1], shapes[j][1]).Shape())) for i, j in pairs]

    def close(self) -> None:
        """Keep nothing."""
        self._path = self._opened = None
        self._stated = {}

    def _shapes(self, path: Path) -> list[tuple[str, TopoDS_Shape]]:
        """Those of the file; it is read again if another one was opened in between."""
        if self._opened is None or self._path != path:
            self._path, self._opened = path, open_step(path, properties=True)
            self._stated = self._opened.stated()
        return self._opened.shapes


def inspect_packed(shapes: Packed) -> list[ShapeFacts]:
    """Facts of shapes that another one has packed: they do not depend on who finds them."""
    return [inspect(name, unpacked(data), stated) for name, data, stated in shapes]


def inspect(name: str, shape: TopoDS_Shape, stated: Stated = SILENT) -> ShapeFacts:
    """Measure one shape of which a file says something; slow only in the kernel's check, 1 to 6 ms, and areas, 2 ms."""
    shape, placed = _at_home(shape)
    faces = faces_of(shape)
    surfaces = [_surface(face) for face in faces]
    kinds = Counter(kind for kind, _ in surfaces)
    edges = _edges_with_faces(faces)
    shared = [_straight(edge, *(surfaces[face][1] for face in edge.faces)) for edge in edges if len(edge.faces) == 2]
    straight = [found for found in shared if found is not None]
    curves = [_piece(edge) for edge in edges]
    known = np.array([curve is not None for curve in curves], dtype=bool)
    pieces = [curve for curve in curves if curve is not None]
    solids = len(shapes_of(shape, TopAbs_SOLID))
    areas, centroids = areas_and_centroids(faces)
    volume, middle = volume_and_centroid(shape) if solids else (0.0, middle_of(areas, centroids))
    rims = [wire for face in faces for wire in _inner_wires(face)]
    on_rims = TopTools_IndexedMapOfShape()
    for wire in rims:
        TopExp.MapShapes_s(wire, TopAbs_EDGE, on_rims)
    boundary = _boundary(shape, edges, [numbers for _, numbers in surfaces])
    return ShapeFacts(
        name=name,
        placed=placed,
        solids=solids,
        shells=len(shapes_of(shape, TopAbs_SHELL)),
        valid=BRepCheck_Analyzer(shape, True, False, True).IsValid(),
        closed=all(len(edge.faces) == 2 for edge in edges),
        face_kinds={kind: kinds[kind] for kind in FACE_KINDS},
        volume=volume,
        areas=areas,
        centroid=middle,
        stated=stated,
        straight_edges=np.array([ends for ends, _ in straight]).reshape(-1, 2, 3),
        edge_surfaces=np.array([pair for _, pair in straight]).reshape(-1, 2, 9),
        vertices=boundary.vertices,
        pieces=_pieces([curve for curve, _ in pieces]),
        piece_ends=np.array([ends for _, ends in pieces]).reshape(-1, 2, 3),
        inner=np.array([on_rims.Contains(edge.edge) for edge in edges], dtype=bool)[known],
        piece_faces=boundary.edge_faces[known],
        other_edges=boundary.edge_faces[~known],
        other_points=_sampled([edge for edge, curve in zip(edges, curves, strict=True) if curve is None]),
        rims=np.array([_rim(wire) for wire in rims]).reshape(-1, RIM_POINTS, 3),
        surfaces=boundary.surfaces,
        boundary=boundary,
    )


def boundary_of(shape: TopoDS_Shape) -> Boundary:
    """What bounds a shape, half a millisecond a panel."""
    faces = faces_of(shape)
    return _boundary(shape, _edges_with_faces(faces), [_surface(face)[1] for face in faces])


class _Edge(NamedTuple):
    """An edge of a shape.

    Attributes:
        edge: the kernel's.
        faces: on which it lies, by their places; twice the same one for a seam of a face.
        curve: its curve.
        range: first and last parameter of that.
        points: EDGE_POINTS along it; a degenerate one stays in its vertex.
        ends: its two vertices.
    """

    edge: TopoDS_Edge
    faces: list[int]
    curve: BRepAdaptor_Curve
    range: tuple[float, float]
    points: list[Point]
    ends: tuple[Point, Point]


def _boundary(shape: TopoDS_Shape, edges: Sequence[_Edge], surfaces: Sequence[list[float] | None]) -> Boundary:
    return Boundary(
        vertices=vertices_of(shape),
        edges=np.array([edge.points for edge in edges]).reshape(-1, EDGE_POINTS, 3),
        edge_faces=np.array([(*edge.faces, -1)[:2] for edge in edges], dtype=np.intp).reshape(-1, 2),
        surfaces=np.array([numbers or [np.nan] * 9 for numbers in surfaces]).reshape(-1, 9),
    )


def _edge_of(edge: TopoDS_Edge) -> _Edge:
    """An edge of which the faces are not known yet, its points at equal steps of its parameter."""
    curve = BRepAdaptor_Curve(edge)
    start, stop, value = curve.FirstParameter(), curve.LastParameter(), curve.Value
    first, last = (BRep_Tool.Pnt_s(end).Coord() for end in (TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)))
    if BRep_Tool.Degenerated_s(edge):
        return _Edge(edge, [], curve, (start, stop), [first] * EDGE_POINTS, (first, last))
    step = (stop - start) / (EDGE_POINTS - 1)  # NumPy's linspace takes as long as the kernel
    points = [value(start + place * step).Coord() for place in range(EDGE_POINTS - 1)] + [value(stop).Coord()]
    return _Edge(edge, [], curve, (start, stop), points, (first, last))


def _at_home(shape: TopoDS_Shape) -> tuple[TopoDS_Shape, Array]:
    """A shape in its own coordinates, and where their origin lies; one that is turned as well is left as it is."""
    location = shape.Location().Transformation()
    if location.Form() in (gp_Identity, gp_Translation):
        return shape.Located(TopLoc_Location()), np.array(location.TranslationPart().Coord())
    turn = [[location.VectorialPart().Value(row, column) for column in (1, 2, 3)] for row in (1, 2, 3)]
    if np.abs(np.array(turn) - np.eye(3)).max() > _NO_TURN:
        return shape, np.zeros(3)
    return shape.Located(TopLoc_Location()), np.array(location.TranslationPart().Coord())


def vertices_of(shape: TopoDS_Shape) -> Array:
    """(v, 3) every vertex once, mm."""
    known = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_VERTEX, known)
    vertices = (TopoDS.Vertex_s(known.FindKey(index)) for index in range(1, known.Extent() + 1))
    return np.array([BRep_Tool.Pnt_s(vertex).Coord() for vertex in vertices]).reshape(-1, 3)


def _edges_with_faces(faces: list[TopoDS_Face]) -> list[_Edge]:
    """Every edge once."""
    known = TopTools_IndexedMapOfShape()
    found: list[_Edge] = []
    for index, face in enumerate(faces):
        for edge in shapes_of(face, TopAbs_EDGE):
            place = known.Add(edge)
            if place > len(found):
                found.append(_edge_of(TopoDS.Edge_s(edge)))
            found[place - 1].faces.append(index)
    return found


def _surface(face: TopoDS_Face) -> tuple[str, list[float] | None]:
    surface = BRepAdaptor_Surface(face, False)
    side = -1.0 if face.Orientation() == TopAbs_REVERSED else 1.0
    if surface.GetType() == GeomAbs_Plane:
        plane = surface.Plane().Position()
        # A left-handed frame turns the plane's own normal against its axis.
        side = side if plane.Direct() else -side
        return "plane", [*_xyz(plane.Location()), *_xyz(plane.Direction()), 0.0, 0.0, side]
    kind = _ROUND.get(surface.GetType())
    if kind is None:
        return "other", None
    round_surface = surface.Cone() if kind == "cone" else surface.Cylinder()
    radius = round_surface.RefRadius() if kind == "cone" else round_surface.Radius()
    half_angle = round_surface.SemiAngle() if kind == "cone" else 0.0
    frame = round_surface.Position()
    side = side if frame.Direct() else -side
    return kind, [*_xyz(frame.Location()), *_xyz(frame.Direction()), radius, half_angle, side]


def _straight(
    edge: _Edge, first: list[float] | None, second: list[float] | None
) -> tuple[tuple[Point, Point], list[list[float]]] | None:
    """Ends and surfaces of a straight edge between two exact faces, else None."""
    if first is None or second is None or edge.curve.GetType() != GeomAbs_Line:
        return None
    return edge.ends, [first, second]


def _inner_wires(face: TopoDS_Face) -> list[TopoDS_Shape]:
    """The rims of a face's holes."""
    wires = shapes_of(face, TopAbs_WIRE)
    if len(wires) < 2:
        return []
    outer = BRepTools.OuterWire_s(face)
    return [wire for wire in wires if not wire.IsSame(outer)]


def _rim(wire: TopoDS_Shape) -> Array:
    """(RIM_POINTS, 3) points along a rim, as many on each edge; of one that has not two edges some are left out."""
    return np.resize(np.concatenate([_along(edge, _EDGE_POINTS) for edge in edges_of(wire)]), (RIM_POINTS, 3))


def _along(edge: TopoDS_Edge, count: int) -> Array:
    curve = BRepAdaptor_Curve(edge)
    places = np.linspace(curve.FirstParameter(), curve.LastParameter(), count, endpoint=False)
    return np.array([_xyz(curve.Value(place)) for place in places.tolist()])


def _sampled(edges: Sequence[_Edge]) -> Array:
    """(o, POINTS, 3) points along edges."""
    found = []
    for edge in edges:
        places = np.linspace(*edge.range, POINTS)
        found.append([_xyz(edge.curve.Value(place)) for place in places.tolist()])
    return np.array(found).reshape(-1, POINTS, 3)


def _piece(edge: _Edge) -> tuple[list[Sequence[float]], tuple[Point, Point]] | None:
    """An edge as rows (center, cosine axis, sine axis, [start, stop, is arc]) and its ends; None if neither."""
    curve, (start, stop) = edge.curve, edge.range
    if curve.GetType() == GeomAbs_Line:
        (x, y, z), (to_x, to_y, to_z) = edge.points[0], edge.points[-1]
        rows: list[Sequence[float]] = [(x, y, z), (to_x - x, to_y - y, to_z - z), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    elif curve.GetType() in (GeomAbs_Ellipse, GeomAbs_Circle):
        axes, major, minor = _conic(curve)
        rows = [
            _xyz(axes.Location()),
            [major * part for part in _xyz(axes.XDirection())],
            [minor * part for part in _xyz(axes.YDirection())],
            [start, stop, 1.0],
        ]
    else:
        return None
    return rows, edge.ends


def _conic(curve: BRepAdaptor_Curve) -> tuple[gp_Ax2, float, float]:
    """Frame and half axes of an ellipse, or of a circle, which is one."""
    if curve.GetType() == GeomAbs_Circle:
        circle = curve.Circle()
        return circle.Position(), circle.Radius(), circle.Radius()
    ellipse = curve.Ellipse()
    return ellipse.Position(), ellipse.MajorRadius(), ellipse.MinorRadius()


def _pieces(rows: Sequence[Sequence[Sequence[float]]]) -> CurvePieces:
    table = np.array(rows).reshape(-1, 4, 3)
    return CurvePieces(
        centers=table[:, 0],
        cosine_axes=table[:, 1],
        sine_axes=table[:, 2],
        starts=table[:, 3, 0],
        stops=table[:, 3, 1],
        arcs=table[:, 3, 2] > 0.5,
    )


def _xyz(triple: gp_Pnt | gp_Dir) -> list[float]:
    return list(triple.Coord())
