"""Which edges of a panel are its ends, and which of its faces is the outer one: asked of the panel and its neighbours.

A panel that is clearly folded says so itself. One that is all but flat, or bent both ways alike, follows its
neighbours: opposite edges of four-sided panels line up in rows and columns, and a row that is folded along its length
stays so from panel to panel.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import unit
from cadpanel.reference.oriented_panel import Sheet
from cadpanel.reference.seam_finding import SideContact

# A panel that turns by this much more one way than the other knows its ends, radians.
CLEARLY_FOLDED = np.radians(3.0)
# Below this a panel does not lean to either pair of sides as ends: by its bends (radians), by the lengths of its sides
# and by the axes of space (relative).
_INDIFFERENT = (1e-4, 1e-3, 1e-3, 1e-3, 1e-3)
# Two bends, or two components of a normal, that differ by less than this part are alike.
_ALIKE = 1e-4


def outer_faces(sheets: Sequence[Sheet], contacts: Sequence[SideContact]) -> list[bool]:
    """For each panel whether its other face is the outer one.

    Panels that meet have their outer faces on one side. Of the two sides the outer one is that to which their folds are
    convex, all together; where they are flat, that towards which the largest component of their mean normal points up;
    where that is none either, the one away from their middle.
    """
    neighbours = _neighbours(len(sheets), contacts)
    flipped: dict[int, bool] = {}
    for start in range(len(sheets)):
        if start in flipped:
            continue
        flipped[start] = False
        members, front = [start], deque([start])
        while front:
            panel = front.popleft()
            for contact in neighbours[panel]:
                other = contact.other(panel)
                if other not in flipped:
                    # Loops that go round their panels the same way run against each other where these meet.
                    flipped[other] = flipped[panel] != (not contact.against)
                    members.append(other)
                    front.append(other)
        if _points_inwards(sheets, members, flipped):
            for panel in members:
                flipped[panel] = not flipped[panel]
    return [flipped[panel] for panel in range(len(sheets))]


def _points_inwards(sheets: Sequence[Sheet], members: Sequence[int], flipped: dict[int, bool]) -> bool:
    signs = {panel: -1.0 if flipped[panel] else 1.0 for panel in members}
    bend = sum(signs[panel] * _strongest_bend(sheets[panel]) for panel in members)
    most = sum(abs(_strongest_bend(sheets[panel])) for panel in members)
    if abs(bend) > 1e-3 * max(most, 1e-6):
        return bend < 0.0
    normals = {panel: signs[panel] * (sheets[panel].weights @ sheets[panel].normals) for panel in members}
    normal = sum(normals.values(), np.zeros(3))
    size = np.abs(normal)
    if size.max() <= _ALIKE * sum(float(np.linalg.norm(own)) for own in normals.values()):
        return _enclosed(sheets, signs) < 0.0
    # Of components that are alike the last one counts: a roof of 45 degrees has its outer face above.
    leading = np.flatnonzero(size >= (1.0 - _ALIKE) * size.max())[-1]
    return bool(normal[leading] < 0.0)


def _enclosed(sheets: Sequence[Sheet], signs: dict[int, float]) -> float:
    """Three times the volume that panels enclose on the side away from their normals, counted by these signs, mm^3."""
    members = [sheets[panel] for panel in signs]
    middle = np.sum([one.weights @ one.points for one in members], axis=0) / sum(one.weights.sum() for one in members)
    fluxes = [np.einsum("m,md,md->", one.weights, one.points - middle, one.normals) for one in members]
    return float(np.dot(fluxes, list(signs.values())))


def _strongest_bend(sheet: Sheet) -> float:
    bends = sheet.bends
    if len(bends) != 4:
        return float(bends.sum())
    pairs = bends[:2] + bends[2:]
    size = np.abs(pairs)
    if size.max() - size.min() <= _ALIKE * size.max():
        return float(pairs.sum())
    return float(pairs[size.argmax()])


def first_ends(sheets: Sequence[Sheet], contacts: Sequence[SideContact]) -> list[int]:
    """For each four-sided panel which of its sides is an end, 0 (and 2) or 1 (and 3); 0 for the rest."""
    leanings = [_leaning(sheet) for sheet in sheets]
    neighbours = _neighbours(len(sheets), contacts)
    first = {
        panel: _chosen(leaning, 1)
        for panel, leaning in enumerate(leanings)
        if abs(leaning[0]) > CLEARLY_FOLDED or len(sheets[panel].sides) != 4
    }
    _spread(first, leanings, neighbours, sheets)
    for start in range(len(sheets)):
        if start not in first:
            # Nobody near knows: they line up first, and then choose together.
            members = {start: 0}
            _spread(members, leanings, neighbours, sheets)
            together = sum(
                (_signed(leanings[panel], way) for panel, way in members.items()), np.zeros(len(_INDIFFERENT))
            )
            other = _chosen(together, len(members))
            first |= {panel: (way + other) % 2 for panel, way in members.items()}
    return [first[panel] for panel in range(len(sheets))]


def _leaning(sheet: Sheet) -> Array:
    """How much speaks for the sides 0 and 2 as ends rather than 1 and 3, in the order in which it counts.

    Ends bend and sides do not (radians); ends are shorter; the way from end to end follows the x axis, y axis, z axis
    rather than the way across (relative).
    """
    if len(sheet.sides) != 4:
        return np.zeros(len(_INDIFFERENT))
    lengths = np.array([side.length for side in sheet.sides])
    chords = np.array([side.points[-1] - side.points[0] for side in sheet.sides])
    ways = chords[:2] - chords[2:]
    # Both ends of half a ring point the same way, and one way has no direction.
    ways = np.abs(unit(ways))
    bend = sheet.bend_of_pair(0) - sheet.bend_of_pair(1)
    return np.array([bend, (lengths[1::2].sum() - lengths[::2].sum()) / lengths.sum(), *(ways[1] - ways[0])])


def _signed(leaning: Array, way: int) -> Array:
    return leaning if way == 0 else -leaning


def _chosen(leaning: Array, panels: int) -> int:
    """Which sides are ends: what counts first decides, unless it is indifferent."""
    decided = np.abs(leaning) > panels * np.array(_INDIFFERENT)
    return int(leaning[decided.argmax()] < 0.0) if decided.any() else 0


def _spread(
    first: dict[int, int], leanings: Sequence[Array], neighbours: list[list[SideContact]], sheets: Sequence[Sheet]
) -> None:
    """Give panels that do not know their ends those that line up with their neighbours', round by round.

    In every round all that meet a panel that knows are asked, so that the order of the file does not matter; where as
    many neighbours wish the one as the other, a panel follows what leaning it has.
    """
    front = list(first)
    while front:
        asked = {
            contact.other(panel)
            for panel in front
            for contact in neighbours[panel]
            if len(sheets[panel].sides) == 4 == len(sheets[contact.other(panel)].sides)
        }
        told: dict[int, int] = {}
        for panel in asked - first.keys():
            wishes = [
                1 - 2 * ((first[contact.other(panel)] + sum(contact.sides)) % 2)
                for contact in neighbours[panel]
                if contact.other(panel) in first and len(sheets[contact.other(panel)].sides) == 4
            ]
            told[panel] = int(sum(wishes) < 0) if sum(wishes) else _chosen(leanings[panel], 1)
        first |= told
        front = list(told)


def _neighbours(count: int, contacts: Sequence[SideContact]) -> list[list[SideContact]]:
    lists: list[list[SideContact]] = [[] for _ in range(count)]
    for contact in contacts:
        for panel in contact.panels:
            lists[panel].append(contact)
    return lists
