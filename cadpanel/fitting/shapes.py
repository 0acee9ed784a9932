"""From unknowns back to panels in millimetres: shapes for the solids, end curves for the measures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.walk import Walk
from cadpanel.fitting.problem import Problem
from cadpanel.geometry.seam import EndCurves
from cadpanel.geometry.shape import ConePatch, PanelShape, Patch, PlanePatch
from cadpanel.reference.model import Reference

Array = NDArray[np.float64]


def panel_shapes(problem: Problem, reference: Reference, unknowns: Array) -> tuple[PanelShape, ...]:
    """Every panel as a `PanelShape` in the coordinates of the reference's file, mm."""
    walked = problem.state(unknowns).walked
    length, axes = problem.place.length, problem.place.axes
    origins = problem.place.origins + problem.place.centre
    points = walked.edges.p * length @ np.swapaxes(axes, 1, 2) + origins[:, None]
    directions = walked.edges.t @ np.swapaxes(axes, 1, 2)
    normals = walked.edges.n @ np.swapaxes(axes, 1, 2)
    cut_points, cut_normals = _cuts(walked, axes)
    cut_points = cut_points * length + origins[:, None]
    return tuple(
        PanelShape(
            name=panel.name,
            feature=problem.feature.name,
            points=points[i],
            directions=_unit(directions[i]),
            normals=_unit(normals[i]),
            patches=_patches(walked, i, length),
            cut_points=cut_points[i],
            cut_normals=cut_normals[i],
        )
        for i, panel in enumerate(reference.panels)
    )


def end_curves(problem: Problem, walked: Walk, corners: Array, end: int) -> EndCurves:
    """One end curve of every panel, in mm from the middle of all panels.

    Args:
        problem: where the panels' frames stand.
        walked: the panels.
        corners: (panels, 2, k + 1, 3) their corners in the panels' own frames, solver's length.
        end: 0 or 1.
    """
    place, edges = problem.place, walked.edges
    turn = np.swapaxes(place.axes, 1, 2)
    numbers = np.zeros((len(corners), len(walked.feature.patches), 3))
    for i, patch in enumerate(walked.feature.patches):
        if patch.kind != "plane":
            numbers[:, i] = walked.values[:, walked.feature.patch_slice(i)]
    cut_points, cut_normals = _cuts(walked, place.axes)
    return EndCurves(
        corners=place.to_world(corners[:, end]) * place.length,
        p=place.to_world(edges.p) * place.length,
        t=edges.t @ turn,
        n=edges.n @ turn,
        radius=numbers[..., 0] * place.length,
        half_angle=numbers[..., 1],
        sweep=numbers[..., 2],
        cut_point=cut_points[:, end] * place.length + place.origins,
        cut_normal=cut_normals[:, end],
    )


def _cuts(walked: Walk, axes: Array) -> tuple[Array, Array]:
    """Points (panels, 2, 3) of the cut planes relative to the frames' origins, turned, and their unit normals."""
    cuts = np.stack([walked.values[:, walked.feature.cut_slice(end)] for end in (0, 1)], axis=1)
    normals = np.stack([cuts[..., 1], np.ones_like(cuts[..., 0]), cuts[..., 2]], axis=-1)
    square = np.sum(normals**2, axis=-1, keepdims=True)
    turn = np.swapaxes(axes, 1, 2)
    return (cuts[..., :1] * normals / square) @ turn, (normals / np.sqrt(square)) @ turn


def _patches(walked: Walk, panel: int, length: float) -> tuple[Patch, ...]:
    patches: list[Patch] = []
    for i, spec in enumerate(walked.feature.patches):
        if spec.kind == "plane":
            patches.append(PlanePatch())
            continue
        radius, half_angle, sweep = walked.values[panel, walked.feature.patch_slice(i)]
        patches.append(
            ConePatch(radius=radius * length, half_angle=float(half_angle), sweep=float(sweep), kind=spec.kind)
        )
    return tuple(patches)


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
