"""Tampering of solids: panels.step and skins.step written anew from other shapes than the panels'.

They are written by the kernel's own writer, as the package's refuses what is no exact panel. What `verify` says of that
writer's files where nothing was changed does not count.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_GTransform, BRepBuilderAPI_NurbsConvert, BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_GTrsf, gp_Mat, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape

from cadpanel.brep.building.sheet import build_panel
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.records.to_shape import recorded_shapes
from cadpanel.geometry.panel import Panel
from tests.reference_shapes import write_products

Tamper = Callable[[Path], None]
Shape = TopoDS_Shape
Changed = Callable[[TopoDS_Shape, Panel], TopoDS_Shape]


class Sheet(NamedTuple):
    """A panel, and the shapes that go into the files under its name."""

    shape: Panel
    solid: TopoDS_Shape
    skin: TopoDS_Shape


Sheets = list[Sheet]


def _sheets(folder: Path) -> Sheets:
    """The sheets of the delivery in a folder, built anew."""
    report = read_report(folder / "report.json")
    settings = report.settings.sheet()
    built = [(one, build_panel(one, settings.thickness, settings.skin_side)) for one in recorded_shapes(report)]
    return [Sheet(shape, one.solid, one.skin) for shape, one in built]


def _written(change: Callable[[Sheets], Sheets]) -> Tamper:
    def tamper(folder: Path) -> None:
        sheets = change(_sheets(folder))
        for name, which in (("panels.step", 1), ("skins.step", 2)):
            write_products(folder / name, [(sheet.shape.name, sheet[which]) for sheet in sheets])

    return tamper


def _solid(change: Changed, *, skin: bool = False) -> Tamper:
    """The second panel's solid, or skin, changed."""

    def changed(sheets: Sheets) -> Sheets:
        one = sheets[1]
        shapes = (one.solid, change(one.skin, one.shape)) if skin else (change(one.solid, one.shape), one.skin)
        return [sheets[0], Sheet(one.shape, *shapes), *sheets[2:]]

    return _written(changed)


def moved(by: float) -> Changed:
    def change(shape: TopoDS_Shape, _panel: Panel) -> TopoDS_Shape:
        move = gp_Trsf()
        move.SetTranslation(gp_Vec(by, 0.5 * by, -by))
        return BRepBuilderAPI_Transform(shape, move, True).Shape()

    return change


