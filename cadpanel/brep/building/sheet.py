"""A panel's skin as an open shell, and its sheet as an exact solid between the skin and the parallel one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import singledispatch

from OCP.BRep import BRep_Builder
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape, TopoDS_Shell, TopoDS_Solid

from cadpanel.brep.building.chain_sheet import chain_sheet
from cadpanel.brep.building.chain_skin import chain_skin
from cadpanel.brep.building.edges import shell_of
from cadpanel.brep.building.holes import drilled
from cadpanel.brep.building.mass_properties import volume_and_centroid
from cadpanel.brep.building.polygon_sheet import polygon_sheet, polygon_skin
from cadpanel.brep.building.sheet_faces import SheetFaces
from cadpanel.brep.building.tray_sheet import tray_sheet, tray_skin
from cadpanel.geometry.fixings import Hole
from cadpanel.geometry.panel import Panel, Straightened
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.sheet_checks import SkinSide, check_buildable, other_face, sheet_depth
from cadpanel.geometry.trays import TrayShape
from cadpanel.kinds import checked

_BUILDER = BRep_Builder()


@checked
def build_skin(shape: Panel) -> TopoDS_Shell:
    """The panel's skin as an open shell, its faces' normals along n (outward).

    A cone of half angle 5e-6 rad or less is built as a cylinder; `Panel.straightened` says which and what it moves.

    Raises:
        PanelError: if the skin cannot be built (see `Panel.check`).
    """
    shape.check()
    return shell_of(skin_faces(shape.straightened().shape))


@checked
def build_solid(shape: Panel, thickness: float, skin_side: SkinSide = "outer") -> TopoDS_Solid:
    """The sheet of `thickness` mm on the panel's skin; with "outer" it lies at -n, with "inner" at +n.

    The other face is the parallel skin (plane by plane, cone by cone with the same half angle), the end walls lie in
    the cut planes, and each side wall holds the outer ruling and leans as the panel says (see `Panel.cut_back`). A cone
    of half angle 5e-6 rad or less is built as a cylinder; `Panel.straightened` says which and what it moves.

    Raises:
        PanelError: if the sheet cannot be built (see `check_buildable`).
    """
    return build_panel(shape, thickness, skin_side).solid


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltPanel:
    """A panel's skin and sheet; the sheet's own skin faces are the skin's, but for its holes.

    Attributes:
        straightened: the shape as it was built, and which cones became cylinders.
        skin: open shell, normals along n.
        solid: the sheet.
    """

    straightened: Straightened[Panel]
    skin: TopoDS_Shell
    solid: TopoDS_Solid


def build_panel(
    shape: Panel, thickness: float, skin_side: SkinSide = "outer", holes: Sequence[Hole] = ()
) -> BuiltPanel:
    """Skin and sheet at once, which costs little more than the sheet alone; see `build_skin` and `build_solid`.

    Args:
        shape: the panel.
        thickness: of its sheet, mm.
        skin_side: on which side of the sheet its skin lies.
        holes: through the sheet; the skin has none.

    Raises:
        PanelError: if the sheet cannot be built (see `check_buildable`).
    """
    check_buildable(shape, thickness, skin_side)
    return build_checked(shape, thickness, skin_side, holes)


def build_checked(shape: Panel, thickness: float, skin_side: SkinSide, holes: Sequence[Hole]) -> BuiltPanel:
    """The same of a panel that has passed `check_buildable`."""
    straightened = shape.straightened()
    own = straightened.shape
    faces = sheet_faces(own, other_face(own, thickness, skin_side))
    whole = drilled(faces, holes, sheet_depth(thickness, skin_side))
    solid = _solid_of([*whole.near, *whole.far, *whole.walls])
    return BuiltPanel(straightened=straightened, skin=shell_of(faces.skin), solid=solid)


@singledispatch
def skin_faces(shape: Panel) -> Sequence[TopoDS_Face]:
    """The faces of a skin that passes its checks, normals outwards; one entry for each kind of panel.

    Raises:
        TypeError: nobody has said how panels of this kind are built.
    """
    raise TypeError(f"no skin is known for a panel like {shape!r}: register one for its class")


@singledispatch
def sheet_faces(near: Panel, _far: Panel) -> SheetFaces:
    """The faces of the skin `near`, and of the sheet between it and the parallel skin; one entry for a kind of panel.

    Raises:
        TypeError: nobody has said how panels of this kind are built.
    """
    raise TypeError(f"no sheet is known for a panel like {near!r}: register one for its class")


skin_faces.register(PanelShape, chain_skin)
skin_faces.register(PolygonShape, polygon_skin)
sheet_faces.register(PanelShape, chain_sheet)
sheet_faces.register(PolygonShape, polygon_sheet)
skin_faces.register(TrayShape, tray_skin)
sheet_faces.register(TrayShape, tray_sheet)


def _solid_of(faces: Sequence[TopoDS_Face]) -> TopoDS_Solid:
    """The solid inside faces that share all their edges, their normals outwards."""
    shell = shell_of(faces)
    shell.Closed(True)
    solid = TopoDS_Solid()
    _BUILDER.MakeSolid(solid)
    _BUILDER.Add(solid, shell)
    return solid


def volume_of(shape: TopoDS_Shape) -> float:
    """The kernel's own volume of a solid, mm3: positive where its faces point outwards."""
    return volume_and_centroid(shape)[0]
