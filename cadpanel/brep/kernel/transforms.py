"""Shapes scaled or moved, their geometry and not only their placement."""

from __future__ import annotations

from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepLib import BRepLib
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopoDS import TopoDS_Shape


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
