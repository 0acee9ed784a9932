"""Walked chains as panels in millimetres: rulings, patches and cut planes in the coordinates of the file."""

from __future__ import annotations

from cadpanel.features.cut_planes import cut_planes
from cadpanel.features.placed import Placed
from cadpanel.features.rulings import Walk
from cadpanel.geometry.patches import ConePatch, Patch, PlanePatch
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.vectors import dot


def chain_shapes(walked: Walk, placed: Placed) -> list[PanelShape]:
    """Every panel of a walked feature."""
    edges = walked.edges
    points = placed.points(edges.p)
    directions, normals = placed.directions(edges.t), placed.directions(edges.n)
    m, s = cut_planes(walked)
    cut_points = placed.points(s[..., None] * m / dot(m, m)[..., None])
    cut_normals = placed.directions(m)
    return [
        PanelShape(
            name=name,
            feature=walked.feature.name,
            points=points[i],
            directions=directions[i],
            normals=normals[i],
            patches=_patches(walked, i, placed.length),
            cut_points=cut_points[i],
            cut_normals=cut_normals[i],
        )
        for i, name in enumerate(placed.names)
    ]


def _patches(walked: Walk, panel: int, length: float) -> tuple[Patch, ...]:
    patches: list[Patch] = []
    for patch, dimensions in zip(walked.feature.patches, walked.dimensions, strict=True):
        if patch.kind == "plane":
            patches.append(PlanePatch())
            continue
        radius, half_angle, sweep = dimensions.values[panel].tolist()
        patches.append(ConePatch(radius=radius * length, half_angle=half_angle, sweep=sweep, kind=patch.kind))
    return tuple(patches)
