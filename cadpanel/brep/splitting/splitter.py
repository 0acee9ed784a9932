"""Faces split by edges or faces through the kernel's own splitter, and proof that nothing was lost on the way.

The splitter may leave faces uncut or drop a part without a word, so areas are added up and what was cut is counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepAlgoAPI import BRepAlgoAPI_Splitter
from OCP.BRepGProp import BRepGProp
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.GProp import GProp_GProps
from OCP.Standard import Standard_Failure
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_ListOfShape

from cadpanel.brep.faces.area import enclosed
from cadpanel.brep.kernel.shapes import edges_of
from cadpanel.errors import ReferenceFileError

FUZZY = 1e-3
"""How far a cut may end from the boundary that it should reach, mm."""
LOST_AREA = 1e-6
"""Part of the area by which the pieces may differ from what was split."""

INTEGRATED = 1e-8
"""Relative error to which areas are integrated."""


class UncutError(ReferenceFileError):
    """The kernel leaves a face uncut, or loses a part of it; what would help nobody knows before it is tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pieces:
    """What faces were split into.

    Attributes:
        faces: the pieces of each face, in the order given.
        tools: the parts of each tool, in the order given; where a tool is an edge on the faces, edges of the pieces.
    """

    faces: tuple[tuple[TopoDS_Face, ...], ...]
    tools: tuple[tuple[TopoDS_Shape, ...], ...]


def split_faces(faces: Sequence[TopoDS_Face], tools: Sequence[TopoDS_Shape], what: str, fuzzy: float = FUZZY) -> Pieces:
    """Split faces by all tools at once.

    Args:
        faces: what to split; neighbours keep sharing their edges.
        tools: edges on them, or faces through them.
        what: what is split and where it comes from, for messages ("face 3 of 'roof.step'").
        fuzzy: tolerance, mm.

    Raises:
        ReferenceFileError: the kernel fails, or its pieces do not have the area of the whole.
    """
    if not tools:  # the splitter fails without any
        return Pieces(faces=tuple((face,) for face in faces), tools=())
    splitter = BRepAlgoAPI_Splitter()
    splitter.SetArguments(listed(faces))
    splitter.SetTools(listed(tools))
    splitter.SetFuzzyValue(fuzzy)
    try:
        splitter.Build()
        if not splitter.IsDone():
            raise unsplit(what, "its splitter gives up")
        pieces = tuple(_results(splitter, face) for face in faces)
        used = tuple(tuple(splitter.Modified(tool)) or (tool,) for tool in tools)
    except Standard_Failure as error:
        raise unsplit(what, str(error)) from error
    for face, parts in zip(faces, pieces, strict=True):
        require_whole(face, parts, what, fuzzy)
    return Pieces(faces=pieces, tools=used)


def require_whole(face: TopoDS_Face, parts: Sequence[TopoDS_Face], what: str, fuzzy: float) -> None:
    """Refuse parts of a face that do not have its area.

    Args:
        face: what was split.
        parts: into what.
        what: the face, for messages.
        fuzzy: how far its border may have been moved onto another edge, mm.

    Raises:
        ReferenceFileError: they do not, beyond what that and the tolerances of the face's own edges leave open.
    """
    if not _lost(face, parts):
        return
    # A border that was joined with another one within the tolerance may lie elsewhere in the parameter plane.
    try:
        whole, summed = area_of(face), sum(map(area_of, parts))
    except Standard_Failure as error:
        raise unsplit(what, str(error)) from error
    if abs(whole - summed) > max(LOST_AREA * whole, _unsure_area(face, fuzzy)):
        raise unsplit(what, f"of {whole:.6g} mm2, its pieces cover {summed:.6g} mm2")


def area_of(shape: TopoDS_Shape) -> float:
    """Area as the kernel integrates it closely, which takes it milliseconds a face, mm^2."""
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties, INTEGRATED)
    return abs(float(properties.Mass()))


def _lost(face: TopoDS_Face, parts: Sequence[TopoDS_Face]) -> bool:
    """Whether parts enclose less or more than a face, by what borders enclose in the parameter plane."""
    whole, summed = enclosed(face), sum(map(enclosed, parts))
    return abs(whole - summed) > LOST_AREA * abs(whole)


def _unsure_area(face: TopoDS_Face, fuzzy: float) -> float:
    """The area that lies within the tolerances of a face's edges, mm^2.

    An edge's curve in the parameter plane, on which areas are integrated, may lie that far off its curve in space: a
    circle on a spline surface half a millimetre and more, after other programs.
    """
    edges = edges_of(face)
    return sum(length_of(edge) * max(fuzzy, float(BRep_Tool.Tolerance_s(edge))) for edge in edges)


def length_of(edge: TopoDS_Edge) -> float:
    """Length of an edge, mm."""
    return float(GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge)))


def _results(splitter: BRepAlgoAPI_Splitter, face: TopoDS_Face) -> tuple[TopoDS_Face, ...]:
    if splitter.IsDeleted(face):
        return ()
    parts = tuple(TopoDS.Face_s(part) for part in splitter.Modified(face))
    return parts or (face,)


def listed(shapes: Sequence[TopoDS_Shape]) -> TopTools_ListOfShape:
    """Shapes as the kernel's list."""
    listed = TopTools_ListOfShape()
    for shape in shapes:
        listed.Append(shape)
    return listed


def unsplit(what: str, why: str) -> UncutError:
    """The error that says what the kernel cannot split, and why."""
    return UncutError(f"The CAD kernel cannot split {what} ({why}).")
