"""Panels that lie along each other without a seam: told in a note."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.polyline import distances_to_curves
from cadpanel.geometry.vectors import norm
from cadpanel.reference.oriented_panel import Sheet, curves
from cadpanel.reference.seam_finding import CHUNK, SideContact

# Sides are along each other up to this many tolerances from one another, or this part of the longer one's length where
# that is no more than this share of the shorter one's.
FAR_TOLERANCES = 5.0
FAR_PART = 0.03
FAR_SHARE = 0.5
# They touch where this many of the shorter one's 65 points do, and run along each other where this many are near. Every
# so many are looked at first.
TOUCHING = 5
ALONG = 33
# A longer side has others along all of it where that many of its points touch them.
ALL_ALONG = 60
# A side that comes nearer to the other by more than this part of its own length does not run along it.
SLANT = 0.5
EVERY = 4


def unmet_notes(
    sheets: Sequence[Sheet], contacts: Sequence[SideContact], source: str, tolerance: float, junctions: bool = False
) -> tuple[str, ...]:
    """What to say of sides that touch others along a part only, or run along others farther away than the tolerance.

    Args:
        sheets: the panels.
        contacts: the seams between them.
        source: the file's name.
        tolerance: how far sides that meet may lie apart, mm.
        junctions: whether sides were parted at the corners of others already.
    """
    if len(sheets) < 2:
        return ()
    lines, owners = curves(sheets)
    taken = {(panel, side) for one in contacts for panel, side in zip(one.panels, one.sides, strict=True)}
    free = np.array([tuple(owner) not in taken for owner in owners.tolist()])
    if not free.any():  # a closed body of panels
        return ()
    lines, owners = lines[free], owners[free]
    met = {contact.panels for contact in contacts}
    neighbours, reaches = _neighbours(lines, owners, tolerance)
    unmet = np.array(
        [pair not in met for pair in map(tuple, np.sort(owners[neighbours, 0], axis=1).tolist())], np.bool_
    )
    pairs, far = neighbours[unmet], reaches[unmet]
    touching: list[tuple[str, str]] = []
    apart: list[tuple[float, int, int]] = []
    for start in range(0, len(pairs), CHUNK):
        chunk = pairs[start : start + CHUNK]
        distances = distances_to_curves(lines[chunk[:, 0]], lines[chunk[:, 1]])
        for (one, other), own, reach in zip(chunk.tolist(), distances, far[start:], strict=False):
            if np.count_nonzero(own <= tolerance) >= TOUCHING:
                touching.append(_named(sheets, *owners[[one, other], 0].tolist()))
            elif np.count_nonzero(own <= reach) >= ALONG and _is_level(own[own <= reach], lines[one]):
                apart.append((float(np.median(own)), one, other))
    sides = np.array([pair for _, *pair in apart], dtype=np.intp)
    shares = _shares(lines, neighbours[np.isin(neighbours, sides).any(axis=1)], tolerance)
    # Where a panel lies along a side, what is farther away lies behind that panel.
    lonely = sorted(
        (distance, *_named(sheets, *owners[[one, other], 0].tolist()))
        for distance, one, other in apart
        if shares[one] < ALONG and shares[other] < ALL_ALONG
    )
    return (*_touching_note(sorted(set(touching)), source, junctions), *_apart_note(lonely, source, tolerance))


def _shares(lines: Array, pairs: IntArray, tolerance: float) -> IntArray:
    """(s,) how many points of each side touch any of the sides with which it is one of (c, 2) pairs."""
    low, high = lines.min(axis=1) - tolerance, lines.max(axis=1)
    one, other = pairs.T
    pairs = pairs[((low[one] <= high[other]) & (low[other] <= high[one])).all(axis=1)]
    touched = np.zeros(lines.shape[:2], dtype=np.bool_)
    for one, other in (pairs.T, pairs.T[::-1]):
        for start in range(0, len(pairs), CHUNK):
            chunk = slice(start, start + CHUNK)
            near = distances_to_curves(lines[one[chunk]], lines[other[chunk]]) <= tolerance
            np.logical_or.at(touched, one[chunk], near)
    return np.asarray(touched.sum(axis=1), dtype=np.intp)


def _named(sheets: Sequence[Sheet], one: int, other: int) -> tuple[str, str]:
    first, second = sorted((sheets[one].name, sheets[other].name))
    return first, second


def _touching_note(pairs: Sequence[tuple[str, str]], source: str, junctions: bool) -> tuple[str, ...]:
    if not pairs:
        return ()
    first, second = pairs[0]
    many = f"{len(pairs)} pairs of panels" if len(pairs) > 1 else "Two panels"
    # See `part_sides`.
    remedy = (
        "a triangle with a single corner of others on its sides stays whole, so cut it in two there"
        if junctions
        else "or give --junctions and --feature planar-polygon"
    )
    return (
        f"{many} of '{source}' touch along a part of an edge only, like '{first}' and '{second}': no seam is held "
        f"there; cut both sides at the same places{';' if junctions else ','} {remedy}.",
    )


def _apart_note(found: Sequence[tuple[float, str, str]], source: str, tolerance: float) -> tuple[str, ...]:
    if not found:
        return ()
    distance, first, second = found[0]
    count = len({(one, other) for _, one, other in found})
    many = f"{count} pairs of panels" if count > 1 else "Two panels"
    return (
        f"{many} of '{source}' run along each other farther apart than the seam tolerance of {tolerance:g} mm, the "
        f"nearest, '{first}' and '{second}', by {distance:.3g} mm: no seam is held there.",
    )


def _is_level(distances: Array, line: Array) -> bool:
    """Whether a side keeps away from another one rather than points at it, by (k,) distances of points along it."""
    length = float(norm(np.diff(line, axis=0)).sum()) * len(distances) / len(line)
    return float(np.ptp(distances)) <= SLANT * length


def _far(lengths: Array, others: Array, tolerance: float) -> Array:
    """How far (c,) sides may lie from longer ones, of these lengths, and still run along them, mm."""
    return np.maximum(FAR_TOLERANCES * tolerance, np.minimum(FAR_PART * others, FAR_SHARE * lengths))


def _neighbours(lines: Array, owners: IntArray, tolerance: float) -> tuple[IntArray, Array]:
    """Pairs of sides of different panels that may touch or run along each other.

    Returns:
        (c, 2) indices into `lines`, the shorter one first, and (c,) how far from the other one it may run along it, mm.
    """
    lengths = norm(np.diff(lines, axis=1)).sum(axis=1)
    grown = np.maximum(FAR_TOLERANCES * tolerance, FAR_PART * lengths)[:, None]
    low, high = lines.min(axis=1), lines.max(axis=1)
    pairs = _boxes_that_meet(low - grown, high + grown)
    pairs = pairs[owners[pairs[:, 0], 0] != owners[pairs[:, 1], 0]]
    pairs = np.where((lengths[pairs[:, 0]] > lengths[pairs[:, 1]])[:, None], pairs[:, ::-1], pairs)
    far = _far(lengths[pairs[:, 0]], lengths[pairs[:, 1]], tolerance)
    # Most of these only have a corner in common: some of their points tell, by the box about the other side.
    probes = lines[pairs[:, 0], EVERY // 2 :: EVERY]
    beyond = np.maximum(low[pairs[:, 1], None] - probes, probes - high[pairs[:, 1], None]).max(axis=-1)
    alongside = (beyond <= far[:, None]).sum(axis=1) >= ALONG // EVERY - 1
    keep = alongside | (beyond <= tolerance).any(axis=1)
    return pairs[keep], far[keep]


def _boxes_that_meet(low: Array, high: Array) -> IntArray:
    """(c, 2) pairs of the (s, 3) boxes that overlap, in time that grows with how many do along the longest axis."""
    axis = int(np.ptp(low, axis=0).argmax())
    order = np.argsort(low[:, axis], kind="stable")
    low, high = low[order], high[order]
    stops = np.searchsorted(low[:, axis], high[:, axis], side="right")
    found = [np.zeros((0, 2), dtype=np.intp)]
    for start in range(0, len(low), CHUNK):
        rows = np.arange(start, min(start + CHUNK, len(low)))
        counts = stops[rows] - rows - 1
        one = np.repeat(rows, counts)
        other = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(counts) - counts, counts)
        meet = ((low[one] <= high[other]) & (low[other] <= high[one])).all(axis=1)
        found.append(order[np.column_stack([one[meet], other[meet]])])
    return np.concatenate(found)
