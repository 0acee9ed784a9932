"""How far apart and at which angle fitted panels meet; millimetres and radians."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.panel_edges import Edge
from cadpanel.fitting.measures.edges import corners_along, edge_curves, edges_of
from cadpanel.geometry.end_curves import EndCurves, seam_gap
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.vectors import norm
from cadpanel.reference.model import Seam

_Pieces = tuple[bool, ...]


def along_seams(shapes: Sequence[Panel], seams: Sequence[Seam]) -> tuple[Array, Array]:
    """(seams,) gaps along whole seams in mm, and kinks in radians."""
    gaps, kinks = np.zeros(len(seams)), np.zeros(len(seams))
    met = [_Met.of(shapes, seam) for seam in seams]
    kinds: dict[tuple[_Pieces, _Pieces], list[int]] = {}
    for i, one in enumerate(met):
        kinds.setdefault((one.first.curved, one.second.curved), []).append(i)
    centre = np.mean([shape.corners().mean(axis=(0, 1)) for shape in shapes], axis=0)
    for members in kinds.values():
        first, second = (_edges(shapes, [met[i] for i in members], side, centre) for side in (0, 1))
        gaps[members], kinks[members] = seam_gap(first, second)
    return gaps, kinks


def corner_gaps(shapes: Sequence[Panel], seams: Sequence[Seam]) -> tuple[Array, ...]:
    """For each seam the gaps (corners,) at the corners that meet, in the order of its first panel, mm.

    All corners meet where both edges have the same pieces, else only the two outermost.
    """
    return tuple(_Met.of(shapes, seam).corner_gaps(shapes) for seam in seams)


@dataclass(frozen=True, slots=True)
class _Met:
    """Two edges that meet, the one of the lower panel first."""

    panels: tuple[int, int]
    edges: tuple[int, int]
    first: Edge
    second: Edge
    reversed: bool

    @staticmethod
    def of(shapes: Sequence[Panel], seam: Seam) -> _Met:
        """The edges of a seam as the panels have them."""
        order = (0, 1) if seam.panels[0] < seam.panels[1] else (1, 0)
        panels, edges = ((which[order[0]], which[order[1]]) for which in (seam.panels, seam.edges))
        first, second = (edges_of(shapes[panel])[edge] for panel, edge in zip(panels, edges, strict=True))
        return _Met(panels, edges, first, second, seam.reversed)

    def corner_gaps(self, shapes: Sequence[Panel]) -> Array:
        """(corners,) mm."""
        one, other = (corners_along(shapes[p], e) for p, e in zip(self.panels, (self.first, self.second), strict=True))
        pieces = self.second.curved
        if self.reversed:
            other, pieces = other[::-1], pieces[::-1]
        if pieces != self.first.curved:
            one, other = one[[0, -1]], other[[0, -1]]
        return norm(one - other)


def _edges(shapes: Sequence[Panel], met: Sequence[_Met], side: int, centre: Array) -> EndCurves:
    return edge_curves([shapes[one.panels[side]] for one in met], [one.edges[side] for one in met], centre)
