"""A mesh of panel corners over a surface: its inner edges cut the surface, one panel a face of the mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.curves.drawn_curve import Curve
from cadpanel.brep.curves.pieces import Piece
from cadpanel.brep.curves.reach import far_off, sags
from cadpanel.brep.cutting.cut_panel import CutPanel, middle_of
from cadpanel.brep.cutting.mesh_file import corners_and_faces
from cadpanel.brep.cutting.mesh_t_junctions import parted, uses_of
from cadpanel.brep.cutting.mesh_weld import Faces, welded
from cadpanel.brep.files.text_check import contents
from cadpanel.brep.files.units import no_unit
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.errors import ReferenceFileError

# An inner edge that ends on the mesh's border is drawn on by this part of its length, so that it surely meets the
# outline of the surface; what lies beyond is not projected.
DRAWN_ON = 0.02
FEWEST_CORNERS = 3
GIVE_UNIT = "give the mesh's unit with --unit where that is not mm"
LAY_OVER = f"lay the mesh over the surface, up to its outline all round, and {GIVE_UNIT}"
"""What to do about a mesh whose edges do not cut the surface into its faces."""
# Points along an edge that are brought onto the surface at first, as parts of its length.
PARTS = np.linspace(0.0, 1.0, 9)


class _Edge(Curve):
    """An edge between two faces, called by the corners at its ends."""

    __slots__ = ()

    @property
    def called(self) -> str:
        """How a message speaks of it."""
        return f"the edge {self.name}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Mesh:
    """A mesh.

    Attributes:
        source: the name of its file.
        corners: (n, 3) in the reference's coordinates, mm.
        faces: the corners of each face, in order round it.
        notes: what was done to it, one sentence each.
    """

    source: str
    corners: Array
    faces: tuple[tuple[int, ...], ...]
    notes: tuple[str, ...] = ()

    def curves(self) -> tuple[Curve, ...]:
        """The edges between two faces, in their order, as curves; none where no faces meet."""
        uses = uses_of(self.faces)
        on_border = {corner for edge, count in uses.items() if count == 1 for corner in edge}
        found: list[Curve] = []
        for edge in sorted(edge for edge, count in uses.items() if count == 2):
            first, last = self.corners[list(edge)]
            way = DRAWN_ON * (last - first)
            start = first - way if edge[0] in on_border else first
            stop = last + way if edge[1] in on_border else last
            along = partial(_along, start, stop)
            points = along(PARTS)
            length = float(np.linalg.norm(last - first))
            parts = (points - first) @ (last - first) / length**2
            piece = Piece(at=along, parameters=PARTS, points=points, sags=sags(parts, length))
            found.append(
                _Edge(
                    number=len(found) + 1,
                    name=f"from corner {edge[0] + 1} to {edge[1] + 1}",
                    edge=BRepBuilderAPI_MakeEdge(kernel.point(start), kernel.point(stop)).Edge(),
                    points=piece.points,
                    parts=(piece,),
                )
            )
        return tuple(found)

    def inner_corners(self) -> list[int]:
        """Those that faces surround."""
        uses = uses_of(self.faces)
        on_border = {corner for edge, count in uses.items() if count == 1 for corner in edge}
        return sorted({corner for edge in uses for corner in edge} - on_border)

    def middles(self) -> Array:
        """(m, 3) means of the faces' corners."""
        return np.array([self.corners[list(face)].mean(axis=0) for face in self.faces])


