"""The sheet of a chain: two parallel skins, and walls that are planes, or square to the sheet."""

from __future__ import annotations

from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array
from cadpanel.brep.building import edges, surfaces
from cadpanel.brep.building.chain_skin import SkinTopology, skin_topology
from cadpanel.brep.building.normal_walls import strip_wall
from cadpanel.brep.building.sheet_faces import SheetFaces
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.vectors import cross


def chain_sheet(near: PanelShape, far: PanelShape) -> SheetFaces:
    """The faces of the skin `near`, and of the sheet between it and the parallel skin `far`."""
    skin, other = skin_topology(near), skin_topology(far)
    skin_is_top = float((near.points[0] - far.points[0]) @ near.normals[0]) > 0.0
    top, bottom = (skin, other) if skin_is_top else (other, skin)
    below = [TopoDS.Face_s(face.Reversed()) for face in bottom.faces]
    own, away = (top.faces, below) if skin_is_top else (below, top.faces)
    return SheetFaces(skin.faces, own, away, _walls(near, top, bottom))


def _walls(shape: PanelShape, top: SkinTopology, bottom: SkinTopology) -> list[TopoDS_Face]:
    """Two side walls and two end walls, of a square sheet one at the end of each patch; all with outward normals."""
    last = len(shape.points) - 1
    posts = {
        (end, ruling): edges.line_edge(
            bottom.vertices[end][ruling],
            top.vertices[end][ruling],
            bottom.corners[end, ruling],
            top.corners[end, ruling],
        )
        for end in range(2)
        for ruling in (range(last + 1) if shape.square else (0, last))
    }
    sides = [
        _side_wall(shape, ruling, outward, top, bottom, (posts[0, ruling], posts[1, ruling]))
        for ruling, outward in ((0, -1), (last, 1))
    ]
    if shape.square:
        return sides + [
            _square_wall(shape, (top, bottom), end, index, (posts[end, index], posts[end, index + 1]))
            for end in range(2)
            for index in range(last)
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
    """The wall through a free ruling, as it leans, or in its plane; `outward` is +1 where it faces along b."""
    loop = [bottom.rulings[ruling].Reversed(), posts[0], top.rulings[ruling], posts[1].Reversed()]
    # t then n turns about t x n = b, so up the far post and back along the top is the loop about b, and this is -b's.
    if outward > 0:
        loop = [edge.Reversed() for edge in reversed(loop)]
    side = 0 if ruling == 0 else 1
    plane = shape.side_planes[side]
    if plane is not None and shape.square:
        far = top if top.side_strips else bottom
        near = bottom if far is top else top
        along = near.rulings[ruling], far.rulings[ruling]
        return strip_wall(far.side_strips[ruling], loop, along, posts, plane.normal)
    if plane is not None:
        wall = surfaces.plane_surface(plane.point, plane.normal, cross(plane.normal, shape.normals[ruling]))
        return edges.face_on(wall.surface, wall.agrees, loop)
    way_up = shape.normals[ruling] + shape.side_leans[side] * shape.binormals()[ruling]
    normal = outward * cross(shape.directions[ruling], way_up)
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


def _square_wall(
    shape: PanelShape,
    faces: tuple[SkinTopology, SkinTopology],
    end: int,
    index: int,
    posts: tuple[TopoDS_Edge, TopoDS_Edge],
) -> TopoDS_Face:
    """The wall of normals at an end of one patch: a plane, or where the sheet is round a strip."""
    top, bottom = faces
    outward = (1.0 if end else -1.0) * (shape.directions[index] + shape.directions[index + 1])
    loop: list[TopoDS_Shape] = [posts[0], top.ends[end][index], posts[1].Reversed(), bottom.ends[end][index].Reversed()]
    if end == 0:
        loop = [edge.Reversed() for edge in reversed(loop)]
    far = top if top.strips[end] else bottom
    if index in far.strips[end]:
        near = bottom if far is top else top
        along = near.ends[end][index], far.ends[end][index]
        return strip_wall(far.strips[end][index], loop, along, posts, outward)
    start, stop = bottom.corners[end, index : index + 2]
    normal = cross(stop - start, shape.normals[index])
    wall = surfaces.plane_surface(start, normal if normal @ outward > 0.0 else -normal, stop - start)
    return edges.face_on(wall.surface, wall.agrees, loop)
