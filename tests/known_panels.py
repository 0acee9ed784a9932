"""References whose panels are known: samples and outlines taken from given shapes, and other words for the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cadpanel.geometry.frames import cross
from cadpanel.geometry.seam import EndCurves
from cadpanel.geometry.shape import ConePatch, PanelShape
from cadpanel.reference.model import PanelReference, Reference, Seam

Array = NDArray[np.float64]

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


def sampled(shape: PanelShape, name: str) -> PanelReference:
    """The shape as a reference: every sample lies on it exactly."""
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
        ends=(ends[0][0][0], ends[1][0][0]),
        end_normals=(ends[0][1][0], ends[1][1][0]),
        sides=(sides[0], sides[1]),
    )


def alone(*shapes: PanelShape) -> Reference:
    """Panels that do not touch."""
    return Reference(
        source="known", panels=tuple(sampled(shape, f"panel {i + 1}") for i, shape in enumerate(shapes)), seams=()
    )


def renumbered(reference: Reference, order: Sequence[int]) -> Reference:
    """The same panels in another order."""
    where = np.argsort(order)
    seams = tuple(
        Seam(panels=(int(where[seam.panels[0]]), int(where[seam.panels[1]])), ends=seam.ends, reversed=seam.reversed)
        for seam in reference.seams
    )
    return Reference(source=reference.source, panels=tuple(reference.panels[i] for i in order), seams=seams)


def flipped(reference: Reference, index: int) -> Reference:
    """The same panels, one of them walked from its other end: ends and sides change places and run backwards."""
    panel = reference.panels[index]
    turned = replace(
        panel,
        ends=(panel.ends[1][::-1], panel.ends[0][::-1]),
        end_normals=(panel.end_normals[1][::-1], panel.end_normals[0][::-1]),
        sides=(panel.sides[1][::-1], panel.sides[0][::-1]),
    )
    seams = tuple(
        Seam(
            panels=seam.panels,
            ends=(
                1 - seam.ends[0] if seam.panels[0] == index else seam.ends[0],
                1 - seam.ends[1] if seam.panels[1] == index else seam.ends[1],
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
            ends=(of.ends[0] @ turn.T + shift, of.ends[1] @ turn.T + shift),
            end_normals=(of.end_normals[0] @ turn.T, of.end_normals[1] @ turn.T),
            sides=(of.sides[0] @ turn.T + shift, of.sides[1] @ turn.T + shift),
        )

    return replace(reference, panels=tuple(panel(of) for of in reference.panels))


def ring(panel: PanelReference, count: int, turn: Array) -> Reference:
    """Copies of a panel, each turned from the last by a rotation whose `count`-th power is no turn at all."""
    panels, reference = [], Reference(source="ring", panels=(panel,), seams=())
    for i in range(count):
        panels.append(replace(reference.panels[0], name=f"panel {i + 1}"))
        reference = moved(reference, turn, np.zeros(3))
    seams = tuple(Seam(panels=(i, (i + 1) % count), ends=(1, 0), reversed=False) for i in range(count))
    return Reference(source="ring", panels=tuple(panels), seams=seams)
