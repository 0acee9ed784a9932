"""A panel's sheet as an exact solid: two parallel skins, planar end walls in the cut planes, planar side walls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from OCP.BRep import BRep_Builder
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Shell, TopoDS_Solid

from cadpanel.arrays import Array
from cadpanel.brep.building import edges, surfaces
from cadpanel.brep.building.chain_skin import SkinTopology, skin_topology
from cadpanel.brep.building.edges import shell_of
from cadpanel.brep.building.polygon_sheet import polygon_faces
from cadpanel.geometry.chain_checks import SkinSide, check_buildable, other_face
from cadpanel.geometry.shape import AnyShape, PanelShape, PolygonShape
from cadpanel.geometry.slender_cones import Straightened, straighten

_BUILDER = BRep_Builder()


def build_solid(shape: AnyShape, thickness: float, skin_side: SkinSide = "outer") -> TopoDS_Solid:
    """The sheet of `thickness` mm on the panel's skin; with "outer" it lies at -n, with "inner" at +n.

    The other face is the parallel skin (plane by plane, cone by cone with the same half angle), the end walls lie in
    the cut planes, and each side wall holds the free ruling and the skin's normal there. A cone of half angle 5e-6 rad
    or less is built as a cylinder; `straighten` says which and what it moves.

    Raises:
        PanelError: if the sheet cannot be built (see `check_buildable`).
    """
    return build_panel(shape, thickness, skin_side).solid


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltPanel:
    """A panel's skin and sheet; the sheet's own skin faces are the skin's.

    Attributes:
        straightened: the shape as it was built, and which cones became cylinders.
        skin: open shell, normals along n.
        solid: the sheet.
    """

    straightened: Straightened[PanelShape] | Straightened[PolygonShape]
    skin: TopoDS_Shell
    solid: TopoDS_Solid


def build_panel(shape: AnyShape, thickness: float, skin_side: SkinSide = "outer") -> BuiltPanel:
    """Skin and sheet at once, which costs little more than the sheet alone; see `build_skin` and `build_solid`.

    Raises:
        PanelError: if the sheet cannot be built (see `check_buildable`).
    """
    check_buildable(shape, thickness, skin_side)
    if isinstance(shape, PolygonShape):
        face, faces = polygon_faces(shape, other_face(shape, thickness, skin_side))
        return BuiltPanel(straightened=straighten(shape), skin=shell_of([face]), solid=_solid_of(faces))
    straightened = straighten(shape)
    own = straightened.shape
    near, far = skin_topology(own), skin_topology(other_face(own, thickness, skin_side))
    top, bottom = (near, far) if skin_side == "outer" else (far, near)
    faces = [*top.faces, *(TopoDS.Face_s(face.Reversed()) for face in bottom.faces), *_walls(own, top, bottom)]
    return BuiltPanel(straightened=straightened, skin=shell_of(near.faces), solid=_solid_of(faces))


def _solid_of(faces: Sequence[TopoDS_Face]) -> TopoDS_Solid:
    """The solid inside faces that share all their edges, their normals outwards."""
    shell = shell_of(faces)
    shell.Closed(True)
    solid = TopoDS_Solid()
    _BUILDER.MakeSolid(solid)
    _BUILDER.Add(solid, shell)
    return solid


def _walls(shape: PanelShape, top: SkinTopology, bottom: SkinTopology) -> list[TopoDS_Face]:
    """Two side walls and two end walls, all with outward normals."""
    last = len(shape.points) - 1
    posts = {
        (end, ruling): edges.line_edge(
            bottom.vertices[end][ruling],
            top.vertices[end][ruling],
            bottom.corners[end, ruling],
            top.corners[end, ruling],
        )
        for end in range(2)
        for ruling in (0, last)
    }
    sides = [
        _side_wall(shape, ruling, outward, top, bottom, (posts[0, ruling], posts[1, ruling]))
        for ruling, outward in ((0, -1), (last, 1))
    ]
    ends = [
        _end_wall(top, bottom, end, outward * shape.cut_normals[end], (posts[end, 0], posts[end, last]))
        for end, outward in ((0, -1), (1, 1))
    ]
    return sides + ends


def _side_wall(
    shape: PanelShape,
    ruling: int,
    outward: int,
    top: SkinTopology,
    bottom: SkinTopology,
    posts: tuple[TopoDS_Edge, TopoDS_Edge],
) -> TopoDS_Face:
    """The wall through a free ruling and its normal; `outward` is +1 where it faces along b."""
    loop = [bottom.rulings[ruling].Reversed(), posts[0], top.rulings[ruling], posts[1].Reversed()]
    # t then n turns about t x n = b, so up the far post and back along the top is the loop about b, and this is -b's.
    if outward > 0:
        loop = [edge.Reversed() for edge in reversed(loop)]
    normal = outward * shape.binormals()[ruling]
    wall = surfaces.plane_surface(bottom.corners[0, ruling], normal, shape.directions[ruling])
    return edges.face_on(wall.surface, wall.agrees, loop)


def _end_wall(
    top: SkinTopology, bottom: SkinTopology, end: int, normal: Array, posts: tuple[TopoDS_Edge, TopoDS_Edge]
) -> TopoDS_Face:
    """The wall in a cut plane. At end 0, seen against its outward normal, the walk along b goes to the right."""
    loop: list[TopoDS_Shape] = [posts[0], *top.ends[end], posts[1].Reversed()]
    loop += [edge.Reversed() for edge in reversed(bottom.ends[end])]
    # b then n turns about b x n = -t: the loop bottom, last post, top, first post is that of end 0.
    if end == 0:
        loop = [edge.Reversed() for edge in reversed(loop)]
    corners = bottom.corners[end]
    wall = surfaces.plane_surface(corners[0], normal, corners[-1] - corners[0])
    return edges.face_on(wall.surface, wall.agrees, loop)


def volume_of(shape: TopoDS_Shape) -> float:
    """The kernel's own volume of a solid, mm3: positive where its faces point outwards."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    return float(properties.Mass())
