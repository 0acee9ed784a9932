"""Faces that meet themselves, parted there: the kernel loses curves that cross a seam."""

from __future__ import annotations

from dataclasses import replace

from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopoDS import TopoDS, TopoDS_Face

from cadpanel.brep.cutting.by_grid import line_edge
from cadpanel.brep.faces.face_patch import Patch, patch_of, rectangle
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.face_cleanup import SkinFace
from cadpanel.brep.splitting.split_along_edges import split_along


def opened(surface: Surface, source: str) -> Surface:
    """A surface of which no face meets itself: those that did are halved, in u, in v or both.

    Its faces are no longer those of its contacts.

    Args:
        surface: any.
        source: the reference's name.

    Raises:
        ReferenceFileError: the kernel cannot halve a trimmed face.
    """
    faces = [part for face in surface.faces for part in _opened(face, source)]
    return surface if len(faces) == len(surface.faces) else replace(surface, faces=tuple(faces), contacts=())


def _opened(face: SkinFace, source: str) -> list[SkinFace]:
    patches = [face.patch]
    for axis in (0, 1):
        if face.patch.closed(axis):
            what = f"face {face.number} of '{source}' along its middle"
            # A surface of its own for each: an edge where both meet has one place on it, and not one a period on.
            halves = [BRepBuilderAPI_Copy(half).Shape() for patch in patches for half in _halves(patch, axis, what)]
            patches = [patch_of(TopoDS.Face_s(half)) for half in halves]
    return [replace(face, patch=patch) for patch in patches]


def _halves(patch: Patch, axis: int, what: str) -> tuple[TopoDS_Face, ...]:
    middle = float(patch.bounds[axis].mean())
    if not patch.whole:
        return split_along([patch.face], [line_edge(patch, axis, middle)], what).faces[0]
    ranges = [tuple(own) for own in patch.bounds.tolist()]
    low, high = ranges[axis]
    return tuple(
        rectangle(patch, half, ranges[1]) if axis == 0 else rectangle(patch, ranges[0], half)
        for half in ((low, middle), (middle, high))
    )
