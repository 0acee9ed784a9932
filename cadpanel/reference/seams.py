"""Which panels meet: ends that coincide over their whole length, found by place and never by file order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cadpanel.errors import PanelError
from cadpanel.reference.model import PanelReference, Seam
from cadpanel.reference.orient import turn
from cadpanel.reference.polyline import distances_to_polylines, norm

Array = NDArray[np.float64]

# Ends asked for around each end: itself, the one it may meet, and enough more to notice that there are too many.
NEIGHBOURS = 4
# Pairs of ends whose curves are compared at once, so that the memory stays small.
CHUNK = 256


def refuse_duplicates(panels: Sequence[PanelReference], source: str, tolerance: float) -> None:
    """Refuse two panels whose outlines lie on each other all the way round.

    Raises:
        PanelError: naming both.
    """
    if len(panels) < 2:
        return
    corners = np.array([panel.corners.reshape(4, 3) for panel in panels])
    tree = cKDTree(corners.mean(axis=1))
    _, neighbours = tree.query(tree.data, k=min(NEIGHBOURS, len(panels)), distance_upper_bound=tolerance)
    for first, row in enumerate(np.sort(neighbours, axis=1).tolist()):
        for second in row:
            if first < second < len(panels) and _same_outline(panels[first], panels[second], tolerance):
                raise PanelError(
                    panels[second].name,
                    f"in '{source}', it lies on panel '{panels[first].name}' to within {tolerance:g} mm: "
                    "delete one of the two.",
                )


def find_seams(panels: Sequence[PanelReference], source: str, tolerance: float) -> tuple[Seam, ...]:
    """Return the seams between panels, sorted, in time that grows with N log N.

    Args:
        panels: N panels, in any order; which of their ends is end 0 does not matter.
        source: the file's name, for messages.
        tolerance: how far two ends that meet may lie apart anywhere, mm.

    Raises:
        PanelError: more than two panels meet in one end.
    """
    if len(panels) < 2:
        return ()
    curves = np.array([end for panel in panels for end in panel.ends])
    pairs, reversed_pairs = _touching_ends(curves, tolerance)
    _refuse_branches(pairs, panels, source)
    return tuple(
        Seam(panels=(first // 2, second // 2), ends=(first % 2, second % 2), reversed=backwards)
        for (first, second), backwards in zip(pairs.tolist(), reversed_pairs.tolist(), strict=True)
    )


def align(
    panels: Sequence[PanelReference], seams: Sequence[Seam], tolerance: float
) -> tuple[tuple[PanelReference, ...], tuple[Seam, ...]]:
    """Turn panels so that along a strip the end 1 of each meets the end 0 of the next.

    Each strip's direction is taken from its place in space: the panel whose middle comes first by x, then y, then z (in
    steps of the tolerance, mm) points with its largest component forwards. File order does not matter.
    """
    neighbours: list[list[tuple[int, bool]]] = [[] for _ in panels]
    for seam in seams:
        (first, second), same_end = seam.panels, seam.ends[0] == seam.ends[1]
        neighbours[first].append((second, same_end))
        neighbours[second].append((first, same_end))
    middles = np.array([panel.corners.mean(axis=(0, 1)) for panel in panels])
    order = np.lexsort(np.round(middles / tolerance).T[::-1])
    turned: dict[int, bool] = {}
    for start in order.tolist():
        if start in turned:
            continue
        turned[start] = _points_backwards(panels[start])
        front = [start]
        while front:
            panel = front.pop()
            for other, same_end in neighbours[panel]:
                if other not in turned:
                    turned[other] = turned[panel] != same_end
                    front.append(other)
    aligned = tuple(turn(panel) if turned[index] else panel for index, panel in enumerate(panels))
    return aligned, tuple(_turned_seam(seam, turned) for seam in seams)


def _touching_ends(curves: Array, tolerance: float) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Find the pairs of ends that coincide.

    Args:
        curves: (2 N, q, 3) end curves, those of one panel after each other.
        tolerance: mm.

    Returns:
        (s, 2) indices into `curves`, rising, and (s,) whether the two run against each other.
    """
    tree = cKDTree(0.5 * (curves[:, 0] + curves[:, -1]))
    _, found = tree.query(tree.data, k=min(NEIGHBOURS, len(curves)), distance_upper_bound=tolerance)
    first = np.repeat(np.arange(len(curves)), found.shape[1])
    second = found.ravel()
    # Pairs appear from both ends; one that the limit on neighbours hides from one of them is still seen by the other.
    valid = (second < len(curves)) & (first // 2 != second // 2)
    pairs = np.unique(np.sort(np.column_stack([first, second])[valid], axis=1), axis=0)
    one, other = curves[pairs[:, 0]], curves[pairs[:, 1]]
    direct = _near(one[:, 0], other[:, 0], tolerance) & _near(one[:, -1], other[:, -1], tolerance)
    backwards = _near(one[:, 0], other[:, -1], tolerance) & _near(one[:, -1], other[:, 0], tolerance) & ~direct
    keep = direct | backwards
    pairs, backwards = pairs[keep], backwards[keep]
    coincide = _coincide(curves, pairs, backwards, tolerance)
    return pairs[coincide], backwards[coincide]


def _near(first: Array, second: Array, tolerance: float) -> NDArray[np.bool_]:
    """Tell for each pair of (m, 3) points whether they lie within the tolerance: (m,)."""
    near: NDArray[np.bool_] = norm(first - second) <= tolerance
    return near


def _coincide(
    curves: Array, pairs: NDArray[np.intp], backwards: NDArray[np.bool_], tolerance: float
) -> NDArray[np.bool_]:
    """Tell for each of the (s, 2) pairs whether the two curves coincide over their whole length: (s,)."""
    first, second = curves[pairs[:, 0]], curves[pairs[:, 1]]
    opposite = np.where(backwards[:, None, None], second[:, ::-1], second)
    coincide = np.asarray((norm(first - opposite) <= tolerance).all(axis=1))
    # Points of equal rank may lie apart on curves that coincide; so those that fail are measured properly.
    doubtful = np.flatnonzero(~coincide)
    for start in range(0, len(doubtful), CHUNK):
        chunk = doubtful[start : start + CHUNK]
        there = distances_to_polylines(first[chunk], second[chunk]).max(axis=1)
        back = distances_to_polylines(second[chunk], first[chunk]).max(axis=1)
        coincide[chunk] = np.maximum(there, back) <= tolerance
    return coincide


def _refuse_branches(pairs: NDArray[np.intp], panels: Sequence[PanelReference], source: str) -> None:
    """Refuse an end that coincides with more than one other."""
    ends, counts = np.unique(pairs, return_counts=True)
    if not (counts > 1).any():
        return
    end = int(ends[counts > 1][0])
    others = sorted({int(index) // 2 for index in pairs[(pairs == end).any(axis=1)].ravel()} - {end // 2})
    names = " and ".join(f"'{panels[index].name}'" for index in others)
    raise PanelError(
        panels[end // 2].name,
        f"in '{source}', it meets panels {names} along one and the same end: a seam joins two, delete one of them.",
    )


def _same_outline(first: PanelReference, second: PanelReference, tolerance: float) -> bool:
    """Tell whether the outlines of two panels coincide, whichever way each is turned."""
    outlines = [np.concatenate([*panel.ends, *panel.sides])[None] for panel in (first, second)]
    curves = [np.array([*panel.ends, *panel.sides]) for panel in (first, second)]
    for points, others in ((outlines[0], curves[1]), (outlines[1], curves[0])):
        distances = np.array([distances_to_polylines(points, curve[None])[0] for curve in others]).min(axis=0)
        if distances.max() > tolerance:
            return False
    return True


def _points_backwards(panel: PanelReference) -> bool:
    """Tell whether the way from end 0 to end 1 goes against the axis that it follows most."""
    along = (panel.corners[1] - panel.corners[0]).mean(axis=0)
    return bool(along[np.abs(along).argmax()] < 0.0)


def _turned_seam(seam: Seam, turned: dict[int, bool]) -> Seam:
    """Return the seam as it is called after some panels were turned."""
    first, second = (turned[panel] for panel in seam.panels)
    ends = (seam.ends[0] ^ first, seam.ends[1] ^ second)
    return Seam(panels=seam.panels, ends=ends, reversed=seam.reversed != (first != second))
