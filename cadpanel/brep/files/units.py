"""Units of length, and shapes in millimetres."""

from __future__ import annotations

from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepLib import BRepLib
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopoDS import TopoDS_Shape

from cadpanel.errors import ReferenceFileError


def no_unit(name: str, kind: str) -> str:
    """What the report says of a file in a format without units where the user gives none."""
    return f"'{name}' has no unit, as no {kind} has; it is read as millimetres."


def unit_missing(name: str) -> str:
    """What the report says of a file that leaves its unit out, though its format has one, where the user gives none."""
    return f"'{name}' does not say its unit; it is read as millimetres: give the unit if that is wrong."


def unit_taken(millimetres: float | None) -> str:
    """What stands for the unit of a file that says none: how many mm the user gives, None for millimetres."""
    return "none, read as millimetres" if millimetres is None else f"none, read as {millimetres:g} mm"


def refuse_given(name: str, unit: str) -> ReferenceFileError:
    """What the user hears who gives a unit for a file that has its own."""
    return ReferenceFileError(
        f"'{name}' says itself that its unit is the {unit}: leave the unit out, or correct it in the export."
    )


def scaled(shape: TopoDS_Shape, factor: float) -> TopoDS_Shape:
    """A shape made larger by a factor."""
    if factor == 1.0:
        return shape
    scaling = gp_Trsf()
    scaling.SetScale(gp_Pnt(0.0, 0.0, 0.0), factor)
    return BRepBuilderAPI_Transform(shape, scaling, True).Shape()


def shifted(shape: TopoDS_Shape, by: tuple[float, float, float]) -> TopoDS_Shape:
    """A shape moved, its geometry and not only its placement: what the kernel computes with becomes small."""
    translation = gp_Trsf()
    translation.SetTranslation(gp_Vec(*by))
    moved = BRepBuilderAPI_Transform(shape, translation, True).Shape()
    # Far from the origin, ends and edges lie apart by more than their tolerance: a double holds no more digits there.
    BRepLib.UpdateTolerances_s(moved, False)
    return moved
