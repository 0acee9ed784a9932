"""Panels that lie along or over each other without a seam: told in a note, or refused where they cover each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cadpanel.errors import PanelError
from cadpanel.reference.contacts import CHUNK, SideContact
from cadpanel.reference.polyline import cross, distances_to_polylines, norm, unit
from cadpanel.reference.sheet import Sheet, curves

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

# Sides are along each other up to this many tolerances, or this part of a side's length, from one another.
FAR_TOLERANCES = 5.0
FAR_PART = 0.03
# Every so many points of a side its neighbours are asked for, and so many of them.
EVERY = 4
ASKED = 16
# They touch where this many of a side's 65 points do, and run along each other apart where this many are near.
TOUCHING = 5
ALONG = 33
# A sample lies on another panel when it is inside its outline and no farther from one of its samples than this part of
# their spacing; a panel covers another one when this part of its samples does. So many samples around are looked at.
ONE_PLACE = 0.75
COVERED = 0.1
NEAREST = 6


def unmet_notes(
    sheets: Sequence[Sheet], contacts: Sequence[SideContact], source: str, tolerance: float
) -> tuple[str, ...]:
    """What to say of sides that touch others along a part only, or run along others farther away than the tolerance.

    Args:
        sheets: the panels.
        contacts: the seams between them.
        source: the file's name.
        tolerance: how far sides that meet may lie apart, mm.
    """
    if len(sheets) < 2:
        return ()
    lines, owners = curves(sheets)
    taken = {(panel, side) for one in contacts for panel, side in zip(one.panels, one.sides, strict=True)}
    free = np.array([tuple(owner) not in taken for owner in owners.tolist()])
    lines, owners = lines[free], owners[free]
    met = {contact.panels for contact in contacts}
    pairs = [
        (one, other)
        for one, other in _neighbours(lines, owners, tolerance)
        if (min(owners[one, 0], owners[other, 0]), max(owners[one, 0], owners[other, 0])) not in met
    ]
    touching: list[tuple[str, str]] = []
    apart: list[tuple[float, str, str]] = []
    for start in range(0, len(pairs), CHUNK):
        chunk = np.array(pairs[start : start + CHUNK])
        distances = distances_to_polylines(lines[chunk[:, 0]], lines[chunk[:, 1]])
        for (one, other), own in zip(chunk.tolist(), distances, strict=True):
            first, second = sorted((sheets[int(owners[one, 0])].name, sheets[int(owners[other, 0])].name))
            if np.count_nonzero(own <= tolerance) >= TOUCHING:
                touching.append((first, second))
            elif np.count_nonzero(own <= _far(lines[one], tolerance)) >= ALONG:
                apart.append((float(np.median(own)), first, second))
    return (*_touching_note(sorted(set(touching)), source), *_apart_note(sorted(apart), source, tolerance))


def _touching_note(pairs: Sequence[tuple[str, str]], source: str) -> tuple[str, ...]:
    if not pairs:
        return ()
    first, second = pairs[0]
    many = f"{len(pairs)} pairs of panels" if len(pairs) > 1 else "Two panels"
    return (
        f"{many} of '{source}' touch along a part of an edge only, like '{first}' and '{second}': no seam is held "
        "there; cut both sides at the same places, or give --junctions and --feature planar-polygon.",
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


def _far(line: Array, tolerance: float) -> float:
    length = float(norm(np.diff(line, axis=0)).sum())
    return max(FAR_TOLERANCES * tolerance, FAR_PART * length)


def _neighbours(lines: Array, owners: IntArray, tolerance: float) -> list[tuple[int, int]]:
    """Pairs of sides of different panels, the second of which is near several points of the first."""
    if not len(lines):
        return []
    count, points = lines.shape[:2]
    tree = cKDTree(lines.reshape(-1, 3))
    asked = lines[:, EVERY // 2 :: EVERY]
    reach = np.repeat([_far(line, tolerance) for line in lines], asked.shape[1])
    distances, found = tree.query(asked.reshape(-1, 3), k=min(ASKED, count * points))
    one = np.repeat(np.arange(count), asked.shape[1])[:, None]
    # Half-way between two points of another side the nearest is half a step away.
    steps = norm(np.diff(lines, axis=1)).max(axis=1)
    other = np.minimum(found // points, count - 1)
    near = (distances <= reach[:, None] + 0.5 * steps[other]) & (owners[one, 0] != owners[other, 0])
    pairs, hits = np.unique(
        np.column_stack([np.broadcast_to(one, near.shape)[near], other[near]]), axis=0, return_counts=True
    )
    return [(int(a), int(b)) for a, b in pairs[hits >= 2].tolist()]


def refuse_overlaps(sheets: Sequence[Sheet], contacts: Sequence[SideContact], source: str, tolerance: float) -> None:
    """Refuse two panels that cover each other over a part of their area, without meeting in a seam as a lens does.

    Raises:
        PanelError: naming both.
    """
    if len(sheets) < 2:
        return
    points = np.concatenate([one.points for one in sheets])
    normals = np.concatenate([one.normals for one in sheets])
    spacing = np.sqrt(np.concatenate([one.weights for one in sheets]))
    owner = np.repeat(np.arange(len(sheets)), [len(one.points) for one in sheets])
    distances, found = (np.asarray(array) for array in cKDTree(points).query(points, k=min(NEAREST, len(points))))
    # The nearest sample of another panel, if one is among those that are nearest.
    foreign = owner[found] != owner[:, None]
    rows, place = np.arange(len(points)), foreign.argmax(axis=1)
    other, distance = found[rows, place], distances[rows, place]
    height = np.abs(np.einsum("md,md->m", points - points[other], normals[other]))
    near = foreign.any(axis=1) & (distance <= ONE_PLACE * spacing[other] + tolerance) & (height <= tolerance)
    sizes = np.bincount(owner)
    pairs, counts = np.unique(np.column_stack([owner, owner[other]])[near], axis=0, return_counts=True)
    met = {contact.panels for contact in contacts}
    for one, two in pairs[counts >= COVERED * sizes[pairs[:, 0]]].tolist():
        if (min(one, two), max(one, two)) in met:
            continue
        mine = near & (owner == one) & (owner[other] == two)
        inside = _inside(points[mine], sheets[two], normals[mine].sum(axis=0))
        if np.count_nonzero(inside) >= COVERED * sizes[one]:
            raise PanelError(
                sheets[one].name,
                f"in '{source}', a part of it covers panel '{sheets[two].name}' to within {tolerance:g} mm: trim or "
                "delete one of the two.",
            )


def _inside(points: Array, sheet: Sheet, normal: Array) -> NDArray[np.bool_]:
    """Whether points (m, 3) lie inside a panel's outline, seen along a normal, (m,): it winds about them."""
    u = unit(cross(normal, np.eye(3)[np.abs(normal).argmin()]))
    plane = np.stack([u, unit(cross(normal, u))], axis=1)
    loop = np.concatenate([side.points[:-1] for side in sheet.sides]) @ plane
    off = loop[None] - (points @ plane)[:, None]
    angle = np.arctan2(off[..., 1], off[..., 0])
    turned = np.diff(np.concatenate([angle, angle[:, :1]], axis=1), axis=1)
    turned -= 2.0 * np.pi * np.round(turned / (2.0 * np.pi))
    return np.asarray(np.abs(turned.sum(axis=1)) > np.pi)