def load_mesh(path: Path, origin: Array, millimetres: float | None, tolerance: float) -> Mesh:
    """Read an OBJ or OFF file.

    Args:
        path: the file.
        origin: (3,) what was taken off the reference's coordinates, mm.
        millimetres: how many the mesh's unit has; None where the user gives none.
        tolerance: corners this close are the same, mm.

    Raises:
        ReferenceFileError: it is neither, is damaged, or its faces do not join.
    """
    text = contents(path).decode("utf-8-sig", errors="replace")
    try:
        corners, faces = corners_and_faces(text)
    except ValueError as error:
        raise ReferenceFileError(f"'{path.name}' is a damaged OBJ or OFF mesh ({error}): export it again.") from error
    if not faces:
        raise ReferenceFileError(f"'{path.name}' is no OBJ or OFF mesh with faces: export the panels' mesh as one.")
    points = (millimetres or 1.0) * np.array(corners, dtype=np.float64).reshape(-1, 3) - origin
    if not np.isfinite(points).all():
        raise ReferenceFileError(f"'{path.name}' has corners that are not numbers: export the mesh again.")
    _check_corners(path.name, faces, len(points), "has fewer than three different corners, or one that is not there")
    shared, joined = welded(points, faces, tolerance)
    fault = f"has fewer than three corners, or one twice, as those within {tolerance:g} mm of each other are the same"
    _check_corners(path.name, shared, len(points), fault)
    _check_edges(path.name, shared)
    shared, edges = parted(points, shared)
    notes = [] if millimetres else [no_unit(path.name, "mesh")]
    if joined:
        notes.append(f"{joined} corners of '{path.name}' lie within {tolerance:g} mm of another one and count as one.")
    if edges:
        notes.append(f"{edges} edges of '{path.name}' are parted where corners of other faces lie on them.")
    return Mesh(source=path.name, corners=points, faces=shared, notes=tuple(notes))


def require_near(mesh: Mesh, surfaces: Sequence[Surface], mesh_source: str, source: str) -> None:
    """Refuse a mesh that does not lie on the surfaces; the corners of its border may lie beyond their outlines.

    Raises:
        ReferenceFileError: one of its other corners is far off.
    """
    inner = mesh.inner_corners()
    found = far_off(surfaces, mesh.corners[inner]) if inner else None
    if found is not None:
        place, distance = found
        raise ReferenceFileError(
            f"Corner {inner[place] + 1} of the mesh '{mesh_source}' lies {distance:.4g} mm off '{source}': {LAY_OVER}."
        )


def require_all_panels(mesh: Mesh, panels: Sequence[CutPanel], mesh_source: str, source: str) -> None:
    """Refuse panels that are not one a face of the mesh.

    Raises:
        ReferenceFileError: their numbers differ, or a face has none of its own.
    """
    if len(panels) != len(mesh.faces):
        raise ReferenceFileError(
            f"The mesh '{mesh_source}' has {len(mesh.faces)} faces, but the edges between them cut '{source}' into "
            f"{len(panels)} panels: {LAY_OVER}."
        )
    _, nearest = cKDTree(mesh.middles()).query(np.array([middle_of(panel.faces) for panel in panels]))
    alone = np.bincount(nearest, minlength=len(mesh.faces))
    if alone.max() > 1:
        raise ReferenceFileError(
            f"Face {int(alone.argmax()) + 1} of the mesh '{mesh_source}' lies over {int(alone.max())} panels of "
            f"'{source}', and another one over none: {LAY_OVER}."
        )


def _check_corners(name: str, faces: Sequence[tuple[int, ...]], count: int, fault: str) -> None:
    for place, face in enumerate(faces, start=1):
        if len(face) < FEWEST_CORNERS or len(set(face)) < len(face) or not all(0 <= c < count for c in face):
            raise ReferenceFileError(f"Face {place} of '{name}' {fault}: repair it, or {GIVE_UNIT}.")


def _check_edges(name: str, faces: Faces) -> None:
    uses = uses_of(faces)
    if max(uses.values()) > 2:
        (first, last), count = max(uses.items(), key=lambda item: item[1])
        raise ReferenceFileError(
            f"{count} faces of '{name}' share the edge from corner {first + 1} to {last + 1}: at most two panels can."
        )


def _along(start: Array, stop: Array, parts: Array) -> Array:
    """(m, 3) points at (m,) parts of the way."""
    return start + parts[:, None] * (stop - start)
