"""Which sides of panels coincide over their whole length, found by place and never by file order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.errors import PanelError
from cadpanel.geometry.polyline import distances_to_curves
from cadpanel.geometry.vectors import norm
from cadpanel.reference.oriented_panel import Sheet, curves

# Sides asked for around each side: itself, the one it may meet, and enough more to notice that there are too many.
NEIGHBOURS = 4
# Pairs of sides whose curves are compared at once, so that the memory stays small.
CHUNK = 256


@dataclass(frozen=True, slots=True)
class SideContact:
    """Two sides that coincide.

    Attributes:
        panels: the two panels, the lower index first.
        sides: which side of each, by its place in the panel's loop.
        against: whether the two run against each other.
    """

    panels: tuple[int, int]
    sides: tuple[int, int]
    against: bool

    def other(self, panel: int) -> int:
        """The panel on the other side."""
        return self.panels[1] if panel == self.panels[0] else self.panels[0]


def after_flipping(
    contacts: Sequence[SideContact], sheets: Sequence[Sheet], flipped: Sequence[bool]
) -> tuple[SideContact, ...]:
    """The same contacts once some panels show their other face, which runs through their sides the other way."""

    def side(panel: int, place: int) -> int:
        return len(sheets[panel].sides) - 1 - place if flipped[panel] else place

    return tuple(
        SideContact(
            contact.panels,
            (side(contact.panels[0], contact.sides[0]), side(contact.panels[1], contact.sides[1])),
            contact.against != (flipped[contact.panels[0]] != flipped[contact.panels[1]]),
        )
        for contact in contacts
    )


def refuse_duplicates(sheets: Sequence[Sheet], source: str, tolerance: float) -> None:
    """Refuse two panels whose outlines lie on each other all the way round.

    Raises:
        PanelError: naming both.
    """
    if len(sheets) < 2:
        return
    middles = np.array([np.mean([side.points[0] for side in sheet.sides], axis=0) for sheet in sheets])
    tree = cKDTree(middles)
    _, neighbours = tree.query(middles, k=min(NEIGHBOURS, len(sheets)), distance_upper_bound=tolerance)
    for first, row in enumerate(np.sort(neighbours, axis=1).tolist()):
        for second in row:
            if first < second < len(sheets) and _same_outline(sheets[first], sheets[second], tolerance):
                raise PanelError(
                    sheets[second].name,
                    f"in '{source}', it lies on panel '{sheets[first].name}' to within {tolerance:g} mm: "
                    "delete one of the two.",
                )


def find_contacts(sheets: Sequence[Sheet], source: str, tolerance: float) -> tuple[SideContact, ...]:
    """Return the pairs of sides that coincide, sorted, in time that grows with N log N.

    Args:
        sheets: N panels, in any order.
        source: the file's name, for messages.
        tolerance: how far two sides that meet may lie apart anywhere, mm.

    Raises:
        PanelError: more than two panels meet in one side.
    """
    if len(sheets) < 2:
        return ()
    lines, owners = curves(sheets)
    pairs, against = _touching(lines, owners, tolerance)
    _refuse_branches(pairs, owners, sheets, source)
    return tuple(
        SideContact(
            (int(owners[one, 0]), int(owners[other, 0])), (int(owners[one, 1]), int(owners[other, 1])), bool(opposed)
        )
        for (one, other), opposed in zip(pairs.tolist(), against.tolist(), strict=True)
    )


def _touching(lines: Array, owners: IntArray, tolerance: float) -> tuple[IntArray, BoolArray]:
    """Find the pairs of sides that coincide.

    Args:
        lines: (s, q, 3) sides.
        owners: (s, 2) panel and side of each.
        tolerance: mm.

    Returns:
        (c, 2) indices into `lines`, rising, and (c,) whether the two run against each other.
    """
    tree = cKDTree(0.5 * (lines[:, 0] + lines[:, -1]))
    _, found = tree.query(tree.data, k=min(NEIGHBOURS, len(lines)), distance_upper_bound=tolerance)
    first = np.repeat(np.arange(len(lines)), found.shape[1])
    second = found.ravel()
    # Pairs appear from both sides; one that the limit on neighbours hides from one of them is still seen by the other.
    valid = second < len(lines)
    valid[valid] = owners[first[valid], 0] != owners[second[valid], 0]
    pairs = np.unique(np.sort(np.column_stack([first, second])[valid], axis=1), axis=0)
    one, other = lines[pairs[:, 0]], lines[pairs[:, 1]]
    direct = _near(one[:, 0], other[:, 0], tolerance) & _near(one[:, -1], other[:, -1], tolerance)
    against = _near(one[:, 0], other[:, -1], tolerance) & _near(one[:, -1], other[:, 0], tolerance) & ~direct
    keep = direct | against
    pairs, against = pairs[keep], against[keep]
    coincide = _coincide(lines, pairs, against, tolerance)
    return pairs[coincide], against[coincide]


def _near(first: Array, second: Array, tolerance: float) -> BoolArray:
    """Tell for each pair of (m, 3) points whether they lie within the tolerance: (m,)."""
    near: BoolArray = norm(first - second) <= tolerance
    return near


def _coincide(lines: Array, pairs: IntArray, against: BoolArray, tolerance: float) -> BoolArray:
    """Tell for each of the (c, 2) pairs whether the two curves coincide over their whole length: (c,)."""
    first, second = lines[pairs[:, 0]], lines[pairs[:, 1]]
    opposite = np.where(against[:, None, None], second[:, ::-1], second)
    coincide = np.asarray((norm(first - opposite) <= tolerance).all(axis=1))
    # Points of equal rank may lie apart on curves that coincide; so those that fail are measured properly.
    doubtful = np.flatnonzero(~coincide)
    for start in range(0, len(doubtful), CHUNK):
        chunk = doubtful[start : start + CHUNK]
        there = distances_to_curves(first[chunk], second[chunk]).max(axis=1)
        back = distances_to_curves(second[chunk], first[chunk]).max(axis=1)
        coincide[chunk] = np.maximum(there, back) <= tolerance
    return coincide


def _refuse_branches(pairs: IntArray, owners: IntArray, sheets: Sequence[Sheet], source: str) -> None:
    """Refuse a side that coincides with more than one other."""
    sides, counts = np.unique(pairs, return_counts=True)
    if not (counts > 1).any():
        return
    side = int(sides[counts > 1][0])
    panel = int(owners[side, 0])
    others = sorted({int(owners[index, 0]) for index in pairs[(pairs == side).any(axis=1)].ravel()} - {panel})
    names = " and ".join(f"'{sheets[index].name}'" for index in others)
    raise PanelError(
        sheets[panel].name,
        f"in '{source}', it meets panels {names} along one and the same edge: a seam joins two, delete one of them.",
    )


def _same_outline(first: Sheet, second: Sheet, tolerance: float) -> bool:
    """Tell whether the outlines of two panels coincide, whichever way each is turned."""
    lines = [np.array([side.points for side in sheet.sides]) for sheet in (first, second)]
    for points, others in ((lines[0], lines[1]), (lines[1], lines[0])):
        flat = points.reshape(1, -1, 3)
        distances = np.array([distances_to_curves(flat, line[None])[0] for line in others]).min(axis=0)
        if distances.max() > tolerance:
            return False
    return True
