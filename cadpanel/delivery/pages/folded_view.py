"""Panels in space on a page: seen from outside, obliquely, shaded triangles drawn from the back to the front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.pages.paper import Box, Paper
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.triangles import Triangles
from cadpanel.geometry.vectors import unit

_OBLIQUE = np.array([0.5, -0.4, 0.9])
"""Towards the viewer: across the panel, along it, out of it."""
_GREY = (0.82, 0.85, 0.88)
_DARKEST = 0.45
_UP = np.array([0.0, 0.0, 1.0])
_LEVEL = 0.98
"""Who looks down more steeply than this (cosine) has no up in the picture but that of the panels."""
_FACING = 0.2
"""Normals that cancel out to less than this show no side to look from."""


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """How space is seen: (3, 3) rows to the right, up, and towards the viewer."""

    rows: Array

    def seen(self, points: Array) -> tuple[Array, Array]:
        """(..., 2) places in the picture, and (...,) how near they are, mm."""
        turned = points @ self.rows.T
        return turned[..., :2], turned[..., 2]


def view_from(towards: Array, up: Array) -> View:
    """The view against a direction (3,), with another one (3,) upwards as far as may be."""
    front = unit(towards)
    right = unit(np.cross(up, front))
    return View(rows=np.stack([right, np.cross(front, right), front]))


def panel_view(shape: Panel) -> View:
    """Obliquely from outside, its rulings upwards, end 0 below."""
    _, directions, normals = shape.rulings()
    out = unit(normals.mean(axis=0))
    along = directions.mean(axis=0)
    along = unit(along - (along @ out) * out)
    axes = np.stack([np.cross(along, out), along, out])
    return view_from(_OBLIQUE @ axes, along)


def whole_view(shapes: Sequence[Panel]) -> View:
    """All panels from outside, a little from above where they stand; from a corner where they look all ways."""
    out = np.sum([shape.area() * shape.rulings()[2].mean(axis=0) for shape in shapes], axis=0)
    facing = float(np.linalg.norm(out)) / sum(shape.area() for shape in shapes)
    towards = unit(out) + 0.3 * _UP if facing > _FACING else np.array([1.0, -1.0, 0.8])
    towards = unit(towards)
    level = abs(float(towards @ _UP)) < _LEVEL
    return view_from(towards, _UP if level else np.array([0.0, 1.0, 0.0]))


def draw_folded(paper: Paper, mesh: Triangles, view: View, box: Box) -> None:
    """Draw one sheet as large as fits a box."""
    places, near = view.seen(mesh.points)
    low, high = places.min(axis=0), places.max(axis=0)
    scale = fitting(high - low, box)
    places = scale * (places - 0.5 * (low + high)) + box.middle
    shade = np.abs(mesh.normals[mesh.corners].mean(axis=1) @ view.rows[2])
    facing = mesh.normals[mesh.corners].mean(axis=1) @ view.rows[2] > 0.0
    # The order of triangles that are as near is that of the mesh, whatever the last digit says.
    order = np.argsort(np.round(near[mesh.corners].mean(axis=1), 6), kind="stable")
    for row in order[facing[order]]:
        light = _DARKEST + (1.0 - _DARKEST) * float(shade[row])
        red, green, blue = (light * part for part in _GREY)
        paper.area(places[mesh.corners[row]], (red, green, blue))


def fitting(size: Array, box: Box) -> float:
    """The scale at which a size (2,) fills a box."""
    return min(box.width / max(float(size[0]), 1e-9), box.height / max(float(size[1]), 1e-9))
