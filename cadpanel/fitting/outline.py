"""The reference's outline as the drift limits see it: where each corner belongs, and which way along and across are."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.layout import Layout
from cadpanel.fitting.start.begin import Start
from cadpanel.fitting.start.chains import end_plane
from cadpanel.geometry.vectors import dot
from cadpanel.reference.model import PanelReference, Reference
from cadpanel.terms.outline import Limited, Outline
from cadpanel.terms.state import State


def outline_of(reference: Reference, layout: Layout, begin: Start) -> Outline:
    """The outline's corners, and on the ends the points that a fold's corners start nearest to."""
    started = State(layout, layout.walk(begin.unknowns[0], derivatives=False)).corners.position
    corners = np.zeros(started.shape)
    sided = np.zeros(layout.panels, dtype=bool)
    most = started.shape[1]
    along, across = _Rows(layout.panels, most, 1), _Rows(layout.panels, most, 3)
    for i, panel in enumerate(reference.panels):
        feature = layout.feature_of[i]
        count = feature.corner_count
        if not feature.four_sided:
            corners[i, :count] = (panel.corners.reshape(-1, 3) - begin.origins[i]) @ begin.axes[i] / begin.length
            across.set(i, np.arange(count), np.broadcast_to(np.eye(3), (count, 3, 3)))
            continue
        sided[i] = True
        rulings = count // 2
        own, direction, gauge = _four_sided(panel, begin, i, started[i, :count].reshape(2, rulings, 3))
        corners[i, :count] = own.reshape(-1, 3)
        along.set(i, np.arange(count), gauge.reshape(-1, 1, 3))
        outer = np.array([0, rulings - 1, rulings, count - 1])
        way, rod = direction.reshape(-1, 3)[outer], gauge.reshape(-1, 3)[outer]
        across.set(i, outer, np.eye(3) - way[:, :, None] * rod[:, None, :])
    return Outline(corners=corners, along=along.limited(), across=across.limited(), sided=sided)


class _Rows:
    """Rows of all panels under construction, filled up with zeros."""

    def __init__(self, panels: int, most: int, size: int) -> None:
        self._corners = np.zeros((panels, most), dtype=np.intp)
        self._part = np.zeros((panels, most, size, 3))
        self._used = 0

    def set(self, panel: int, corners: IntArray, part: Array) -> None:
        self._corners[panel, : len(corners)] = corners
        self._part[panel, : len(corners)] = part
        self._used = max(self._used, len(corners))

    def limited(self) -> Limited:
        return Limited(corners=self._corners[:, : self._used], part=self._part[:, : self._used])


def _four_sided(panel: PanelReference, begin: Start, index: int, started: Array) -> tuple[Array, Array, Array]:
    """Corners, unit directions of the strip, and gauges, (2, k + 1, 3) each, of one panel.

    A gauge's inner product with a drift is the drift along the strip: the direction itself at the outer corners, at the
    inner ones the normal m of the end's plane over m . direction.
    """
    chords = (panel.corners[1] - panel.corners[0]) @ begin.axes[index]
    chords /= np.linalg.norm(chords, axis=-1, keepdims=True)
    share = np.linspace(0.0, 1.0, started.shape[1])[:, None]
    direction = (1.0 - share) * chords[0] + share * chords[1]
    direction = np.broadcast_to(direction / np.linalg.norm(direction, axis=-1, keepdims=True), started.shape)
    corners, gauge = np.empty_like(started), direction.copy()
    for end in (0, 1):
        line = (panel.ends[end] - begin.origins[index]) @ begin.axes[index] / begin.length
        nearest = np.argmin(np.linalg.norm(line[None] - started[end, 1:-1, None], axis=-1), axis=1)
        corners[end] = line[[0, *nearest, -1]]
        normal = end_plane(line, tilt=True)[1]
        inner = direction[end, 1:-1]
        gauge[end, 1:-1] = normal / dot(np.broadcast_to(normal, inner.shape), inner)[:, None]
    return corners, direction, gauge
