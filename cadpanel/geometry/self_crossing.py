"""Does an end of the skin run into itself? Asked only of chains that turn far enough for it to be possible."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import axis_frame, cut_cone, elliptic_section, lifted
from cadpanel.geometry.panel import Chain
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_sides import end_spans
from cadpanel.geometry.vectors import cross

ARC_POINTS = 33
"""Points by which an arc is stood in for: within 1e-3 of its radius even at half a turn."""


def end_polyline(shape: Chain, end: int, arc_points: int = ARC_POINTS) -> Array:
    """(m, 3) the end curve, line - conic - line, as points from the first ruling to the last, mm."""
    corners = shape.corners()[end]
    pieces, spans = [corners[:1]], end_spans(shape)[end].tolist()
    for index, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
            cut = lifted(frame, shape.lift)
            section = elliptic_section(cut, cut_cone(cut, shape.cut_points[end], shape.cut_normals[end]), spans[index])
            parameters = np.linspace(section.start, section.stop, arc_points)[1:-1]
            back = shape.lift * frame.normals(section.sweep_angles(parameters))
            pieces.append(section.points(parameters) - back)
        pieces.append(corners[index + 1 : index + 2])
    return np.concatenate(pieces)


def crosses_itself(shape: Chain) -> bool:
    """Whether either end curve meets itself, to the accuracy of its polyline. The shape must be trimmed properly."""
    return any(_polyline_crosses(end_polyline(shape, end), shape.cut_normals[end]) for end in range(2))


def _polyline_crosses(points: Array, normal: Array) -> bool:
    """Whether any two segments that are not neighbours cross, seen along `normal`."""
    # What always goes forwards from its start towards its end cannot meet itself, and that is quick to see.
    if (np.diff(points, axis=0) @ (points[-1] - points[0]) > 0.0).all():
        return False
    start, stop = points[:-1], points[1:]

    def sides(origin: Array, toward: Array, others: Array) -> Array:
        """(m, m) on which side of segment i, from origin to toward, point j lies."""
        spans = (toward - origin)[:, None, :]
        return np.asarray(cross(spans, others[None, :, :] - origin[:, None, :]) @ normal)

    splits = sides(start, stop, start) * sides(start, stop, stop) <= 0.0
    index = np.arange(len(start))
    apart = np.abs(index[:, None] - index[None, :]) > 1
    return bool((splits & splits.T & apart).any())
