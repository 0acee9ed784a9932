"""Strips that are no chains of planes and cones, cut along the drawn edges, and their measures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import dot, norm, unit
from cadpanel.reference.model import PanelReference, Reference, Seam
from cadpanel.studies.baselines.baseline import Outcome


class Strip(Protocol):
    """A surface in the place of a panel."""

    @property
    def warp(self) -> float:
        """The largest angle between the tangent planes at both ends of a ruling, radians."""
        ...

    def feet(self, points: Array) -> Array:
        """(m, 3) the points of it nearest to points (m, 3), mm."""
        ...


@dataclass(frozen=True, slots=True)
class _Feet:
    """Of one panel the distances of its samples, and what lies under its drawn edges."""

    square: float
    area: float
    largest: float
    edges: tuple[Array, ...]

    @classmethod
    def of(cls, strip: Strip, panel: PanelReference) -> _Feet:
        off = norm(strip.feet(panel.points) - panel.points)
        edges = tuple(strip.feet(edge) for edge in panel.edges)
        beside = max(float(norm(foot - edge).max()) for foot, edge in zip(edges, panel.edges, strict=True))
        return cls(float(panel.weights @ off**2), float(panel.weights.sum()), max(float(off.max()), beside), edges)


def outcome_of(strips: Sequence[Strip], reference: Reference) -> Outcome:
    """Measure strips that are cut along the drawn edges, one a panel.

    The gap at a place of a seam is between what lies under the drawn edge on both sides; a corner's drift is to what
    lies under the drawn one; an end's turn is that of its chord.
    """
    found = [_Feet.of(*pair) for pair in zip(strips, reference.panels, strict=True)]
    corners = [
        norm(foot[[0, -1]] - edge[[0, -1]]).max()
        for one, panel in zip(found, reference.panels, strict=True)
        for foot, edge in zip(one.edges, panel.edges, strict=True)
    ]
    turns = [
        _turn(foot, edge)
        for one, panel in zip(found, reference.panels, strict=True)
        for foot, edge in zip(one.edges[:2], panel.edges[:2], strict=True)
    ]
    gaps = [_gaps(found, seam) for seam in reference.seams]
    return Outcome(
        panels=len(found),
        rms=float(np.sqrt(sum(one.square for one in found) / sum(one.area for one in found))),
        largest=max(one.largest for one in found),
        corner_gap=max((float(gap[[0, -1]].max()) for gap in gaps), default=0.0),
        seam_gap=max((float(gap.max()) for gap in gaps), default=0.0),
        drift=float(max(corners)),
        turn=float(np.degrees(max(turns))),
        warp=float(np.degrees(max(strip.warp for strip in strips))),
    )


def _gaps(found: Sequence[_Feet], seam: Seam) -> Array:
    """(q,) at the places of the first panel's edge; the other's is drawn within the seam's tolerance of it."""
    one, other = (found[panel].edges[edge] for panel, edge in zip(seam.panels, seam.edges, strict=True))
    if seam.reversed:
        other = other[::-1]
    if len(one) != len(other):
        shares = np.linspace(0.0, 1.0, len(one)), np.linspace(0.0, 1.0, len(other))
        other = np.stack([np.interp(*shares, axis) for axis in other.T], axis=-1)
    return norm(one - other)


def _turn(one: Array, other: Array) -> float:
    chords = [unit(edge[-1] - edge[0]) for edge in (one, other)]
    return float(np.arccos(np.clip(dot(*chords), -1.0, 1.0)))