def _scaled(factor: float) -> Changed:
    def change(shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
        scale = gp_Trsf()
        scale.SetScale(gp_Pnt(*panel.corners()[0, 0].tolist()), factor)
        return BRepBuilderAPI_Transform(shape, scale, True).Shape()

    return change


def _turned(angle: float) -> Changed:
    def change(shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
        points, _, normals = panel.rulings()
        turn = gp_Trsf()
        turn.SetRotation(gp_Ax1(gp_Pnt(*points[0].tolist()), gp_Dir(*normals[0].tolist())), angle)
        return BRepBuilderAPI_Transform(shape, turn, True).Shape()

    return change


def _mirrored(shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
    points, _, normals = panel.rulings()
    mirror = gp_Trsf()
    mirror.SetMirror(gp_Ax2(gp_Pnt(*points[0].tolist()), gp_Dir(*normals[0].tolist())))
    return BRepBuilderAPI_Transform(shape, mirror, True).Shape()


def _sheared(by: float) -> Changed:
    """The far face goes sideways by so much, the volume stays."""

    def change(shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
        points, directions, normals = panel.rulings()
        normal, along = normals[0], directions[0]
        shear = gp_GTrsf()
        slope = by / 3.0
        rows = [[float(i == k) + slope * along[i] * normal[k] for k in range(3)] for i in range(3)]
        shear.SetVectorialPart(gp_Mat(*[value for row in rows for value in row]))
        base = points[0]
        back = [-slope * float(normal @ base) * along[i] for i in range(3)]
        shear.SetTranslationPart(gp_Pnt(*back).XYZ())
        return BRepBuilderAPI_GTransform(shape, shear, True).Shape()

    return change


def as_splines(shape: TopoDS_Shape, _panel: Panel) -> TopoDS_Shape:
    return BRepBuilderAPI_NurbsConvert(shape, True).Shape()


def drilled(radius: float) -> Changed:
    def change(shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
        corners = panel.corners()
        middle, normal = corners[:, :2].reshape(-1, 3).mean(axis=0), panel.rulings()[2][0]
        axis = gp_Ax2(gp_Pnt(*(middle + 50.0 * normal).tolist()), gp_Dir(*(-normal).tolist()))
        return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(axis, radius, 100.0).Shape()).Shape()

    return change


def _notched(shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
    box = BRepPrimAPI_MakeBox(gp_Pnt(*(panel.corners()[0, 0] - 10.0).tolist()), 20.0, 20.0, 20.0).Shape()
    return BRepAlgoAPI_Cut(shape, box).Shape()


def _with(*more: Callable[[Panel], TopoDS_Shape]) -> Changed:
    """A compound of a shape and others."""

    def change(shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
        found, builder = TopoDS_Compound(), BRep_Builder()
        builder.MakeCompound(found)
        for one in (shape, *(make(panel) for make in more)):
            builder.Add(found, one)
        return found

    return change


def _box(panel: Panel) -> TopoDS_Shape:
    return BRepPrimAPI_MakeBox(gp_Pnt(*panel.corners()[0, 0].tolist()), 5.0, 5.0, 5.0).Shape()


def _of_sheet(thickness: float, side: str = "outer") -> Changed:
    def change(_shape: TopoDS_Shape, panel: Panel) -> TopoDS_Shape:
        return build_panel(panel, thickness, side).solid  # type: ignore[arg-type]

    return change


def _exchanged(which: str) -> Tamper:
    """The first two panels' shapes under each other's names."""

    def changed(sheets: Sheets) -> Sheets:
        first, second, *rest = sheets
        solids, skins = (first.solid, second.solid), (first.skin, second.skin)
        if which == "solid":
            return [Sheet(first.shape, solids[1], skins[0]), Sheet(second.shape, solids[0], skins[1]), *rest]
        return [Sheet(first.shape, solids[0], skins[1]), Sheet(second.shape, solids[1], skins[0]), *rest]

    return _written(changed)


def _thicker(sheets: Sheets) -> Sheets:
    """Every solid, of a sheet that is a hundredth of a millimetre thicker."""
    return [Sheet(one.shape, build_panel(one.shape, 3.01).solid, one.skin) for one in sheets]


SOLIDS: dict[str, Tamper] = {
    "nothing": _written(lambda sheets: sheets),
    **{f"far face sheared by {by:g} mm": _solid(_sheared(by)) for by in (0.5, 50.0, 1000.0)},
    **{f"solid moved by {by:g} mm": _solid(moved(by)) for by in (1e-5, 0.01, 100.0)},
    "solid scaled by 1e-6": _solid(_scaled(1.0 + 1e-6)),
    "solid scaled by 1000": _solid(_scaled(1000.0)),
    "solid turned by 1e-6 rad": _solid(_turned(1e-6)),
    "solid turned by half a turn": _solid(_turned(math.pi)),
    "solid mirrored": _solid(_mirrored),
    "solid as splines": _solid(as_splines),
    "solid inside out": _solid(lambda shape, _: shape.Reversed()),
    "solid with a hole of 0.5 mm": _solid(drilled(0.25)),
    "solid with a hole of 20 mm": _solid(drilled(10.0)),
    "solid with a notch": _solid(_notched),
    "solid with another one beside it": _solid(_with(_box)),
    "solid twice": _solid(_with(lambda panel: build_panel(panel, 3.0).solid)),
    "solid with its skin in it": _solid(_with(lambda panel: build_panel(panel, 3.0).skin)),
    "solid of 4 mm": _solid(_of_sheet(4.0)),
    "solid on the other side": _solid(_of_sheet(3.0, "inner")),
    "solids of 3.01 mm": _written(_thicker),
    "solids under other names": _exchanged("solid"),
    "skins under other names": _exchanged("skin"),
    "skin moved by 0.01 mm": _solid(moved(0.01), skin=True),
    "skin inside out": _solid(lambda shape, _: shape.Reversed(), skin=True),
    "skin as splines": _solid(as_splines, skin=True),
    "skin as a solid": _solid(lambda _, panel: build_panel(panel, 3.0).solid, skin=True),
    "skin with a box beside it": _solid(_with(_box), skin=True),
}
"""By what is done, tampers of a delivery without holes; the first changes nothing, and must hold."""
