"""Shapes whose place is in their geometry, and not said beside it.

A file may give a shape once and put it in several places: a product in an assembly, the top of an extrusion, a block.
The kernel keeps such a place beside the geometry, as a location, and hands out a moved copy to whoever asks for a
located face's surface. What is built on that copy is on another surface than the face's, and is lost. A location may
stand there even where nothing is moved, and one that mirrors turns a face inside out. So places are worked into the
geometry once, as soon as a file is read, and no other module meets a location.
"""

from __future__ import annotations

from collections.abc import Iterable

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepLib import BRepLib
from OCP.BRepTools import BRepTools, BRepTools_ShapeSet
from OCP.ShapeUpgrade import ShapeUpgrade_RemoveLocations
from OCP.TopAbs import (
    TopAbs_COMPOUND,
    TopAbs_COMPSOLID,
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_SHELL,
    TopAbs_SOLID,
)
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_ListOfShape

from cadpanel.brep.kernel.shape_maps import ShapeMap, ShapeSet
from cadpanel.brep.kernel.shapes import children, compound_of, shapes_of

GROUPS = (TopAbs_COMPOUND, TopAbs_COMPSOLID, TopAbs_SOLID, TopAbs_SHELL)
NOWHERE = TopLoc_Location()
_BUILDER = BRep_Builder()


def is_located(shape: TopoDS_Shape) -> bool:
    """Whether the shape, anything in it, or the geometry of anything in it carries a location, be it an idle one."""
    shapes = BRepTools_ShapeSet(False)
    shapes.Add(shape)
    return not shapes.Locations().Location(1).IsIdentity()


def placed(shape: TopoDS_Shape) -> TopoDS_Shape:
    """The same shape without any location; as it is where it has none.

    What is shared within one place stays shared, all sub-shapes keep their order, and a mirrored face is reversed, so
    that its normal is the mirrored one.

    Raises:
        Standard_Failure: the kernel cannot work a place into the geometry.
    """
    if not is_located(shape):
        return shape
    rigid = _unmirrored(shape)
    # Of an edge on a plane only the curve in space is taken over.
    BRepLib.BuildCurves3d_s(rigid)
    remover = ShapeUpgrade_RemoveLocations()
    remover.SetRemoveLevel(TopAbs_COMPOUND)
    remover.Remove(rigid)
    for old in ShapeSet(shapes_of(rigid, TopAbs_FACE)):
        _carry_face(TopoDS.Face_s(old), TopoDS.Face_s(remover.ModifiedShape(old)))
    for old in ShapeSet(shapes_of(rigid, TopAbs_EDGE)):
        _carry_edge(TopoDS.Edge_s(old), TopoDS.Edge_s(remover.ModifiedShape(old)))
    return remover.GetResult()


def _carry_face(old: TopoDS_Face, new: TopoDS_Face) -> None:
    """Take over what the kernel forgets of a face: whether it is its whole surface."""
    _BUILDER.NaturalRestriction(new, BRep_Tool.NaturalRestriction_s(old))


def _carry_edge(old: TopoDS_Edge, new: TopoDS_Edge) -> None:
    """Take over what the kernel forgets of an edge: whether its curves run alike, and a pole's tolerance."""
    if BRep_Tool.Degenerated_s(old):
        _BUILDER.UpdateEdge(new, BRep_Tool.Tolerance_s(old))
    _BUILDER.SameRange(new, BRep_Tool.SameRange_s(old))
    _BUILDER.SameParameter(new, BRep_Tool.SameParameter_s(old))


def _unmirrored(shape: TopoDS_Shape) -> TopoDS_Shape:
    """The shape with all places that mirror or scale worked into the geometry, level by level from the outside.

    The kernel's own way (`BRepTools_PurgeLocations`) reverses a mirrored face only where it hangs in a mirrored shell
    or compound, and of two places in each other it finds the outer one only.
    """
    odd = TopTools_ListOfShape()
    BRepTools.CheckLocations_s(shape, odd)
    if odd.IsEmpty():
        return shape
    (found,) = children(_rebuilt(compound_of([shape]), ShapeMap()))
    return found


def _rebuilt(group: TopoDS_Shape, known: ShapeMap[TopoDS_Shape]) -> TopoDS_Shape:
    """A group without a place of its own; `known` are those that were rebuilt before."""
    if group in known:
        return known[group]
    rebuilt = group.EmptyCopied()
    for member in _evenly_placed(children(group)):
        if member.ShapeType() in GROUPS:
            bare = member.Located(NOWHERE).Oriented(TopAbs_FORWARD)
            member = _rebuilt(bare, known).Located(member.Location()).Oriented(member.Orientation())
        _BUILDER.Add(rebuilt, member)
    rebuilt.Closed(group.Closed())
    known[group] = rebuilt
    return rebuilt


def _evenly_placed(members: Iterable[TopoDS_Shape]) -> list[TopoDS_Shape]:
    """Members of a group, none in a place that mirrors or scales.

    Those that follow each other in one such place are put there together, so that what they share stays shared.
    """
    runs: list[tuple[TopLoc_Location, list[TopoDS_Shape]]] = []
    for member in members:
        place = _odd_place(member)
        if not (runs and runs[-1][0].IsEqual(place)):
            runs.append((place, []))
        runs[-1][1].append(member)
    found: list[TopoDS_Shape] = []
    for place, own in runs:
        if place.IsIdentity():
            found += own
        else:
            bare = compound_of(member.Located(NOWHERE) for member in own)
            found += children(BRepBuilderAPI_Transform(bare, place.Transformation(), True).Shape())
    return found


def _odd_place(shape: TopoDS_Shape) -> TopLoc_Location:
    """A shape's own place, if it mirrors or scales."""
    place = shape.Location()
    moving = place.Transformation()
    is_odd = moving.IsNegative() or abs(abs(moving.ScaleFactor()) - 1.0) > TopLoc_Location.ScalePrec_s()
    return place if is_odd else NOWHERE
