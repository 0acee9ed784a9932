"""A surface cut by a network of curves that lie on it or near it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.TopAbs import TopAbs_EDGE, TopAbs_INTERNAL, TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cadpanel.arrays import Array
from cadpanel.brep.curves.drawn_curve import Curve
from cadpanel.brep.curves.projection import Landing
from cadpanel.brep.curves.reach import ON_LIMIT
from cadpanel.brep.cutting.cut_panel import CutPanel, along_panels, middle_of
from cadpanel.brep.cutting.edges_across_gaps import bridges, points_along
from cadpanel.brep.cutting.panel_names import Link, place_names
from cadpanel.brep.kernel.shape_maps import ShapeMap, ShapeSet
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.splitting.split_along_edges import split_along
from cadpanel.brep.splitting.splitter import Pieces, area_of, length_of
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.order import EQUAL, levels
from cadpanel.geometry.vectors import cross, norm

# An offset of more than this is worth a note, mm.
WORTH_A_NOTE = 0.01
# Lengths of edges are told apart from this on, mm.
LEVEL = 1e-3
# Tolerances of the splitter that are tried in turn, as parts of the seam tolerance, until every curve cuts.
FUZZY_PARTS = (0.01, 0.1, 0.5)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Cut:
    """A split surface.

    Attributes:
        faces: all pieces.
        links: pairs of pieces that share an edge, or lie along each other's within the tolerance, with that edge, and
            whether a curve made it.
        loose: the parts of curves that separate nothing: the curve's index, and the edge.
        slivers: pieces that a curve leaves narrower than the tolerance: the curve's index, an edge of it there, and the
            width, mm.
    """

    faces: tuple[TopoDS_Face, ...]
    links: tuple[tuple[int, int, TopoDS_Edge, bool], ...]
    loose: tuple[tuple[int, TopoDS_Edge], ...]
    slivers: tuple[tuple[int, TopoDS_Edge, float], ...]


def cut_network(
    surface: Surface,
    curves: Sequence[Curve],
    landing: Landing,
    what: str,
    curve_source: str,
    remedy: str,
    tolerance: float,
) -> tuple[CutPanel, ...]:
    """Cut a surface along curves.

    Every part of every curve must lie between two panels or on the outline, or the surface is refused with the curve
    that does not.

    Args:
        surface: what to cut.
        curves: all curves.
        landing: what they leave on the surface.
        what: the surface, for messages ("the surface of face 3 of 'roof.step'").
        curve_source: the name of the file that the curves come from.
        remedy: what to do about a curve that does not cut.
        tolerance: how far a curve may end from where it should, mm.

    Raises:
        ReferenceFileError: a curve ends inside a panel, leaves a sliver, or the kernel does not cut along it.
    """
    if not any(landing.edges):
        return along_panels(surface.name, [[face.patch.face for face in surface.faces]])
    cut = _split(surface, landing.edges, what, tolerance)
    if cut.loose:
        index, edge = cut.loose[0]
        x, y, z = _middle(edge)
        called = curves[index].called
        raise ReferenceFileError(
            f"{called[:1].upper()}{called[1:]} of '{curve_source}' separates no two panels near ({x:.1f}, {y:.1f}, "
            f"{z:.1f}): {remedy}."
        )
    if cut.slivers:
        index, edge, width = cut.slivers[0]
        x, y, z = _middle(edge)
        called = curves[index].called
        raise ReferenceFileError(
            f"{called[:1].upper()}{called[1:]} of '{curve_source}' leaves a panel only {width:.2g} mm wide near "
            f"({x:.1f}, {y:.1f}, {z:.1f}): draw it onto the edge that it runs beside, or take it out."
        )
    return _panels(surface.name, cut)


def _split(surface: Surface, tools: Sequence[Sequence[TopoDS_Edge]], what: str, tolerance: float) -> _Cut:
    """Split with growing tolerance until every part of every curve separates two panels or lies on the outline.

    Ends that stick out beyond another curve by no more than the tolerance are taken off.
    """
    faces = [face.patch.face for face in surface.faces]
    owners = [(index, edge) for index, parts in enumerate(tools) for edge in parts]
    cut: _Cut | None = None
    for part in FUZZY_PARTS:
        pieces = split_along(faces, [edge for _, edge in owners], what, part * tolerance)
        cut = _looked_at(pieces, owners, tolerance)
        if cut.loose and all(length_of(edge) <= tolerance + ON_LIMIT for _, edge in cut.loose):
            kept = _without(pieces, owners, ShapeSet(edge for _, edge in cut.loose))
            pieces = split_along(faces, [edge for _, edge in kept], what, part * tolerance)
            cut = _looked_at(pieces, kept, tolerance)
        if not (cut.loose or cut.slivers):
            break
    assert cut is not None
    return cut


def _without(
    pieces: Pieces, owners: Sequence[tuple[int, TopoDS_Edge]], loose: ShapeSet
) -> list[tuple[int, TopoDS_Edge]]:
    """The parts of the curves that do separate something."""
    return [
        (index, TopoDS.Edge_s(part))
        for (index, _), parts in zip(owners, pieces.tools, strict=True)
        for part in parts
        if part not in loose
    ]


def _looked_at(pieces: Pieces, owners: Sequence[tuple[int, TopoDS_Edge]], tolerance: float) -> _Cut:
    faces = tuple(face for parts in pieces.faces for face in parts)
    around: ShapeMap[list[int]] = ShapeMap()
    # A curve that ends inside a piece is kept there as an edge on none of its borders.
    inner = ShapeSet()
    for place, face in enumerate(faces):
        for shape in shapes_of(face, TopAbs_EDGE):
            around.setdefault(shape, []).append(place)
            if shape.Orientation() == TopAbs_INTERNAL:
                inner.add(shape)
    curve_edges: ShapeMap[int] = ShapeMap()
    loose: list[tuple[int, TopoDS_Edge]] = []
    for (index, _), parts in zip(owners, pieces.tools, strict=True):
        for part in parts:
            curve_edges[part] = index
            users = around.get(part, [])
            # Twice in one piece: the piece lies on both sides. In no piece: the kernel left the curve out.
            if not users or part in inner or (len(users) == 2 and users[0] == users[1]):
                loose.append((index, TopoDS.Edge_s(part)))
    used = [(TopoDS.Edge_s(shape), users) for shape, users in around.items()]
    links = [
        (users[0], users[1], edge, edge in curve_edges)
        for edge, users in used
        if len(users) == 2 and users[0] != users[1]
    ]
    open_edges = [(edge, users[0]) for edge, users in used if len(users) == 1 and not BRep_Tool.Degenerated_s(edge)]
    owner = [number for number, parts in enumerate(pieces.faces) for _ in parts]
    between = bridges([edge for edge, _ in open_edges], [owner[user] for _, user in open_edges], tolerance)
    for (one, user), (other, other_user) in ((open_edges[first], open_edges[second]) for first, second in between):
        links.append((user, other_user, one, one in curve_edges or other in curve_edges))
    return _Cut(
        faces=faces,
        links=tuple(links),
        loose=_longest_first(loose),
        slivers=tuple(_slivers(faces, curve_edges, tolerance)),
    )


def _longest_first(loose: Sequence[tuple[int, TopoDS_Edge]]) -> tuple[tuple[int, TopoDS_Edge], ...]:
    """Those alike as they were drawn."""
    lengths = np.array([length_of(edge) for _, edge in loose])
    return tuple(loose[place] for place in np.argsort(-levels(lengths, LEVEL), kind="stable").tolist())


def _slivers(
    faces: Sequence[TopoDS_Face], curve_edges: ShapeMap[int], tolerance: float
) -> Iterator[tuple[int, TopoDS_Edge, float]]:
    """The pieces narrower than the tolerance that a curve borders."""
    for face in faces:
        edges = [TopoDS.Edge_s(shape) for shape in shapes_of(face, TopAbs_EDGE)]
        drawn = [edge for edge in edges if edge in curve_edges]
        if not drawn:
            continue
        area, around = np.zeros(3), 0.0
        origin = points_along(edges[0])[0]
        for edge in edges:
            points = points_along(edge) - origin
            points = points[::-1] if edge.Orientation() == TopAbs_REVERSED else points
            area += 0.5 * cross(points[:-1], points[1:]).sum(axis=0)
            around += float(norm(np.diff(points, axis=0)).sum())
        # Of a strip that is the width; what closes to a tube, or nearly so, encloses little of any plane.
        width = 2.0 * float(norm(area)) / around
        if width < tolerance and area_of(face) < 0.5 * tolerance * around:
            lengths = [length_of(edge) for edge in drawn]
            alike = [
                edge for edge, length in zip(drawn, lengths, strict=True) if length >= (1.0 - EQUAL) * max(lengths)
            ]
            longest = min(alike, key=lambda edge: curve_edges[edge])
            yield curve_edges[longest], longest, width


def _panels(name: str, cut: _Cut) -> tuple[CutPanel, ...]:
    """Pieces that hang together across edges which no curve made, named by where they sit."""
    inner = np.array([link[:2] for link in cut.links if not link[3]], dtype=np.intp).reshape(-1, 2)
    count = len(cut.faces)
    graph = coo_array((np.ones(len(inner)), (inner[:, 0], inner[:, 1])), shape=(count, count))
    number, group = connected_components(graph, directed=False)
    groups = [[cut.faces[index] for index in np.flatnonzero(group == place)] for place in range(number)]
    middles = np.array([middle_of(faces) for faces in groups])
    links = [
        Link(panels=(int(group[first]), int(group[second])), middle=_middle(edge), length=length_of(edge))
        for first, second, edge, made in cut.links
        if made and group[first] != group[second]
    ]
    names = place_names(name, middles, links)
    order = sorted(range(number), key=lambda place: names[place])
    return tuple(CutPanel(name=names[place], faces=tuple(groups[place])) for place in order)


def _middle(edge: TopoDS_Shape) -> Array:
    curve = BRepAdaptor_Curve(TopoDS.Edge_s(edge))
    return np.array(curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter())).Coord())
