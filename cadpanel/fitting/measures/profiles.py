"""How fitted panels meet along every seam, place by place; millimetres and radians."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cadpanel.arrays import Array
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.seams import met_seams
from cadpanel.geometry.end_curves import as_chains
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.seam_profiles import profiles
from cadpanel.reference.model import Seam

STEPS = 12
"""In which each piece of an edge is followed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamProfile:
    """One seam, seen from the edge of its first panel, at q places from one end of that edge to the other.

    Attributes:
        points: (q, 3) the places on that edge, mm.
        along: (q,) length of the edge up to there, mm.
        gap: (q,) distance to the other panel's edge, mm.
        width, step: (q,) its parts in the skins and square to the seam, and along the skins' normal, mm.
        kink: (q,) angle between the two skins' normals, radians.
    """

    points: Array
    along: Array
    gap: Array
    width: Array
    step: Array
    kink: Array


def seam_profiles(shapes: Sequence[Panel], seams: Sequence[Seam]) -> tuple[SeamProfile, ...]:
    """How panels meet along each of their seams; the first panel of a seam is the lower one in the reference."""
    edges = PanelEdges.of(shapes)
    found: dict[int, SeamProfile] = {}
    for met in met_seams(edges, seams):
        first, second = met.curves(edges)
        # Seen from a point nearby, as far coordinates would cost digits.
        origin = 0.5 * (first.corners[:, 0] + second.corners[:, 0])
        told = profiles(as_chains(first, origin), as_chains(second, origin), STEPS)
        points = told.points + (origin + edges.centre)[:, None]
        for row, index in enumerate(met.index.tolist()):
            found[index] = SeamProfile(
                points=points[row],
                along=arc_length(points[row]),
                gap=told.gap[row],
                width=told.width[row],
                step=told.step[row],
                kink=told.kink[row],
            )
    return tuple(found[index] for index in range(len(seams)))
