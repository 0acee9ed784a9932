"""Lips: where a strip's normals turn fast on the way across it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.brep.lanes import Lane, Lanes
from cadpanel.brep.patch import patch_of, rectangle
from cadpanel.reference.polyline import norm

Array = NDArray[np.float64]

# Places along the strip at which it is looked at across, and points across each lane.
SECTIONS = (0.1, 0.3, 0.5, 0.7, 0.9)
POINTS = 257
# A lip turns faster than the whole section does in the mean by this factor, and by so much in all, degrees.
FAST = 2.0
LEAST_TURN = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A strip across, in the mean of several sections.

    Attributes:
        lane: (n,) which lane each point lies on, lanes following each other across the strip.
        across: (n,) where on that lane, as a part of its range.
        length: (n,) length from the first long edge, mm.
        turn: (n,) by how much the normals have turned up to there, radians.
    """

    lane: NDArray[np.intp]
    across: Array
    length: Array
    turn: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Lip:
    """One lip.

    Attributes:
        turn: by how much the normals turn over it, degrees.
        width: along the surface, mm.
        middle: length from the strip's first long edge to where half of the turn is done, mm.
    """

    turn: float
    width: float
    middle: float

    @property
    def radius(self) -> float:
        """Mean radius, mm."""
        return self.width / float(np.radians(self.turn))


def section_of(lanes: Lanes) -> Section | None:
    """A strip of lanes across, or None where its lanes are no chain from one long edge to the other."""
    order = _across(lanes)
    if order is None:
        return None
    numbers, acrosses, lengths, turns = [], [], [], []
    length, turn = 0.0, 0.0
    last: Array | None = None
    for index, forward in order:
        across = np.linspace(0.0, 1.0, POINTS) if forward else np.linspace(1.0, 0.0, POINTS)
        lane = lanes.lanes[index]
        parameters = lane.patch.at(lane.axis, lane.own(np.array(SECTIONS))[:, None], across[None, :])
        points, normals = lane.patch.points(parameters), lane.patch.normals(parameters)
        step = norm(np.diff(points, axis=1)).mean(axis=0)
        angle = (2.0 * np.arcsin(np.clip(0.5 * norm(np.diff(normals, axis=1)), 0.0, 1.0))).mean(axis=0)
        if last is not None:
            # Neighbours may have their normals on different sides.
            cosines = np.abs(np.sum(last * normals[:, 0], axis=-1))
            turn += float(np.arccos(np.clip(cosines, -1.0, 1.0)).mean())
        lengths.append(length + np.concatenate([[0.0], np.cumsum(step)]))
        turns.append(turn + np.concatenate([[0.0], np.cumsum(angle)]))
        length, turn, last = float(lengths[-1][-1]), float(turns[-1][-1]), normals[:, -1]
        numbers.append(np.full(POINTS, index))
        acrosses.append(across)
    return Section(
        lane=np.concatenate(numbers),
        across=np.concatenate(acrosses),
        length=np.concatenate(lengths),
        turn=np.concatenate(turns),
    )


def lips_of(length: Array, turn: Array) -> tuple[Lip, ...]:
    """The lips of a section: stretches that turn fast.

    Args:
        length: (n,) lengths across the strip, not falling, mm.
        turn: (n,) by how much the normals have turned up to there, radians.
    """
    whole = float(turn[-1] - turn[0])
    if np.degrees(whole) < LEAST_TURN or length[-1] <= length[0]:
        return ()
    mean = whole / float(length[-1] - length[0])
    fast = np.diff(turn) > FAST * mean * np.diff(length)
    borders = np.flatnonzero(np.diff(np.concatenate([[False], fast, [False]]).astype(np.int8)))
    lips = []
    for start, stop in borders.reshape(-1, 2).tolist():
        turned = float(turn[stop] - turn[start])
        if np.degrees(turned) >= LEAST_TURN:
            half = float(np.interp(turn[start] + 0.5 * turned, turn[start : stop + 1], length[start : stop + 1]))
            lips.append(Lip(turn=float(np.degrees(turned)), width=float(length[stop] - length[start]), middle=half))
    return tuple(lips)


def band(lanes: Lanes, section: Section, low: float, high: float) -> Lanes:
    """The part of a strip between two lengths across it, mm, as lanes again."""
    kept: list[Lane] = []
    outer: list[tuple[int, float]] = []
    order = list(dict.fromkeys(section.lane.tolist()))
    for index in order:
        own = section.lane == index
        length, across = section.length[own], section.across[own]
        if length[-1] <= low or length[0] >= high:
            continue
        ends = np.interp([max(low, length[0]), min(high, length[-1])], length, across)
        lane = lanes.lanes[index]
        first, last = sorted(lane.patch.at(lane.axis, np.zeros(2), ends)[:, 1 - lane.axis].tolist())
        along = tuple(lane.patch.bounds[lane.axis].tolist())
        ranges = (along, (first, last)) if lane.axis == 0 else ((first, last), along)
        rising = across[-1] > across[0]
        # The strip's first long edge lies where its first lane begins, the second one where its last lane ends.
        if not kept:
            outer.append((0, 0.0 if rising else 1.0))
        kept.append(Lane(patch=patch_of(rectangle(lane.patch, *ranges)), axis=lane.axis, forward=lane.forward))
        end = (len(kept) - 1, 1.0 if rising else 0.0)
    outer.append(end)
    return Lanes(lanes=tuple(kept), outer=tuple(outer))


def _across(lanes: Lanes) -> Sequence[tuple[int, bool]] | None:
    """The lanes in their order across the strip, each with whether it is walked along its other parameter."""
    if len(lanes.outer) != 2:
        return None
    joined = {first: second for pair in lanes.joints for first, second in (pair, pair[::-1])}
    order = []
    index, side = lanes.outer[0]
    for _ in lanes.lanes:
        order.append((index, side == 0.0))
        exit_side = (index, 1.0 - side)
        if exit_side not in joined:
            break
        index, side = joined[exit_side]
    return order if len(order) == len(lanes.lanes) and exit_side == lanes.outer[1] else None
