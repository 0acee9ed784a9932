"""What may be wrong with a panel's faces, so that they have no outline, in one sentence with what to do about it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import OutlineError, PanelError
from cadpanel.geometry.polyline import arc_lengths, distances_to_polylines
from cadpanel.geometry.vectors import cross
from cadpanel.reference.inner_edges import Edge
from cadpanel.reference.model import RawPanel

# A face whose area is less than this part of its outline's length squared is a line.
SLIVER = 1e-6
# Where every loop of an outline turns by less than this in the surface, radians, the surface is closed round like a
# tube, and has no hole.
ROUND = np.pi


def check_faces(panel: RawPanel, source: str) -> None:
    """Refuse a panel without faces, and one with a face that has shrunk to a line or a point.

    Raises:
        OutlineError: naming the face by its place.
        PanelError: there are no faces.
    """
    if not panel.faces:
        raise PanelError(panel.name, f"in '{source}', it holds no face: take it out of the export.")
    for place, (face, (area, around)) in enumerate(zip(panel.faces, _measures(panel), strict=True), start=1):
        if len(face.points) == 0 or area <= SLIVER * around**2:
            fault = f"face {place} of {len(panel.faces)} has no area"
            raise OutlineError(panel.name, source, fault, "delete it and export again")


def refuse_hairs(panel: RawPanel, source: str, tolerance: float) -> None:
    """Say of a panel without an outline that one of its faces is so narrow that its short edges count as points.

    Raises:
        PanelError: naming the face by its place, and its width.
    """
    for place, (area, around) in enumerate(_measures(panel), start=1):
        if 2.0 * area <= tolerance * around:
            raise PanelError(
                panel.name,
                f"in '{source}', face {place} of {len(panel.faces)} is only {2.0 * area / around:.2g} mm wide, too "
                "narrow for a panel: leave it out, or cut the surface into fewer panels.",
            )


def check_loops(
    panel: RawPanel,
    source: str,
    signs: dict[int, float],
    free: Sequence[Edge],
    loops: Sequence[Sequence[Edge]],
    loose: Sequence[Array],
    tolerance: float,
) -> None:
    """Say why a panel's free edges do not form one closed outline, where they do not."""
    count = len(panel.faces)
    if len(signs) < count:
        gap = _gap(panel, signs)
        touch = f"only {len(signs)} of its {count} faces touch each other along"
        fault = (
            f"{touch} whole edges"
            if gap <= tolerance
            else f"{touch} an edge, the nearest other one is {gap:.3g} mm away"
        )
        raise OutlineError(panel.name, source, fault, "join the faces, or export them as panels of their own")
    if not free:
        fault = "it is a closed surface without an outline"
        raise OutlineError(panel.name, source, fault, "export an open sheet of four sides, or cut it with a grid")
    if loose:
        x, y, z = loose[0]
        if count == 1:
            fault = f"its outline comes within {tolerance:.2g} mm of itself at ({x:.1f}, {y:.1f}, {z:.1f})"
            raise OutlineError(panel.name, source, fault, "widen the slit there, or cut it with a grid across the slit")
        fault = f"its outline is not closed or branches at ({x:.1f}, {y:.1f}, {z:.1f})"
        raise OutlineError(panel.name, source, fault, "join its faces along whole edges and export again")
    if len(loops) > 1:
        fault = f"its outline has {len(loops)} loops where a panel has one"
        if all(abs(_turn_round(loop, signs)) < ROUND for loop in loops):
            closed = f"it is closed round, {fault}"
            raise OutlineError(panel.name, source, closed, "cut it with a grid, or divide it round, into 2 or more")
        raise OutlineError(panel.name, source, fault, "close its holes, trim faces that overlap, and export again")


def narrowest(panel: RawPanel) -> float:
    """Width of the narrowest of a panel's faces, twice its area against its boundary's length, mm."""
    return min(2.0 * area / around if around > 0.0 else np.inf for area, around in _measures(panel))


def _measures(panel: RawPanel) -> list[tuple[float, float]]:
    """Area (mm^2) of each face, and how long its boundary is (mm)."""
    lengths = iter(arc_lengths([points for face in panel.faces for points in face.edges]))
    return [(float(face.weights.sum()), sum(float(next(lengths)[-1]) for _ in face.edges)) for face in panel.faces]


def _turn_round(loop: Sequence[Edge], signs: dict[int, float]) -> float:
    """By how much a closed loop turns in its surface, radians: about a hole a whole turn, round a tube 0."""
    points = np.concatenate([edge.points[:-1] for edge in loop])
    normals = np.concatenate([signs[edge.face] * edge.normals[:-1] for edge in loop])
    steps = np.roll(points, -1, axis=0) - points
    before = np.roll(steps, 1, axis=0)
    about = np.sum(cross(before, steps) * normals, axis=1)
    return float(np.arctan2(about, np.sum(before * steps, axis=1)).sum())


def _gap(panel: RawPanel, connected: dict[int, float]) -> float:
    """Least distance from the edges of the connected faces to the points of those of the others, mm."""
    inside, outside = (
        [edge for face, samples in enumerate(panel.faces) if (face in connected) == side for edge in samples.edges]
        for side in (True, False)
    )
    if not inside or not outside:
        return float("inf")
    points = np.concatenate(outside)[None]
    return min(float(distances_to_polylines(points, edge[None]).min()) for edge in inside)
