"""From unknowns back to panels in millimetres, for the solids and the measures."""

from __future__ import annotations

from cadpanel.arrays import Array
from cadpanel.features.placed import Placed
from cadpanel.fitting.problem import Problem
from cadpanel.geometry.panel import Panel


def panel_shapes(problem: Problem, unknowns: Array) -> tuple[Panel, ...]:
    """Every panel at the unknowns (panels, size), in the coordinates of the reference's file, mm."""
    state, place = problem.state(unknowns), problem.place
    shapes: dict[int, Panel] = {}
    for group, walked in zip(problem.layout.groups, state.walks, strict=True):
        placed = Placed(
            names=[problem.names[i] for i in group.panels],
            origins=place.origins[group.panels] + place.centre,
            axes=place.axes[group.panels],
            length=place.length,
        )
        shapes |= dict(zip(group.panels.tolist(), group.feature.shapes(walked, placed), strict=True))
    return tuple(shapes[panel] for panel in range(problem.panels))
