"""A grid along the two parameters of each face, by parameter or by length."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepLib import BRepLib
from OCP.GCE2d import GCE2d_MakeSegment
from OCP.Geom2d import Geom2d_TrimmedCurve
from OCP.gp import gp_Pnt2d
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array
from cadpanel.brep.cutting.cut_panel import CutPanel, grid_name
from cadpanel.brep.cutting.smallest_panel import require_room
from cadpanel.brep.faces.face_patch import CLOSED, Patch, equal_parts, geometry, lengths_along, rectangle
from cadpanel.brep.faces.parameter_range import parameter_range
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.splitting.split_along_edges import split_along
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import By

# Lines across the surface over which lengths are averaged.
AVERAGED = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
# How far a piece may reach over the lines of its cell, as a part of the parameter range.
OVER_THE_LINE = 1e-5


def cut_grid(
    surface: Surface, counts: Sequence[tuple[int, int]], by: By, source: str, tolerance: float
) -> tuple[CutPanel, ...]:
    """Cut each face of a surface into a grid of so many by so many: rows follow u, columns v.

    A face that fills its parameter range is cut into exact rectangles of it; a trimmed one is split along the same
    lines, and has panels only where it lies. Panels that meet may lie apart by the tolerance, mm.

    Raises:
        ReferenceFileError: a panel would be closed round, or the kernel cannot split a trimmed face.
        SettingsError: a face has no room for so many panels.
    """
    panels: list[CutPanel] = []
    for face, numbers in zip(surface.faces, counts, strict=True):
        name = surface.name if len(surface.faces) == 1 else f"{surface.name}.{face.number}"
        for axis, count in enumerate(numbers):
            least, why = least_count(face.patch, axis)
            if count < least:
                raise ReferenceFileError(
                    f"Face {face.number} of '{source}' {why}: cut it into {least} or more that way."
                )
            what = f"parameter {'uv'[axis]} of face {face.number} of '{source}'"
            require_room(lengths_along(face.patch, axis, AVERAGED)[:, -1].tolist(), 0.0, count, what, tolerance)
        lines = [_lines(face.patch, axis, count, by) for axis, count in enumerate(numbers)]
        cells = (
            _whole_cells(face.patch, lines)
            if face.patch.whole
            else _trimmed_cells(face.patch, lines, f"face {face.number} of '{source}'")
        )
        for row, column, piece in cells:
            panels.append(CutPanel(name=grid_name(name, row, column, numbers), faces=(piece,)))
    return _told_apart(panels)


def least_count(patch: Patch, axis: int) -> tuple[int, str]:
    """How many panels a face must be cut into along a parameter for each to have corners, and why."""
    # A trimmed face need not reach a point to which its surface shrinks.
    poles = [patch.whole and _is_point(patch, 1 - axis, part) for part in (0.0, 1.0)]
    if patch.closed(axis):
        why = f"is closed along its parameter {'uv'[axis]}, and a panel cannot go round it"
        # Half-way round, what comes out of a pole goes straight on from what ran into it.
        return (3, f"{why}, nor half-way round the point to which it shrinks") if any(poles) else (2, why)
    if patch.whole and all(_is_point(patch, axis, part) for part in (0.0, 1.0)):
        return 2, f"shrinks to a point at both ends of its parameter {'uv'[axis]}, and a panel between them has 2 sides"
    return 1, ""


def _is_point(patch: Patch, axis: int, part: float) -> bool:
    """Whether all points at one part of the range of a parameter are the same."""
    points = patch.points(patch.at(axis, np.array(part), AVERAGED))
    return bool(np.ptp(points, axis=0).max() < CLOSED)


def _lines(patch: Patch, axis: int, count: int, by: By) -> Array:
    """The (count + 1,) parameters at which the grid's lines lie, the borders included."""
    parts = line_parts(patch, axis, count, by)
    low, high = patch.bounds[axis]
    lines = low + parts * (high - low)
    lines[-1] = high
    return np.asarray(lines)


def line_parts(patch: Patch, axis: int, count: int, by: By) -> Array:
    """The same as (count + 1,) parts of the parameter's range, from 0 to 1."""
    parts = np.linspace(0.0, 1.0, count + 1)
    if by == "length":
        parts[1:-1] = equal_parts(lengths_along(patch, axis, AVERAGED).mean(axis=0), parts[1:-1])
    return parts


def _whole_cells(patch: Patch, lines: list[Array]) -> list[tuple[int, int, TopoDS_Face]]:
    return [
        (row, column, rectangle(patch, u_range, v_range))
        for row, u_range in enumerate(pairwise(lines[0].tolist()))
        for column, v_range in enumerate(pairwise(lines[1].tolist()))
    ]


def _trimmed_cells(patch: Patch, lines: list[Array], what: str) -> list[tuple[int, int, TopoDS_Face]]:
    """The pieces of a trimmed face between the lines, each with its cell."""
    tools = [line_edge(patch, axis, place) for axis in (0, 1) for place in lines[axis][1:-1].tolist()]
    pieces = split_along([patch.face], tools, what).faces[0] if tools else (patch.face,)
    cells = []
    for piece in pieces:
        bounds = parameter_range(piece)
        cell = [int(np.searchsorted(lines[axis], bounds[axis].mean(), side="right")) - 1 for axis in (0, 1)]
        for axis in (0, 1):
            margin = OVER_THE_LINE * np.ptp(patch.bounds[axis])
            low, high = lines[axis][cell[axis] : cell[axis] + 2]
            if bounds[axis, 0] < low - margin or bounds[axis, 1] > high + margin:
                raise ReferenceFileError(
                    f"The CAD kernel leaves {what} uncut along a line of the grid, near {'uv'[axis]} = {low:.6g} or "
                    f"{high:.6g}: choose other numbers of panels, or split the surface where it was modelled."
                )
        cells.append((cell[0], cell[1], piece))
    return sorted(cells, key=lambda cell: cell[:2])


def line_edge(patch: Patch, axis: int, place: float) -> TopoDS_Shape:
    """The edge along which parameter `axis` has one value, over the face's whole range."""
    low, high = patch.bounds[1 - axis].tolist()
    ends = [gp_Pnt2d(place, low), gp_Pnt2d(place, high)] if axis == 0 else [gp_Pnt2d(low, place), gp_Pnt2d(high, place)]
    line: Geom2d_TrimmedCurve = GCE2d_MakeSegment(*ends).Value()
    edge = BRepBuilderAPI_MakeEdge(line, geometry(patch)).Edge()
    BRepLib.BuildCurves3d_s(edge)
    return edge


def _told_apart(panels: list[CutPanel]) -> tuple[CutPanel, ...]:
    """Where trimming leaves several pieces in one cell, they are called a, b and so on, by their place in the list."""
    seen: dict[str, int] = {}
    total: dict[str, int] = {}
    for panel in panels:
        total[panel.name] = total.get(panel.name, 0) + 1
    named = []
    for panel in panels:
        if total[panel.name] > 1:
            seen[panel.name] = seen.get(panel.name, 0) + 1
            named.append(CutPanel(name=f"{panel.name}.{seen[panel.name]}", faces=panel.faces))
        else:
            named.append(panel)
    return tuple(named)
