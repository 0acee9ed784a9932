"""From a panel's faces to its outline: one closed loop of free edges, cut into sides at its corners."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.reference.inner_edges import panel_edges, split_at_vertices
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline_faults import check_faces, check_loops, narrowest, refuse_hairs
from cadpanel.reference.outline_sides import Side, cut_at_corners
from cadpanel.reference.outline_walk import (
    BRIDGED_PART,
    TOUCH_TOLERANCE,
    Walk,
    touch_tolerance,
    walk_along,
    walk_round,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outline:
    """A panel's outline.

    Attributes:
        sides: three or more in walking order, each beginning where the one before ends.
        face_signs: for each face 1 or -1, which turns its normals to the side of the first face.
    """

    sides: tuple[Side, ...]
    face_signs: tuple[float, ...]


def find_outline(panel: RawPanel, source: str, tolerance: float = TOUCH_TOLERANCE) -> Outline:
    """Return the outline of a panel, whatever the order and direction of its faces and edges.

    Args:
        panel: the panel as sampled.
        source: the file's name, for messages.
        tolerance: gaps between the faces up to this width are bridged, mm.

    Raises:
        OutlineError: a face has no area, the faces do not touch, or their outline is not one loop with corners.
        PanelError: there are no faces, or one is too narrow.
    """
    check_faces(panel, source)
    return _outline(panel, source, walk_round(panel, tolerance))


def outline_and_gap(panel: RawPanel, source: str, tolerance: float) -> tuple[Outline | None, float]:
    """What `find_outline` and `bridged_gap` give, walked round once; no outline where the panel has none."""
    try:
        check_faces(panel, source)
    except PanelError:
        return None, bridged_gap(panel, tolerance)
    walk = walk_round(panel, tolerance)
    try:
        outline = _outline(panel, source, walk)
    except PanelError:
        return None, _gap(panel, walk)
    return outline, _gap(panel, walk)


def _outline(panel: RawPanel, source: str, walk: Walk) -> Outline:
    if not walk.is_whole(panel):
        refuse_hairs(panel, source, touch_tolerance(panel))
        check_loops(panel, source, walk.signs, walk.free, walk.loops, walk.loose, walk.tolerance)
    loop = [replace(edge, normals=walk.signs[edge.face] * edge.normals) for edge in walk.loops[0]]
    sides = cut_at_corners(loop, panel, source, walk.tolerance)
    return Outline(sides=sides, face_signs=tuple(walk.signs[face] for face in range(len(panel.faces))))


def find_loops(panel: RawPanel, source: str, tolerance: float, count: int) -> tuple[tuple[Array, ...], ...]:
    """The closed lines that bound a panel's faces, each as the edges (count, 3) that follow each other round it, mm.

    None where the faces do not hang together, or their edges do not close.

    Args:
        panel: as sampled.
        source: the file's name, for messages.
        tolerance: gaps between the faces up to this width are bridged, mm.
        count: of even points on each edge.

    Raises:
        OutlineError: a face has no area.
        PanelError: there are no faces.
    """
    check_faces(panel, source)
    close = touch_tolerance(panel)
    even = np.linspace(0.0, 1.0, count)
    # The widest gap first: unbridged, two parts of a strip have two borders, as a ring has.
    for bridged in dict.fromkeys((max(close, min(tolerance, BRIDGED_PART * narrowest(panel))), close)):
        whole = panel_edges(panel, bridged)
        for edges in (whole, split_at_vertices(whole, bridged)):
            walk = walk_along(edges, panel, bridged)
            if not walk.loose and len(walk.signs) == len(panel.faces):
                return tuple(tuple(edge.at(even * edge.length)[0] for edge in loop) for loop in walk.loops)
    return ()


def bridged_gap(panel: RawPanel, tolerance: float) -> float:
    """Width of the widest gap between faces of a panel that its outline bridges, mm.

    Args:
        panel: with faces that have an area.
        tolerance: as for `find_outline`, mm.
    """
    return 0.0 if len(panel.faces) < 2 else _gap(panel, walk_round(panel, tolerance))


def _gap(panel: RawPanel, walk: Walk) -> float:
    return 0.0 if len(panel.faces) < 2 else max((contact.gap for contact in walk.contacts), default=0.0)
