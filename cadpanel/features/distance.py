"""The skin of walked panels: a point's patch, its distance from it, and how that follows the numbers."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.rulings import Walk, once
from cadpanel.geometry.cone import INNER, Skins, skin_rows
from cadpanel.geometry.patch_under import HalfWay, half_way, patch_under


def assign(walked: Walk, x: Array) -> IntArray:
    """(panels, m) the patch of each point x (3, panels, m); see `patch_under`."""
    if len(walked.feature.patches) == 1:
        return np.zeros(x.shape[1:], dtype=np.intp)
    return patch_under(x, middle(walked), (walked.edges.p, walked.edges.b))


@once
def middle(walked: Walk) -> HalfWay:
    """The rulings at which panels have turned half of their way: the anchor's where one patch turns alone."""
    feature, anchor, edges = walked.feature, walked.anchor, walked.edges
    if sum(feature.curved) <= 1:
        return HalfWay(anchor.p[:, 0], anchor.b[:, 0], np.full(len(walked.values), feature.anchor))
    return half_way((edges.p, edges.t, edges.n), round_numbers(walked))


@once
def round_numbers(walked: Walk) -> tuple[Array, Array, Array]:
    """(panels, k) radii, half angles and sweeps of the patches; 0 for planes."""
    numbers = np.zeros((3, len(walked.values), len(walked.feature.patches)))
    for i, curved in enumerate(walked.feature.curved):
        if curved:
            numbers[:, :, i] = walked.dimensions[i].values.T
    return numbers[0], numbers[1], numbers[2]


@once
def skins_of(walked: Walk) -> Array:
    """(17, panels, k) the patches, see `geometry.cone.skin_rows`."""
    _, t, n, p = walked.carriers.frames.transpose(2, 3, 0, 1)
    radius, half_angle, _ = round_numbers(walked)
    return skin_rows(p, t, n, radius, half_angle)


def skins_under(walked: Walk, patch: IntArray) -> Skins:
    """The patches (panels, m) of points, each with its point."""
    rows, curved = skins_of(walked), walked.feature.curved
    if len(curved) == 1:
        return Skins(rows, curved[0])
    place = np.arange(0, len(patch) * len(curved), len(curved))[:, None] + patch
    return Skins(np.take(rows.reshape(len(rows), -1), place, axis=1), all(curved) or np.array(curved)[patch])


def patch_distance_inner(walked: Walk, x: Array, patch: int) -> tuple[Array, Array]:
    """Signed distance (panels, m) of points x (3, panels, m) to the whole surface of one patch, positive outside.

    And the derivative (panels, m, 8) by the patch's eight inner numbers.
    """
    skins = Skins(skins_of(walked)[:, :, patch, None], walked.feature.curved[patch])
    distance, inner = skins.distance_inner(x)
    return distance, np.moveaxis(inner, 0, 2)


@once
def patch_outers(walked: Walk) -> Array:
    """(panels, k, 8, N) how the patches' inner numbers (twist of the ruling, radius, half angle) follow the numbers."""
    twist = walked.carriers.twist
    if twist is None:
        raise ValueError("the panels were walked without derivatives")
    outer = np.zeros((*twist.shape[:2], INNER, twist.shape[3]))
    outer[:, :, :6] = twist
    for i, curved in enumerate(walked.feature.curved):
        if curved:
            outer[:, i, 6:, walked.feature.patch_slice(i)] = walked.dimensions[i].by_numbers()[..., :2, :]
    return outer


def skin_normals(walked: Walk, x: Array, patch: IntArray) -> Array:
    """(panels, m, 3) the skin's unit normals at the foot points of points x (3, panels, m) on their patches."""
    return np.moveaxis(skins_under(walked, patch).normals(x), 0, 2)
