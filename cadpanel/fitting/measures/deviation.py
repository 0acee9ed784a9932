"""How far points are from fitted panels: from the patch under each point's foot; millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.edges import curved, round_numbers
from cadpanel.geometry.cone import cone_distance, plane_distance
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patch_under import half_way, patch_under
from cadpanel.geometry.vectors import cross
from cadpanel.reference.model import Reference

# Panels worked on together: their points and distances stay in the processor's cache.
_CHUNK = 64


def deviations(shapes: Sequence[Panel], points: Array) -> Array:
    """(panels, m) signed distance of points (panels, m, 3) to the skins of their panels, positive outside.

    To the whole surface of the patch between whose bounding rulings the foot point falls: trimming does not count here.
    """
    found = np.empty(points.shape[:2])
    groups: dict[tuple[bool, ...], list[int]] = {}
    for i, shape in enumerate(shapes):
        groups.setdefault(curved(shape), []).append(i)
    for kinds, members in groups.items():
        for start in range(0, len(members), _CHUNK):
            part = members[start : start + _CHUNK]
            found[part] = _distances([shapes[i] for i in part], kinds, points[part])
    return found


def outline_distances(shapes: Sequence[Panel], reference: Reference) -> Array:
    """(panels, q) distance of the points of the references' outlines to the skins' patches, mm.

    Where outlines have fewer points than others, one of their points stands there again.
    """
    outlines = [np.concatenate(panel.edges) for panel in reference.panels]
    most = max(len(outline) for outline in outlines)
    points = np.empty((len(outlines), most, 3))
    for i, outline in enumerate(outlines):
        points[i, : len(outline)] = outline
        points[i, len(outline) :] = outline[0]
    return np.abs(deviations(shapes, points))


def _distances(shapes: Sequence[Panel], kinds: Sequence[bool], points: Array) -> Array:
    """The same for panels whose patches are of the same kinds, each counted from the middle of its own points."""
    middle = points.mean(axis=1)
    x = np.ascontiguousarray(np.moveaxis(points - middle[:, None], 2, 0))
    p, t, n = (np.array(axis) for axis in zip(*(_rulings(shape) for shape in shapes), strict=True))
    p -= middle[:, None]
    radius, half_angle, sweep = round_numbers(shapes)

    def to(patch: int) -> Array:
        if not kinds[patch]:
            return plane_distance(x, p[:, patch], n[:, patch])
        return cone_distance(x, p[:, patch], t[:, patch], n[:, patch], radius[:, patch], half_angle[:, patch])

    if len(kinds) == 1:
        return to(0)
    patch = patch_under(x, half_way((p, t, n), (radius, half_angle, sweep)), (p, cross(t, n)))
    distance = np.zeros(patch.shape)
    for i in range(len(kinds)):
        distance = np.where(patch == i, to(i), distance)
    return distance


def _rulings(shape: Panel) -> tuple[Array, Array, Array]:
    """Points, directions and normals (k + 1, 3) of a panel's rulings; where there is one patch of its first, once."""
    p, t, n = shape.rulings()
    return (p[:1], t[:1], n[:1]) if len(shape.patches) == 1 else (p, t, n)
