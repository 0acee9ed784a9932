"""The skin of walked panels: a point's patch, its distance from it, and how that follows the numbers."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.rulings import Walk
from cadpanel.geometry.cone import (
    INNER,
    cone_distance,
    cone_distance_inner,
    cone_normal,
    plane_distance,
    plane_inner,
)
from cadpanel.geometry.patch_under import HalfWay, half_way, patch_under


def assign(walked: Walk, x: Array) -> IntArray:
    """(panels, m) the patch of each point x (3, panels, m); see `patch_under`."""
    if len(walked.feature.patches) == 1:
        return np.zeros(x.shape[1:], dtype=np.intp)
    return patch_under(x, middle(walked), (walked.edges.p, walked.edges.b))


def middle(walked: Walk) -> HalfWay:
    """The rulings at which panels have turned half of their way: the anchor's where one patch turns alone."""
    feature, anchor, edges = walked.feature, walked.anchor, walked.edges
    if sum(feature.curved) <= 1:
        return HalfWay(anchor.p[:, 0], anchor.b[:, 0], np.full(len(walked.values), feature.anchor))
    return half_way((edges.p, edges.t, edges.n), round_numbers(walked))


def round_numbers(walked: Walk) -> tuple[Array, Array, Array]:
    """(panels, k) radii, half angles and sweeps of the patches; 0 for planes."""
    numbers = np.zeros((3, len(walked.values), len(walked.feature.patches)))
    for i, curved in enumerate(walked.feature.curved):
        if curved:
            numbers[:, :, i] = walked.dimensions[i].values.T
    return numbers[0], numbers[1], numbers[2]


def patch_distance(walked: Walk, x: Array, patch: int) -> Array:
    """(panels, m) signed distance of points x (3, panels, m) to the whole surface of one patch, positive outside."""
    p, t, n = _carrier(walked, patch)
    if not walked.feature.curved[patch]:
        return plane_distance(x, p, n)
    return cone_distance(x, p, t, n, *_cone(walked, patch))


def patch_distance_inner(walked: Walk, x: Array, patch: int) -> tuple[Array, Array]:
    """As `patch_distance`, and the derivative (panels, m, 8) by the patch's eight inner numbers."""
    p, t, n = _carrier(walked, patch)
    if not walked.feature.curved[patch]:
        return plane_distance(x, p, n), plane_inner(x, n)
    return cone_distance_inner(x, p, t, n, *_cone(walked, patch))


def patch_outer(walked: Walk, patch: int) -> Array:
    """(panels, 8, N) how a patch's eight inner numbers (twist of its ruling, radius, half angle) follow the numbers."""
    if walked.carriers.twist is None:
        raise ValueError("the panels were walked without derivatives")
    outer = np.zeros((len(walked.values), INNER, walked.values.shape[1]))
    outer[:, :6] = walked.carriers.twist[:, patch]
    if walked.feature.curved[patch]:
        outer[:, 6:, walked.feature.patch_slice(patch)] = walked.dimensions[patch].by_numbers()[..., :2, :]
    return outer


def skin_normals(walked: Walk, x: Array, patch: IntArray) -> Array:
    """(panels, m, 3) the skin's unit normals at the foot points of points x (3, panels, m) on their patches."""
    normals = np.empty((*patch.shape, 3))
    for i, curved in enumerate(walked.feature.curved):
        p, t, n = _carrier(walked, i)
        here = cone_normal(x, p, t, n, *_cone(walked, i)) if curved else n[:, None]
        normals = np.where((patch == i)[..., None], here, normals)
    return normals


def _cone(walked: Walk, patch: int) -> tuple[Array, Array]:
    """Radius and half angle (panels,) of a curved patch."""
    values = walked.dimensions[patch].values
    return values[:, 0], values[:, 1]


def _carrier(walked: Walk, patch: int) -> tuple[Array, Array, Array]:
    carriers = walked.carriers
    return carriers.p[:, patch], carriers.t[:, patch], carriers.n[:, patch]
