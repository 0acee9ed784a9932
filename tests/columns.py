"""An oval column that flares, in rings of four-sided panels, as arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.reference.model import PanelReference, Reference, Seam

_FINE = 33


def column(rows: int = 3, columns: int = 4, *, wave: float = 0.0, flare: float = 0.5) -> Reference:
    """Rings of panels that stand upon each other: panel `row * columns + column`, end 0 below, walked counterclockwise.

    Args:
        rows: rings.
        columns: panels in each.
        wave: how far rings wave up and down, mm.
        flare: by which share the column is wider at its head.
    """

    def over(height: Array, angle: Array) -> Array:
        wider = 1.0 + flare * height**2
        up = 1500.0 * rows * height + wave * np.sin(2.0 * angle)
        return np.stack([1200.0 * wider * np.cos(angle), 800.0 * wider * np.sin(angle), up], axis=-1)

    panels = []
    for row in range(rows):
        for place in range(columns):
            low, high = row / rows, (row + 1) / rows
            first, last = (2.0 * np.pi * (place + end) / columns for end in (0, 1))
            panels.append(_panel(f"R{row + 1}-{place + 1}", over, (low, high), (first, last)))
    beside = [(row, place, (place + 1) % columns) for row in range(rows) for place in range(columns)]
    seams = [Seam(panels=(row * columns + a, row * columns + b), edges=(3, 2), reversed=False) for row, a, b in beside]
    seams += [Seam(panels=(p, p + columns), edges=(1, 0), reversed=False) for p in range((rows - 1) * columns)]
    return Reference(source="column", panels=tuple(panels), seams=tuple(seams))


def _panel(
    name: str, over: Callable[[Array, Array], Array], heights: tuple[float, float], angles: tuple[float, float]
) -> PanelReference:
    """A patch of the surface between two heights and two angles."""

    def at(height: Array, angle: Array) -> tuple[Array, Array]:
        step = 1e-5
        by_height = (over(height + step, angle) - over(height - step, angle)) / (2.0 * step)
        by_angle = (over(height, angle + step) - over(height, angle - step)) / (2.0 * step)
        out = np.cross(by_angle, by_height)
        return over(height, angle), out

    middle = (np.arange(9) + 0.5) / 9
    height, angle = (low + (high - low) * middle for low, high in (heights, angles))
    points, out = at(*(grid.reshape(-1) for grid in np.meshgrid(height, angle)))
    sizes = np.linalg.norm(out, axis=-1)
    line = np.linspace(0.0, 1.0, _FINE)
    rows, round_ = (low + (high - low) * line for low, high in (heights, angles))
    edges = [at(np.full(_FINE, end), round_) for end in heights] + [at(rows, np.full(_FINE, side)) for side in angles]
    return PanelReference(
        name=name,
        points=points,
        normals=out / sizes[:, None],
        weights=sizes / sizes.sum() * 1e6,
        edges=tuple(edge for edge, _ in edges),
        edge_normals=tuple(out / np.linalg.norm(out, axis=-1, keepdims=True) for _, out in edges),
    )


def turned(reference: Reference, turn: Array) -> Reference:
    """The same with all points and normals turned by a rotation (3, 3)."""
    panels = tuple(
        replace(
            panel,
            points=panel.points @ turn.T,
            normals=panel.normals @ turn.T,
            edges=tuple(edge @ turn.T for edge in panel.edges),
            edge_normals=tuple(normals @ turn.T for normals in panel.edge_normals),
        )
        for panel in reference.panels
    )
    return replace(reference, panels=panels)
