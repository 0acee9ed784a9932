"""The first page: all panels where they hang, with their names."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.meshes.colours import by_feature
from cadpanel.delivery.pages.folded_view import fitting, whole_view
from cadpanel.delivery.pages.paper import Box, Paper, width_of
from cadpanel.delivery.records.report import PanelModel
from cadpanel.geometry.panel import Panel

_LARGEST, _LEAST = 3.5, 0.8
_FILLED = 0.8


def draw_overview(paper: Paper, shapes: Sequence[Panel], records: Sequence[PanelModel], box: Box) -> None:
    """Draw the outlines of all panels, coloured by feature, from the back to the front, and then their names."""
    view = whole_view(shapes)
    seen = [view.seen(outline(shape)) for shape in shapes]
    places = np.concatenate([one for one, _ in seen])
    low, high = places.min(axis=0), places.max(axis=0)
    scale = fitting(high - low, box)
    on_paper = [scale * (one - 0.5 * (low + high)) + box.middle for one, _ in seen]
    # Which of two panels that are as near is drawn first is their order, whatever the last digit says.
    order = sorted(range(len(shapes)), key=lambda row: round(float(seen[row][1].mean()), 6))
    colours = by_feature(records)
    for row in order:
        red, green, blue = (0.5 + 0.5 * part for part in colours[row])
        paper.contour(on_paper[row], width=0.18, fill=(red, green, blue))
    for points, record in zip(on_paper, records, strict=True):
        across = float(np.ptp(points[:, 0]))
        height = _LARGEST * min(1.0, _FILLED * across / max(width_of(record.name, _LARGEST), 1e-9))
        height = max(_LEAST, min(height, 0.3 * float(np.ptp(points[:, 1]))))
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        paper.words(record.name, middle - [0.0, 0.4 * height], height, anchor="middle")


def outline(shape: Panel) -> Array:
    """(n, 3) round a panel through its corners, mm."""
    corners = shape.corners()
    return corners[0] if len(corners) == 1 else np.concatenate([corners[0], corners[1, ::-1]])
