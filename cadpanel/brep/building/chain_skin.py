"""A chain's skin as faces of exact planes, cones and cylinders that share their straight generatrices.

A side that stands in a plane is a conic, near a ruling and of any kind: its edge is a spline as close as rounding lets
it be, as the kernel's hyperbolas are no good where they are all but lines.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import cast

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.GeomAbs import GeomAbs_G1
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Vertex

from cadpanel.arrays import Array
from cadpanel.brep.building import edges, surfaces
from cadpanel.brep.building.interpolation import interpolate
from cadpanel.brep.building.normal_walls import NormalStrip, strip_along_arc, strip_along_side
from cadpanel.geometry.cone_sections import AxisFrame, EllipticSection, axis_frame, cut_cone, elliptic_section, lifted
from cadpanel.geometry.patches import ConePatch, Patch
from cadpanel.geometry.plane_sides import SideCurve, end_spans, side_curves
from cadpanel.geometry.shape import PanelShape

_BUILDER = BRep_Builder()


@dataclass(frozen=True, slots=True, kw_only=True)
class SkinTopology:
    """The pieces of a skin with k patches, so that walls can share them.

    Attributes:
        corners: (2, k + 1, 3) mm.
        vertices: [end][ruling].
        rulings: k + 1 edges from end 0 to end 1, straight but for those of sides that stand in planes.
        ends: [end][patch] edges from ruling i to ruling i + 1.
        faces: k faces with their normals along n.
        strips: [end][patch] on the other face of a square sheet: the normals between the two faces at the ends of round
            patches; empty elsewhere.
        side_strips: the same by the rulings of sides that stand in planes.
    """

    corners: Array
    vertices: tuple[tuple[TopoDS_Vertex, ...], tuple[TopoDS_Vertex, ...]]
    rulings: tuple[TopoDS_Edge, ...]
    ends: tuple[tuple[TopoDS_Edge, ...], tuple[TopoDS_Edge, ...]]
    faces: tuple[TopoDS_Face, ...]
    strips: tuple[dict[int, NormalStrip], dict[int, NormalStrip]]
    side_strips: dict[int, NormalStrip]


def chain_skin(shape: PanelShape) -> tuple[TopoDS_Face, ...]:
    """The faces of a skin that has passed its checks, their normals along n."""
    return skin_topology(shape).faces


def skin_topology(shape: PanelShape) -> SkinTopology:
    """Vertices, edges and faces of a skin that has passed its checks."""
    corners = shape.corners()
    rulings_count = len(shape.points)
    vertices = [[edges.vertex_at(corners[end, ruling]) for ruling in range(rulings_count)] for end in range(2)]
    sides = dict(zip((0, rulings_count - 1), side_curves(shape), strict=True))
    side_strips = {
        ruling: strip_along_side(curve, shape.lift)
        for ruling, curve in sides.items()
        if curve is not None and shape.lift != 0.0
    }
    rulings = [
        edges.spline_edge(vertices[0][ruling], vertices[1][ruling], side_strips[ruling].far)
        if ruling in side_strips
        else _along((vertices[0][ruling], vertices[1][ruling]), corners[:, ruling], sides.get(ruling))
        for ruling in range(rulings_count)
    ]
    ends: list[list[TopoDS_Edge]] = [[], []]
    faces: list[TopoDS_Face] = []
    strips: tuple[dict[int, NormalStrip], dict[int, NormalStrip]] = ({}, {})
    for index, patch in enumerate(shape.patches):
        frame, sections = _sections(shape, index, patch, end_spans(shape)[:, index])
        for end, section in enumerate(sections):
            first, last = vertices[end][index : index + 2]
            if frame is None or section is None:
                edge = edges.line_edge(first, last, corners[end, index], corners[end, index + 1])
            elif shape.lift == 0.0:
                edge = edges.arc_edge(first, last, section)
            else:
                strips[end][index] = strip_along_arc(frame, section, -shape.lift)
                edge = edges.spline_edge(first, last, strips[end][index].far)
            ends[end].append(edge)
        border = (ends[0][index], rulings[index + 1], ends[1][index], rulings[index])
        faces.append(_patch_face(shape, index, corners, sections, border, (sides.get(index), sides.get(index + 1))))
    for index in range(1, rulings_count - 1):
        _BUILDER.Continuity(rulings[index], faces[index - 1], faces[index], GeomAbs_G1)
    return SkinTopology(
        corners=corners,
        vertices=(tuple(vertices[0]), tuple(vertices[1])),
        rulings=tuple(rulings),
        ends=(tuple(ends[0]), tuple(ends[1])),
        faces=tuple(faces),
        strips=strips,
        side_strips=side_strips,
    )


Sections = tuple[EllipticSection | None, EllipticSection | None]


Sides = tuple[SideCurve | None, SideCurve | None]


def _along(ends: tuple[TopoDS_Vertex, TopoDS_Vertex], corners: Array, curve: SideCurve | None) -> TopoDS_Edge:
    """The edge along a ruling, or a side, between corners (2, 3)."""
    if curve is None:
        return edges.line_edge(*ends, *corners)
    low, high = curve.heights.tolist()
    found = interpolate(curve.points, low, high, np.ones(3), abs(curve.frame.level_radius))
    return edges.spline_edge(*ends, found)


def _sections(shape: PanelShape, index: int, patch: Patch, spans: Array) -> tuple[AxisFrame | None, Sections]:
    """The patch that the planes at the ends cut, from its axis, and where they do; nothing of a plane."""
    if not isinstance(patch, ConePatch):
        return None, (None, None)
    own = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    frame = lifted(own, shape.lift)
    low, high = (
        elliptic_section(frame, cut_cone(frame, point, normal), (first, last))
        for point, normal, (first, last) in zip(shape.cut_points, shape.cut_normals, spans.tolist(), strict=True)
    )
    return frame, (low, high)


def _patch_face(
    shape: PanelShape,
    index: int,
    corners: Array,
    sections: Sections,
    border: tuple[TopoDS_Edge, TopoDS_Edge, TopoDS_Edge, TopoDS_Edge],
    sides: Sides,
) -> TopoDS_Face:
    """The face of one patch; `border` runs end 0, ruling i + 1, end 1, ruling i, all edges in their own direction.

    `sides` are the curves of its rulings i and i + 1 where these are sides that stand in planes.
    """
    patch = shape.patches[index]
    point, direction, normal = shape.points[index], shape.directions[index], shape.normals[index]
    if isinstance(patch, ConePatch):
        frame = axis_frame(point, direction, normal, patch)
        # Along the axis, not along the rulings: their points need not lie on the same level.
        heights = (corners[:, index : index + 2] - frame.center) @ frame.axis / math.cos(patch.half_angle)
        surface = surfaces.round_surface(frame, float(heights.mean()))
        for edge, section in zip((border[0], border[2]), sections, strict=True):
            edges.lay_on_surface(edge, surfaces.arc_on_round(surface, cast(EllipticSection, section)), surface.surface)
        angles = (0.0, patch.sweep)
        for edge, angle, start, curve in zip((border[3], border[1]), angles, heights[0].tolist(), sides, strict=True):
            along = (
                surfaces.generatrix_on_round(surface, angle, start)
                if curve is None
                else surfaces.side_on_round(surface, curve)
            )
            edges.lay_on_surface(edge, along, surface.surface)
        return edges.face_on(surface.surface, surface.agrees, _loop(border))
    plane = surfaces.plane_surface(corners[0, index], normal, direction)
    return edges.face_on(plane.surface, plane.agrees, _loop(border))


def _loop(border: tuple[TopoDS_Edge, TopoDS_Edge, TopoDS_Edge, TopoDS_Edge]) -> tuple[TopoDS_Edge, ...]:
    """Counterclockwise about n, since b x t = n."""
    return border[0], border[1], cast(TopoDS_Edge, border[2].Reversed()), cast(TopoDS_Edge, border[3].Reversed())
