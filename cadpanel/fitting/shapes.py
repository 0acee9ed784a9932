"""From unknowns back to panels in millimetres: shapes for the solids, edge curves for the measures."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.placed import Placed
from cadpanel.fitting.problem import Problem
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference
from cadpanel.terms.state import State


def panel_shapes(problem: Problem, reference: Reference, unknowns: Array) -> tuple[Panel, ...]:
    """Every panel in the coordinates of the reference's file, mm."""
    state, place = problem.state(unknowns), problem.place
    shapes: dict[int, Panel] = {}
    for group, walked in zip(problem.layout.groups, state.walks, strict=True):
        placed = Placed(
            names=[reference.panels[i].name for i in group.panels],
            origins=place.origins[group.panels] + place.centre,
            axes=place.axes[group.panels],
            length=place.length,
        )
        shapes |= dict(zip(group.panels.tolist(), group.feature.shapes(walked, placed), strict=True))
    return tuple(shapes[panel] for panel in range(problem.panels))


def edge_curves(problem: Problem, state: State, panels: IntArray, edges: IntArray, *, straight: bool) -> EndCurves:
    """One edge of each of s panels as curves of equally many pieces, mm from the middle of all panels.

    Args:
        problem: where the panels' frames stand.
        state: the panels.
        panels: (s,).
        edges: (s,) which edge of each; where they are not straight, ends of chains of equally many patches.
        straight: whether all of them are segments.
    """
    return _segments(problem, state, panels, edges) if straight else _ends(problem, state, panels, edges)


def _ends(problem: Problem, state: State, panels: IntArray, edges: IntArray) -> EndCurves:
    place, surfaces = problem.place, state.surfaces
    pieces = int(surfaces.count[panels[0]])
    turn = np.swapaxes(place.axes[panels], 1, 2)
    corners = edges[:, None] * (pieces + 1) + np.arange(pieces + 1)
    rulings, patches = np.s_[: pieces + 1], np.s_[:pieces]
    m, s = state.cuts.m[panels, edges], state.cuts.s[panels, edges]
    return EndCurves(
        corners=place.to_world(state.corners.position[panels[:, None], corners], panels) * place.length,
        p=place.to_world(surfaces.ruling_p[panels][:, rulings], panels) * place.length,
        t=surfaces.ruling_t[panels][:, rulings] @ turn,
        n=surfaces.ruling_n[panels][:, rulings] @ turn,
        radius=surfaces.radius[panels][:, patches] * place.length,
        half_angle=surfaces.half_angle[panels][:, patches],
        sweep=surfaces.sweep[panels][:, patches],
        cut_point=place.to_world((s[:, None] * m)[:, None], panels)[:, 0] * place.length,
        cut_normal=(m[:, None] @ turn)[:, 0],
    )


def _segments(problem: Problem, state: State, panels: IntArray, edges: IntArray) -> EndCurves:
    place, features = problem.place, problem.layout.feature_of
    found = [features[p].edges[e] for p, e in zip(panels, edges, strict=True)]
    corners = np.array([[edge.corners[0], edge.corners[-1]] for edge in found], dtype=np.intp).reshape(-1, 2)
    # The skin's normal is that of the ruling; a chain's last ruling is its side 1.
    last = [len(features[p].patches) if edge.name == "side 1" else 0 for p, edge in zip(panels, found, strict=True)]
    n = (state.surfaces.ruling_n[panels, last][:, None] @ np.swapaxes(place.axes[panels], 1, 2))[:, 0]
    at = place.to_world(state.corners.position[panels[:, None], corners], panels) * place.length
    along = _unit(at[:, 1] - at[:, 0])
    flat = np.zeros((len(panels), 1))
    return EndCurves(
        corners=at,
        p=at,
        t=np.stack([along, along], axis=1),
        n=np.stack([n, n], axis=1),
        radius=flat,
        half_angle=flat,
        sweep=flat,
        cut_point=at[:, 0],
        cut_normal=along,
    )


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
