"""Faces split by edges that lie on them.

The kernel's splitter intersects every edge with every face, although the edges are known to lie there: nine tenths of
its time. So only edges are fused with edges, the borders among them, and each face is built anew from what that leaves
in its parameter plane, by the kernel's own builder of faces. Faces with poles and seams are left to its splitter.
"""

from __future__ import annotations

from collections.abc import Sequence

from OCP.BOPAlgo import BOPAlgo_BuilderFace
from OCP.BOPTools import BOPTools_AlgoTools, BOPTools_AlgoTools2D
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.BRepAlgoAPI import BRepAlgoAPI_BuilderAlgo
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.IntTools import IntTools_Context
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FORWARD, TopAbs_IN, TopAbs_INTERNAL, TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cadpanel.brep.kernel.shape_maps import ShapeMap, ShapeSet
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.splitting.splitter import FUZZY, Pieces, listed, require_whole, split_faces, unsplit

# Tolerance of the test whether a part of an edge lies inside a face's border, in the parameter plane.
INSIDE = 1e-9
# What the tolerance of an edge or vertex may grow to, mm, where its curves lie that far apart; the kernel's own value.
LARGEST_TOLERANCE = 0.05


def split_along(faces: Sequence[TopoDS_Face], edges: Sequence[TopoDS_Edge], what: str, fuzzy: float = FUZZY) -> Pieces:
    """Split faces along edges.

    Args:
        faces: what to split; neighbours keep sharing their edges.
        edges: each with a curve in the parameter plane of the face on which it lies.
        what: what is split and where it comes from, for messages ("face 3 of 'roof.step'").
        fuzzy: an edge that ends, or runs, this close to another one or to a border meets it, mm.

    Raises:
        ReferenceFileError: the kernel fails, or its pieces do not have the area of the whole.
    """
    if not edges:
        return Pieces(faces=tuple((face,) for face in faces), tools=())
    if any(_has_pole_or_seam(face) for face in faces):
        return split_faces(faces, edges, what, fuzzy)
    borders = [edge for face in faces for edge in shapes_of(face, TopAbs_EDGE)]
    fuse = BRepAlgoAPI_BuilderAlgo()
    # The borders come first: where an edge runs along one, the border's curves are kept, which all its faces know.
    fuse.SetArguments(listed([*borders, *edges]))
    fuse.SetFuzzyValue(fuzzy)
    try:
        fuse.Build()
        if not fuse.IsDone():
            raise unsplit(what, "it cannot find where edges cross")
        images = tuple(_images(fuse, edge) for edge in edges)
        pieces = tuple(_pieces(face, fuse, images, what) for face in faces)
        whole = compound_of(part for parts in pieces for part in parts)
        BOPTools_AlgoTools.CorrectTolerances_s(whole, TopTools_IndexedMapOfShape(), LARGEST_TOLERANCE, False)
        BOPTools_AlgoTools.CorrectShapeTolerances_s(whole, TopTools_IndexedMapOfShape(), False)
    except Standard_Failure as error:
        raise unsplit(what, str(error)) from error
    for face, parts in zip(faces, pieces, strict=True):
        require_whole(face, parts, what, fuzzy)
    used = ShapeSet(shapes_of(whole, TopAbs_EDGE))
    tools = (tuple(part for part in parts if part in used) for parts in images)
    return Pieces(faces=pieces, tools=tuple(parts or (edge,) for parts, edge in zip(tools, edges, strict=True)))


def _images(fuse: BRepAlgoAPI_BuilderAlgo, edge: TopoDS_Shape) -> tuple[TopoDS_Edge, ...]:
    """What the fuse leaves of an edge: itself where it changed nothing."""
    if fuse.IsDeleted(edge):
        return ()
    parts = fuse.Modified(edge)
    if parts.Extent() < 2:  # mostly; iterating takes the kernel's binding forty times as long
        return (TopoDS.Edge_s(parts.First() if parts.Extent() else edge),)
    return tuple(TopoDS.Edge_s(part) for part in parts)


def _has_pole_or_seam(face: TopoDS_Face) -> bool:
    """Whether a part of the border has no length or counts for both its sides."""
    edges = [TopoDS.Edge_s(edge) for edge in shapes_of(face, TopAbs_EDGE)]
    return any(BRep_Tool.Degenerated_s(edge) or BRep_Tool.IsClosed_s(edge, face) for edge in edges)


def _pieces(
    face: TopoDS_Face, fuse: BRepAlgoAPI_BuilderAlgo, images: Sequence[tuple[TopoDS_Edge, ...]], what: str
) -> tuple[TopoDS_Face, ...]:
    """The pieces of one face, with its orientation."""
    forward = TopoDS.Face_s(face.Oriented(TopAbs_FORWARD))
    border, changed = _border(forward, fuse)
    inner = _inner(forward, images, ShapeSet(border))
    if not inner and not changed:
        return (face,)
    builder = BOPAlgo_BuilderFace()
    builder.SetFace(forward)
    builder.SetShapes(listed([*border, *(part for edge in inner for part in _both_ways(edge))]))
    builder.Perform()
    if builder.HasErrors():
        raise unsplit(what, "its edges enclose no faces")
    return tuple(TopoDS.Face_s(part.Oriented(face.Orientation())) for part in builder.Areas())


def _border(face: TopoDS_Face, fuse: BRepAlgoAPI_BuilderAlgo) -> tuple[list[TopoDS_Shape], bool]:
    """The parts of a face's border, each the way that its edge runs, and whether any of them is new."""
    context = IntTools_Context()
    found: list[TopoDS_Shape] = []
    changed = False
    for shape in shapes_of(face, TopAbs_EDGE):
        edge = TopoDS.Edge_s(shape)
        for part in _images(fuse, edge):
            if part.IsSame(edge):
                found.append(edge)
                continue
            changed = True
            # It may have come from another face's border.
            if not BOPTools_AlgoTools2D.HasCurveOnSurface_s(part, face):
                BOPTools_AlgoTools2D.BuildPCurveForEdgeOnFace_s(part, face)
            if edge.Orientation() == TopAbs_INTERNAL:
                found += _both_ways(part)
                continue
            turned = TopoDS.Edge_s(part.Oriented(edge.Orientation()))
            against = BOPTools_AlgoTools.IsSplitToReverse_s(turned, edge, context, 0)
            found.append(turned.Reversed() if against else turned)
    return found, changed


def _inner(face: TopoDS_Face, images: Sequence[tuple[TopoDS_Edge, ...]], border: ShapeSet) -> list[TopoDS_Edge]:
    """The parts of the edges that lie on a face and not along its border."""
    test: BRepTopAdaptor_FClass2d | None = None
    found: ShapeMap[TopoDS_Edge] = ShapeMap()
    for parts in images:
        for part in parts:
            if part in border or part in found:
                continue
            if not BOPTools_AlgoTools2D.HasCurveOnSurface_s(part, face):
                continue
            # Another face may lie on the same surface, and the edge be there.
            test = test or BRepTopAdaptor_FClass2d(face, INSIDE)
            curve = BRepAdaptor_Curve2d(part, face)
            middle = curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()))
            if test.Perform(middle) == TopAbs_IN:
                found[part] = part
    return list(found.values())


def _both_ways(edge: TopoDS_Edge) -> list[TopoDS_Shape]:
    return [edge.Oriented(way) for way in (TopAbs_FORWARD, TopAbs_REVERSED)]
