"""References whose panels are known: samples and outlines taken from given shapes, and other words for the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.problem import Problem, pose
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.vectors import cross
from cadpanel.reference.model import PanelReference, Reference, Seam

# Samples along a panel and across each of its patches; points of an outline's end over each patch.
_ALONG, _ACROSS, _OUTLINE = 9, 7, 33


def end_curve(shape: PanelShape, end: int) -> EndCurves:
    """One end of a panel as a batch of one."""
    numbers = np.zeros((1, len(shape.patches), 3))
    for i, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            numbers[0, i] = patch.radius, patch.half_angle, patch.sweep
    return EndCurves(
        corners=shape.corners()[end][None],
        p=shape.points[None],
        t=shape.directions[None],
        n=shape.normals[None],
        radius=numbers[..., 0],
        half_angle=numbers[..., 1],
        sweep=numbers[..., 2],
        cut_point=shape.cut_points[end][None],
        cut_normal=shape.cut_normals[end][None],
    )


def sampled(shape: Panel, name: str) -> PanelReference:
    """The shape as a reference: every sample lies on it exactly."""
    if isinstance(shape, PolygonShape):
        return _sampled_polygon(shape, name)
    assert isinstance(shape, PanelShape)
    return _sampled_chain(shape, name)


def _sampled_polygon(shape: PolygonShape, name: str) -> PanelReference:
    """Samples in the middles of the cells of a grid on each triangle between an edge and the middle of the corners.

    With four corners the first edge is end 0, and the edges are told in the order and direction of ends and sides.
    """
    start, middle = shape.outline, shape.outline.mean(axis=0)
    stop = np.roll(start, -1, axis=0)
    out, along = (grid.reshape(-1, 1, 1) for grid in np.meshgrid(*2 * [(np.arange(_ACROSS) + 0.5) / _ACROSS]))
    points = middle + out * ((1.0 - along) * start + along * stop - middle)
    area = 0.5 * np.linalg.norm(cross(start - middle, stop - middle), axis=-1)
    weights = np.broadcast_to(2.0 * out[..., 0] * area / _ACROSS**2, points.shape[:-1])
    line = np.linspace(0.0, 1.0, _OUTLINE)[:, None]
    edges = [(1.0 - line) * a + line * b for a, b in zip(start, stop, strict=True)]
    if len(edges) == 4:
        edges = [edges[0], edges[2][::-1], edges[3][::-1], edges[1]]
    return PanelReference(
        name=name,
        points=points.reshape(-1, 3),
        normals=np.broadcast_to(shape.normal, points.shape).reshape(-1, 3),
        weights=weights.reshape(-1),
        edges=tuple(edges),
        edge_normals=tuple(np.broadcast_to(shape.normal, edge.shape) for edge in edges),
    )


def _sampled_chain(shape: PanelShape, name: str) -> PanelReference:
    patches = len(shape.patches)
    curves = [end_curve(shape, end) for end in (0, 1)]
    u = np.concatenate([i + (np.arange(_ACROSS) + 0.5) / _ACROSS for i in range(patches)])
    (first, normals), (last, _) = (curve.follow(u[None]) for curve in curves)
    share = ((np.arange(_ALONG) + 0.5) / _ALONG)[:, None, None]
    points = (1.0 - share) * first + share * last
    step = 1e-6
    ahead, behind = (
        (1.0 - share) * curves[0].follow(v)[0] + share * curves[1].follow(v)[0]
        for v in (u[None] + step, u[None] - step)
    )
    area = np.linalg.norm(cross((ahead - behind) / (2.0 * step), np.broadcast_to(last - first, points.shape)), axis=-1)
    around = np.linspace(0.0, patches, patches * (_OUTLINE - 1) + 1)[None]
    ends = [curve.follow(around) for curve in curves]
    corners = shape.corners()
    line = np.linspace(0.0, 1.0, _OUTLINE)[:, None]
    sides = [(1.0 - line) * corners[0, ruling] + line * corners[1, ruling] for ruling in (0, -1)]
    return PanelReference(
        name=name,
        points=points.reshape(-1, 3),
        normals=np.broadcast_to(normals, points.shape).reshape(-1, 3),
        weights=area.reshape(-1) / (_ALONG * _ACROSS),
        edges=(ends[0][0][0], ends[1][0][0], *sides),
        edge_normals=(
            ends[0][1][0],
            ends[1][1][0],
            *(np.broadcast_to(shape.normals[ruling], side.shape) for ruling, side in zip((0, -1), sides, strict=True)),
        ),
    )


def posed(reference: Reference, settings: FitSettings) -> tuple[Problem, tuple[Array, ...]]:
    """The problem and the starts of a reference whose panels all have the settings' feature."""
    return pose(reference, [settings.feature_for(len(panel.edges)) for panel in reference.panels])


def alone(*shapes: Panel) -> Reference:
    """Panels that do not touch."""
    return Reference(
        source="known", panels=tuple(sampled(shape, f"panel {i + 1}") for i, shape in enumerate(shapes)), seams=()
    )


def renumbered(reference: Reference, order: Sequence[int]) -> Reference:
    """The same panels in another order."""
    where = np.argsort(order)
    seams = tuple(
        Seam(panels=(int(where[seam.panels[0]]), int(where[seam.panels[1]])), edges=seam.edges, reversed=seam.reversed)
        for seam in reference.seams
    )
    return Reference(source=reference.source, panels=tuple(reference.panels[i] for i in order), seams=seams)


def flipped(reference: Reference, index: int) -> Reference:
    """The same panels, one of them walked from its other end: ends and sides change places and run backwards."""
    panel = reference.panels[index]
    order = (1, 0, 3, 2)
    turned = replace(
        panel,
        edges=tuple(panel.edges[k][::-1] for k in order),
        edge_normals=tuple(panel.edge_normals[k][::-1] for k in order),
    )
    seams = tuple(
        Seam(
            panels=seam.panels,
            edges=(
                seam.edges[0] ^ 1 if seam.panels[0] == index else seam.edges[0],
                seam.edges[1] ^ 1 if seam.panels[1] == index else seam.edges[1],
            ),
            reversed=seam.reversed != (index in seam.panels),
        )
        for seam in reference.seams
    )
    panels = tuple(turned if i == index else other for i, other in enumerate(reference.panels))
    return Reference(source=reference.source, panels=panels, seams=seams)


def moved(reference: Reference, turn: Array, shift: Array) -> Reference:
    """All panels turned by a matrix and shifted."""

    def panel(of: PanelReference) -> PanelReference:
        return replace(
            of,
            points=of.points @ turn.T + shift,
            normals=of.normals @ turn.T,
            edges=tuple(edge @ turn.T + shift for edge in of.edges),
            edge_normals=tuple(normals @ turn.T for normals in of.edge_normals),
        )

    return replace(reference, panels=tuple(panel(of) for of in reference.panels))


def ring(panel: PanelReference, count: int, turn: Array) -> Reference:
    """Copies of a panel, each turned from the last by a rotation whose `count`-th power is no turn at all."""
    panels, reference = [], Reference(source="ring", panels=(panel,), seams=())
    for i in range(count):
        panels.append(replace(reference.panels[0], name=f"panel {i + 1}"))
        reference = moved(reference, turn, np.zeros(3))
    seams = tuple(Seam(panels=(i, (i + 1) % count), edges=(1, 0), reversed=False) for i in range(count))
    return Reference(source="ring", panels=tuple(panels), seams=seams)
