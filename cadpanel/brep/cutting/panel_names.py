"""Names that say where a panel sits, found from which panels meet: along a strip, or by row and column."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.cutting.cut_panel import along_name, grid_name
from cadpanel.geometry.order import first_way, goes_backwards, order_in_space, principal_axes
from cadpanel.geometry.vectors import unit

# Neighbours whose directions differ by less than about 45 degrees from a way along the grid lie on that way.
ALONG = 0.7
# Middles of panels nearer to each other than this along an axis lie at the same place on it, mm.
LEVEL = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """An edge between two panels: which, (3,) its middle, and its length, mm."""

    panels: tuple[int, int]
    middle: Array
    length: float


def place_names(surface: str, middles: Array, links: Sequence[Link]) -> list[str]:
    """Name panels by their place.

    Panels in a row are numbered along it. Panels in rows and columns, in which every step to a neighbour goes one place
    on, are named by them. All others are numbered by the place of their middles: along the longest extent, then across.

    Args:
        surface: name of the surface, with which all names begin.
        middles: (n, 3) middles of the panels, mm.
        links: the edges between them.
    """
    count = len(middles)
    joined = _joined(links)
    axes = principal_axes(middles)
    order = order_in_space(middles @ axes.T, LEVEL).tolist()
    chain = _chain(order, joined)
    if chain is not None:
        names = [""] * count
        for place, panel in enumerate(chain):
            names[panel] = along_name(surface, place, count)
        return names
    places = _lattice(middles, joined, order, axes)
    if places is not None:
        rows, columns = (np.ptp(places, axis=0) + 1).tolist()
        return [grid_name(surface, row, column, (rows, columns)) for row, column in places.tolist()]
    names = [""] * count
    for place, panel in enumerate(order):
        names[panel] = along_name(surface, place, count)
    return names


def _joined(links: Sequence[Link]) -> dict[int, dict[int, Array]]:
    """For each panel its neighbours, each with the middle of all that they share."""
    shared: dict[tuple[int, int], list[Link]] = defaultdict(list)
    for link in links:
        first, second = sorted(link.panels)
        shared[first, second].append(link)
    joined: dict[int, dict[int, Array]] = defaultdict(dict)
    for (first, second), parts in sorted(shared.items()):
        weights = np.array([part.length for part in parts])
        middle = weights @ np.array([part.middle for part in parts]) / weights.sum()
        joined[first][second] = joined[second][first] = middle
    return joined


def _chain(order: Sequence[int], joined: dict[int, dict[int, Array]]) -> list[int] | None:
    """The panels in a row where they follow each other, begun with the first in order that has one neighbour; or None.

    A ring is begun with the first one, and goes on to that of its neighbours which comes last.
    """
    count = len(order)
    if count == 1:
        return [0]
    if any(len(joined[panel]) not in (1, 2) for panel in range(count)):
        return None
    start = next((panel for panel in order if len(joined[panel]) == 1), order[0])
    place = {panel: number for number, panel in enumerate(order)}
    chain, seen = [start], {start}
    while True:
        onward = [panel for panel in joined[chain[-1]] if panel not in seen]
        if not onward:
            return chain if len(chain) == count else None
        chain.append(max(onward, key=place.__getitem__))
        seen.add(chain[-1])


def _lattice(middles: Array, joined: dict[int, dict[int, Array]], order: Sequence[int], axes: Array) -> IntArray | None:
    """(n, 2) row and column of each panel, from 0, or None where stepping from one to the next contradicts itself."""
    found = _first(middles, joined, order, axes)
    if found is None:
        return None
    start, start_ways = found
    places: dict[int, tuple[int, int]] = {start: (0, 0)}
    ways: dict[int, Array] = {start: start_ways}
    front = deque([start])
    while front:
        panel = front.popleft()
        for other, border in joined[panel].items():
            step = _step(unit(border - middles[panel]), ways[panel])
            if step is None:
                return None
            row, column = places[panel]
            place = (row + step[1], column + step[0])
            if other in places:
                if places[other] != place:
                    return None
                continue
            places[other] = place
            ways[other] = _carried(ways[panel], step, unit(middles[other] - border))
            front.append(other)
    if len(places) < len(middles) or len(set(places.values())) < len(middles):
        return None
    return _ordered(np.array([places[panel] for panel in range(len(middles))]), middles)


def _first(
    middles: Array, joined: dict[int, dict[int, Array]], order: Sequence[int], axes: Array
) -> tuple[int, Array] | None:
    """A panel in a corner, and (2, 3) the ways from it along the columns and the rows; None where there is none."""
    corners = [panel for panel in order if len(joined[panel]) == 2]
    for panel in corners:
        ways = np.array([unit(border - middles[panel]) for border in joined[panel].values()])
        if abs(ways[0] @ ways[1]) < ALONG:
            return panel, ways if first_way(ways @ axes.T) == 0 else ways[::-1]
    return None


def _ordered(places: IntArray, middles: Array) -> IntArray:
    """Rows and columns from 0, growing along the axis of space that each follows most."""
    offsets = middles - middles.mean(axis=0)
    ordered = places - places.min(axis=0)
    for axis in (0, 1):
        # How the panels' middles move from one row (or column) to the next, in the mean.
        trend = (ordered[:, axis] - ordered[:, axis].mean()) @ offsets
        if goes_backwards(trend):
            ordered[:, axis] = ordered[:, axis].max() - ordered[:, axis]
    return np.asarray(ordered, dtype=np.intp)


def _step(direction: Array, ways: Array) -> tuple[int, int] | None:
    """One place along the columns or the rows, whichever way the direction goes."""
    cosines = ways @ direction
    axis = int(np.abs(cosines).argmax())
    if abs(cosines[axis]) < ALONG:
        return None
    sign = 1 if cosines[axis] > 0.0 else -1
    return (sign, 0) if axis == 0 else (0, sign)


def _carried(ways: Array, step: tuple[int, int], onward: Array) -> Array:
    """The ways along columns and rows at the next panel: the one that was taken goes on as the surface does."""
    axis = 0 if step[0] else 1
    sign = step[axis]
    carried = ways.copy()
    carried[axis] = sign * onward
    other = carried[1 - axis] - (carried[1 - axis] @ carried[axis]) * carried[axis]
    carried[1 - axis] = unit(other)
    return carried
