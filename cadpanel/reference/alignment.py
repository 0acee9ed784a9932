"""From sheets to panels' references: ends and sides in their places, and all panels of a strip facing the same way."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.order import goes_backwards, order_in_space
from cadpanel.geometry.vectors import norm
from cadpanel.reference.model import PanelReference, Seam
from cadpanel.reference.oriented_panel import Sheet, turning
from cadpanel.reference.seam_finding import SideContact

# Where the loop's sides, counted from the one that becomes end 0, stand among the edges of a panel.
_PLACE = {0: 0, 2: 1, 3: 2, 1: 3}


def orient(sheet: Sheet, first: int) -> PanelReference:
    """The panel's reference; with four sides `first` and the one opposite become the ends.

    Counterclockwise about the normal come end 0 along b, side 1 along t, end 1 against b and side 0 against t.
    """
    if len(sheet.sides) != 4:
        edges, normals = tuple(side.points for side in sheet.sides), tuple(side.normals for side in sheet.sides)
        return _panel(sheet, edges, normals)
    end_0, side_1, end_1, side_0 = (sheet.sides[(first + k) % 4] for k in range(4))
    panel = _panel(
        sheet,
        (end_0.points, end_1.points[::-1], side_0.points[::-1], side_1.points),
        (end_0.normals, end_1.normals[::-1], side_0.normals[::-1], side_1.normals),
    )
    return replace(panel, turning=turning(sheet, first))


def edge_of(sheet: Sheet, first: int, side: int) -> int:
    """Which edge of the oriented panel a side of the loop becomes."""
    return _PLACE[(side - first) % 4] if len(sheet.sides) == 4 else side


def _panel(sheet: Sheet, edges: tuple[Array, ...], normals: tuple[Array, ...]) -> PanelReference:
    return PanelReference(
        name=sheet.name,
        points=sheet.points,
        normals=sheet.normals,
        weights=sheet.weights,
        edges=edges,
        edge_normals=normals,
    )


def turn(panel: PanelReference) -> PanelReference:
    """The same panel of four edges turned by 180 degrees about its normal: both ends and both sides change places."""
    order = (1, 0, 3, 2)
    return replace(
        panel,
        edges=tuple(panel.edges[i][::-1] for i in order),
        edge_normals=tuple(panel.edge_normals[i][::-1] for i in order),
    )


def find_seams(
    panels: Sequence[PanelReference], sheets: Sequence[Sheet], first: Sequence[int], contacts: Sequence[SideContact]
) -> tuple[Seam, ...]:
    """The seams between oriented panels."""
    seams = []
    for contact in contacts:
        (one, other), sides = contact.panels, contact.sides
        edges = edge_of(sheets[one], first[one], sides[0]), edge_of(sheets[other], first[other], sides[1])
        seams.append(Seam(panels=(one, other), edges=edges, reversed=_run_against(panels, (one, other), edges)))
    return tuple(seams)


def _run_against(panels: Sequence[PanelReference], which: tuple[int, int], edges: tuple[int, int]) -> bool:
    one, other = (panels[panel].edges[edge] for panel, edge in zip(which, edges, strict=True))
    direct = norm(one[0] - other[0]) + norm(one[-1] - other[-1])
    crossed = norm(one[0] - other[-1]) + norm(one[-1] - other[0])
    return bool(crossed < direct)


def align(
    panels: Sequence[PanelReference], seams: Sequence[Seam], tolerance: float
) -> tuple[tuple[PanelReference, ...], tuple[Seam, ...]]:
    """Turn panels so that along a strip the end 1 of each meets the end 0 of the next, and sides alike.

    Each strip's direction is taken from its place in space: the panel whose middle comes first by x, then y, then z (in
    steps of the tolerance, mm) points with its largest component forwards. File order does not matter.
    """
    neighbours: list[list[tuple[int, bool]]] = [[] for _ in panels]
    for seam in seams:
        (one, other), (mine, theirs) = seam.panels, seam.edges
        if panels[one].four_sided and panels[other].four_sided and mine // 2 == theirs // 2:
            neighbours[one].append((other, mine == theirs))
            neighbours[other].append((one, mine == theirs))
    middles = np.array([panel.corners.reshape(-1, 3).mean(axis=0) for panel in panels])
    order = order_in_space(middles, tolerance)
    turned: dict[int, bool] = {}
    for start in order.tolist():
        if start in turned:
            continue
        turned[start] = panels[start].four_sided and _points_backwards(panels[start])
        front = deque([start])
        while front:
            panel = front.popleft()
            for other, same in neighbours[panel]:
                if other not in turned:
                    turned[other] = turned[panel] != same
                    front.append(other)
    aligned = tuple(turn(panel) if turned[index] else panel for index, panel in enumerate(panels))
    return aligned, tuple(_turned_seam(seam, turned) for seam in seams)


def _points_backwards(panel: PanelReference) -> bool:
    """Tell whether the way from end 0 to end 1 goes against the axis that it follows most."""
    along = (panel.corners[1] - panel.corners[0]).mean(axis=0)
    return goes_backwards(along)


def _turned_seam(seam: Seam, turned: dict[int, bool]) -> Seam:
    """Return the seam as it is called after some panels were turned."""
    first, second = (turned[panel] for panel in seam.panels)
    edges = (seam.edges[0] ^ first, seam.edges[1] ^ second)
    return Seam(panels=seam.panels, edges=edges, reversed=seam.reversed != (first != second))
