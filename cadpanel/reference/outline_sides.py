"""The sides of an outline: a closed loop of edges, cut where it turns, in evenly spaced points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import OutlineError
from cadpanel.geometry.polyline import end_tangents, interpolate
from cadpanel.geometry.vectors import unit
from cadpanel.reference.inner_edges import Edge
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline_faults import refuse_hairs

# The outline has a corner where it turns by more than this in the surface, degrees. Where it turns less, but by more
# than the second, a curved panel with four clear corners has bent edges, and any other one has a corner there, too.
CORNER_ANGLE = 30.0
OBTUSE_CORNER = 5.0
FOUR = 4
# A panel is flat where its normals lie within this angle of their mean, degrees.
FLAT = 0.5
FEWEST_CORNERS = 3
# Points on each side of the outline that is handed on.
OUTLINE_POINTS = 65
EVEN_PARTS = np.linspace(0.0, 1.0, OUTLINE_POINTS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Side:
    """One of the outline's sides: (q, 3) points (mm) and the surface's (q, 3) unit normals, evenly spaced."""

    points: Array
    normals: Array
    length: float


def cut_at_corners(loop: Sequence[Edge], panel: RawPanel, source: str, tolerance: float) -> tuple[Side, ...]:
    """Cut a closed loop of edges into its sides."""
    turns = _turns(loop)
    corners = np.flatnonzero(turns > CORNER_ANGLE).tolist()
    if len(corners) > FOUR:
        # An end that crosses a crease aslant turns there in the sheet, too, and is one cut all the same.
        off_creases = [corner for corner in corners if not _at_crease(loop, corner)]
        corners = off_creases if len(off_creases) == FOUR else corners
    if len(corners) != FOUR or _is_flat(loop):
        corners = np.flatnonzero(turns > OBTUSE_CORNER).tolist()
    if len(corners) < FEWEST_CORNERS:
        refuse_hairs(panel, source, tolerance)
        places = ", ".join("({:.1f}, {:.1f}, {:.1f})".format(*loop[index].points[0]) for index in corners)
        raise OutlineError(
            panel.name,
            source,
            f"its outline has {len(corners)} corners{f' (at {places})' if places else ''} where a panel has "
            f"{FEWEST_CORNERS} or more",
            "trim it to edges that meet in corners, or cut it with a grid",
        )
    turned = [*loop[corners[0] :], *loop[: corners[0]]]
    cuts = [corner - corners[0] for corner in corners] + [len(loop)]
    return _sides([turned[start:stop] for start, stop in pairwise(cuts)])


def _at_crease(loop: Sequence[Edge], start: int) -> bool:
    """Whether the loop goes from one face to another at the start of an edge, and the normals turn as at a corner."""
    before, after = loop[start - 1], loop[start]
    sharp = before.normals[-1] @ after.normals[0] < np.cos(np.radians(CORNER_ANGLE))
    return bool(before.face != after.face and sharp)


def _is_flat(loop: Sequence[Edge]) -> bool:
    normals = np.concatenate([edge.normals for edge in loop])
    return bool((normals @ unit(normals.sum(axis=0))).min() >= np.cos(np.radians(FLAT)))


def _turns(loop: Sequence[Edge]) -> Array:
    """Angle (k,) by which the outline turns at the start of each of its k edges, seen along the normal, degrees.

    A sharp fold, where the outline runs over the edge between two faces, turns about that edge and not about the
    normal: it is no corner.
    """
    leaving = end_tangents(np.array([edge.points[:3] for edge in loop]))
    arriving = np.roll(-end_tangents(np.array([edge.points[:-4:-1] for edge in loop])), 1, axis=0)
    normals = np.array([loop[index - 1].normals[-1] + edge.normals[0] for index, edge in enumerate(loop)])
    normals = unit(normals)[:, None]
    tangents = np.stack([arriving, leaving], axis=1)
    flat = unit(tangents - np.sum(tangents * normals, axis=-1, keepdims=True) * normals)
    turns: Array = np.degrees(np.arccos(np.clip(np.sum(flat[:, 0] * flat[:, 1], axis=-1), -1.0, 1.0)))
    return turns


def _sides(groups: Sequence[Sequence[Edge]]) -> tuple[Side, ...]:
    """Join consecutive edges into evenly spaced polylines, one a group."""
    lengths, positions = [], []
    for edges in groups:
        starts = np.cumsum([0.0, *(edge.length for edge in edges)])
        even = EVEN_PARTS * starts[-1]
        borders = [0, *np.searchsorted(even, starts[1:-1]).tolist(), OUTLINE_POINTS]
        positions += [
            even[low:high] - start for (low, high), start in zip(pairwise(borders), starts[:-1].tolist(), strict=True)
        ]
        lengths.append(float(starts[-1]))
    edges = [edge for group in groups for edge in group]
    known = np.hstack([np.concatenate([edge.points for edge in edges]), np.concatenate([e.normals for e in edges])])
    values = interpolate([edge.lengths for edge in edges], known, positions).reshape(len(groups), OUTLINE_POINTS, 6)
    points, normals = values[..., :3], unit(values[..., 3:])
    return tuple(Side(points=points[side], normals=normals[side], length=length) for side, length in enumerate(lengths))
