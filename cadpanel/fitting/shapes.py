"""From unknowns back to panels in millimetres, for the solids and the measures."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.cut_planes import cut_planes
from cadpanel.features.feature import Feature
from cadpanel.features.layout import Group
from cadpanel.features.rulings import Walk
from cadpanel.fitting.problem import Problem
from cadpanel.geometry.shape import AnyShape, ConePatch, PanelShape, Patch, PlanePatch, PolygonShape
from cadpanel.geometry.vectors import dot


def panel_shapes(problem: Problem, unknowns: Array) -> tuple[AnyShape, ...]:
    """Every panel at the unknowns (panels, size), in the coordinates of the reference's file, mm."""
    state = problem.state(unknowns)
    shapes: dict[int, AnyShape] = {}
    for group, walked in zip(problem.layout.groups, state.walks, strict=True):
        names = [problem.names[i] for i in group.panels]
        made = _chains if isinstance(group.feature, Feature) else _polygons
        shapes |= dict(zip(group.panels.tolist(), made(problem, group, walked, names), strict=True))
    return tuple(shapes[panel] for panel in range(problem.panels))


def _chains(problem: Problem, group: Group, walked: Walk, names: list[str]) -> list[AnyShape]:
    length = problem.place.length
    turn = np.swapaxes(problem.place.axes[group.panels], 1, 2)
    origins = problem.place.origins[group.panels] + problem.place.centre
    points = walked.edges.p * length @ turn + origins[:, None]
    directions, normals = _unit(walked.edges.t @ turn), _unit(walked.edges.n @ turn)
    m, s = cut_planes(walked)
    cut_points = (s[..., None] * m / dot(m, m)[..., None]) * length @ turn + origins[:, None]
    cut_normals = _unit(m @ turn)
    return [
        PanelShape(
            name=name,
            feature=group.feature.name,
            points=points[i],
            directions=directions[i],
            normals=normals[i],
            patches=_patches(walked, i, length),
            cut_points=cut_points[i],
            cut_normals=cut_normals[i],
        )
        for i, name in enumerate(names)
    ]


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


def _polygons(problem: Problem, group: Group, walked: Walk, names: list[str]) -> list[AnyShape]:
    place = problem.place
    outlines = place.to_world(group.feature.corners(walked).position, group.panels) * place.length + place.centre
    normals = _unit(walked.anchor.n @ np.swapaxes(place.axes[group.panels], 1, 2))[:, 0]
    return [
        PolygonShape(name=name, feature=group.feature.name, outline=outlines[i], normal=normals[i])
        for i, name in enumerate(names)
    ]


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
