"""Sheets cut back from their seams, so that a joint of one width stands between any two neighbours. Millimetres.

Every seam has one plane in the middle of its joint, which both neighbours' walls are parallel to: each keeps behind it
by half of the joint, so two neighbours never share volume.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from cadpanel.geometry.corner_parting import Walls, part_at_corners
from cadpanel.geometry.edge_planes import SeamEdges, farthest, seam_plane, turned_round
from cadpanel.geometry.panel import CutPlane, Panel


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """Where two panels meet.

    Attributes:
        plane: in the middle of the joint, the normal out of the seam's first panel.
        own: clear width that was asked for of this seam alone, mm; None where it is that of all.
        recut: how far from it the farthest corner of the two edges was, mm: so far, at most, the fit's edges were moved
            to lie in one plane.
    """

    plane: CutPlane
    own: float | None
    recut: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Jointed:
    """Panels cut back from their seams, and the joint of each seam."""

    shapes: tuple[Panel, ...]
    joints: tuple[Joint, ...]


def cut_to_seams(shapes: Sequence[Panel], seams: Sequence[SeamEdges], joint: float, depth: float) -> Jointed:
    """Cut panels back from their seams.

    Args:
        shapes: as they were fitted.
        seams: which of their edges meet.
        joint: clear width between two sheets, mm, at seams that have none of their own.
        depth: the other face of a sheet is `offset(depth)`, mm.

    Raises:
        PanelError: nothing is left of a panel, or two fold back on each other.
    """
    planes = seam_planes(shapes, seams)
    walls = walls_of(len(shapes), seams, planes, joint)
    cut = [shape.cut_back(own, depth) if own else shape for shape, own in zip(shapes, walls, strict=True)]
    part_at_corners(cut, shapes, walls, [seam.panels for seam in seams], depth)
    joints = tuple(
        Joint(
            plane=plane,
            own=seam.joint,
            recut=max(farthest(plane, shapes[i], edge) for i, edge in zip(seam.panels, seam.edges, strict=True)),
        )
        for seam, plane in zip(seams, planes, strict=True)
    )
    return Jointed(shapes=tuple(cut), joints=joints)


def seam_planes(shapes: Sequence[Panel], seams: Sequence[SeamEdges]) -> tuple[CutPlane, ...]:
    """The plane of each seam, its normal out of the seam's first panel.

    Raises:
        PanelError: two panels fold back on each other.
    """
    return tuple(seam_plane((shapes[seam.panels[0]], shapes[seam.panels[1]]), seam.edges) for seam in seams)


def walls_of(count: int, seams: Sequence[SeamEdges], planes: Sequence[CutPlane], joint: float) -> list[Walls]:
    """The walls of each of `count` panels by its edges: half a joint, or half their own, behind the seams' planes."""
    walls: list[Walls] = [{} for _ in range(count)]
    for seam, plane in zip(seams, planes, strict=True):
        for panel, edge, own in zip(seam.panels, seam.edges, (plane, turned_round(plane)), strict=True):
            width = seam.width(joint)
            walls[panel][edge] = replace(own.moved(-0.5 * width), jointed=width > 0.0)
    return walls
