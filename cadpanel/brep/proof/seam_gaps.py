"""How wide the gaps are that the fit has left between skins, measured on the faces in the file. Millimetres.

The skins in the file are cut back from the seams. Their planes, cones and cylinders go on to where the fit has cut
them: a seam's gap is that between the curves in which they end there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.edge_pieces import edge_pieces
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.geometry.cone_sections import AxisFrame, as_pieces, cut_cone, elliptic_section
from cadpanel.geometry.curve_hausdorff import hausdorff_distances
from cadpanel.geometry.curve_pieces import CurvePieces, segments, together
from cadpanel.geometry.shape import edge_corners
from cadpanel.geometry.vectors import cross, unit

GAP_LIMIT = 1e-4
"""How much wider than stated a seam may be, mm, and as a part of its gap: both are found by sampling, and where edges
of different kinds stand far apart the farthest point lies between two samples."""
ON_SURFACE = 1e-6
"""Distance in mm of a corner from the faces in the file that go on to it."""


def seam_gaps(
    panels: Iterable[ExpectedPanel],
    skin_of: dict[str, ShapeFacts],
    seams: Sequence[ExpectedSeam],
    failures: list[str],
) -> list[float]:
    """Measured gap of each seam; one whose ends cannot be found fails and counts as infinitely wide."""
    expected = {panel.name: panel for panel in panels}
    sides: list[tuple[CurvePieces, CurvePieces]] = []
    measured: list[int] = []
    for index, seam in enumerate(seams):
        found = [
            _fitted_edge(skin_of[name], expected[name], edge) if name in skin_of and name in expected else None
            for name, edge in zip(seam.panels, seam.edges, strict=True)
        ]
        if found[0] is None or found[1] is None:
            failures.append(f"{seam.called}: an edge cannot be found on the skins.")
            continue
        sides.append((found[0], found[1]))
        measured.append(index)
    gaps = [float("inf")] * len(seams)
    distances = hausdorff_distances([one for one, _ in sides], [two for _, two in sides])
    for index, gap in zip(measured, distances.tolist(), strict=True):
        gaps[index] = gap
        stated = seams[index].gap
        if stated is not None and not gap <= stated + GAP_LIMIT * (1.0 + stated):
            failures.append(f"{seams[index].called}: the gap is {gap:.6g} mm, {stated:.6g} mm are stated.")
    return gaps


def _fitted_edge(skin: ShapeFacts, panel: ExpectedPanel, edge: str) -> CurvePieces | None:
    """The edge as the fit has it, on the faces in the file; None unless they go on to it."""
    if panel.fitted is not None and _is_folded(panel, edge):
        return _before_folding(skin, edge_corners(panel.fitted.corners, edge))
    if panel.fitted is not None and panel.side_plane(edge) is not None:
        return _before_cutting(skin, edge_corners(panel.corners, edge), edge_corners(panel.fitted.corners, edge))
    chosen = edge_pieces(skin, panel.corners, edge)
    if chosen is not None and edge.startswith("end"):
        chosen = chosen[panel.folded[0] : len(chosen) - panel.folded[1]]
    if chosen is None or not skin.border[chosen].all():
        return None
    if panel.fitted is None:
        return skin.pieces.take(chosen)
    corners = edge_corners(panel.fitted.corners, edge)
    surfaces = skin.surfaces[skin.piece_faces[chosen, 0]]
    if len(corners) != len(surfaces) + 1:
        return None
    cut = panel.fitted.cuts[int(edge[-1])] if edge.startswith("end") else None
    pieces = [
        _piece_on(surface, corners[i], corners[i + 1], cut, bent=bool(skin.pieces.arcs[chosen[i]]))
        for i, surface in enumerate(surfaces)
    ]
    known = [piece for piece in pieces if piece is not None]
    return together(known) if len(known) == len(pieces) else None


def _before_cutting(skin: ShapeFacts, built: Array, fitted: Array) -> CurvePieces | None:
    """The ruling on the face that a plane cuts between two corners now, between those that the fit has; else None."""
    ends, border = skin.other_points[:, [0, -1]], skin.other_edges[:, 1] < 0
    off = np.minimum(*(np.abs(ends - row).max(axis=(1, 2), initial=0.0) for row in (built, built[::-1])))
    for place in np.flatnonzero(border & (off <= ON_SURFACE)).tolist():
        return _piece_on(skin.surfaces[skin.other_edges[place, 0]], fitted[0], fitted[1], None, bent=False)
    return None


def _is_folded(panel: ExpectedPanel, edge: str) -> bool:
    """Whether an edge of the fit lies where the skin is folded now; of a flat panel with returns any may."""
    return panel.tray is not None or (edge.startswith("side") and panel.folded[int(edge[-1])] > 0)


def _before_folding(skin: ShapeFacts, corners: Array) -> CurvePieces | None:
    """The straight edge between two corners that lie in one flat face of the skin as it goes on; else None."""
    flat = skin.surfaces[skin.surfaces[:, 6] == 0.0]
    on_one = any(max(off_surface(surface, corner) for corner in corners) <= ON_SURFACE for surface in flat)
    return segments(corners[:1], corners[1:]) if on_one else None


def _piece_on(surface: Array, first: Array, last: Array, cut: Array | None, *, bent: bool) -> CurvePieces | None:
    """What a cut leaves of a surface between two corners; None where they do not lie on it."""
    if not max(off_surface(surface, first), off_surface(surface, last)) <= ON_SURFACE:
        return None
    if not bent:
        return segments(first[None], last[None])
    if cut is None:
        return None
    origin, axis, radius, half_angle = surface[:3], surface[3:6], float(surface[6]), float(surface[7])
    across = [corner - origin - ((corner - origin) @ axis) * axis for corner in (first, last)]
    radial = unit(across[0])
    tangential = cross(axis, radial)
    frame = AxisFrame(
        center=origin,
        axis=axis,
        radial=radial,
        tangential=tangential,
        level_radius=radius,
        half_angle=half_angle,
        sweep=math.atan2(float(across[1] @ tangential), float(across[1] @ radial)),
    )
    normal = math.copysign(1.0, float(cut[1] @ axis)) * cut[1]
    try:
        return as_pieces([elliptic_section(frame, cut_cone(frame, cut[0], normal))])
    except ValueError:
        return None


def off_surface(surface: Array, point: Array) -> float:
    """How far a point (3,) lies from a surface (9,) as `ShapeFacts` has it, mm; not a number where it is unknown."""
    offset = point - surface[:3]
    height = float(offset @ surface[3:6])
    radius, half_angle = float(surface[6]), float(surface[7])
    if radius == 0.0:
        return abs(height)
    away = float(np.linalg.norm(offset - height * surface[3:6]))
    return abs((away - radius) * math.cos(half_angle) - height * math.sin(half_angle))
