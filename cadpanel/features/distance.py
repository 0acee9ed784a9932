"""The skin of walked panels: a point's patch, its distance from it, and how that follows the numbers."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.rulings import Walk, once
from cadpanel.geometry.cone import INNER, Skins
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
def skin_numbers(walked: Walk) -> Array:
    """(panels, k, 11) the patches in numbers: t, n, p of the ruling, radius and half angle (0 of planes)."""
    rulings, (radius, half_angle, _) = walked.carriers.frames, round_numbers(walked)
    numbers = np.empty((*rulings.shape[:2], 11))
    numbers[:, :, :9] = rulings[:, :, 1:].reshape(*rulings.shape[:2], 9)
    numbers[:, :, 9], numbers[:, :, 10] = radius, half_angle
    return numbers


def skins_under(walked: Walk, patch: IntArray) -> Skins:
    """The patches (panels, m) of points, each with its point."""
    numbers, curved = skin_numbers(walked), walked.feature.curved
    if len(curved) == 1:
        return Skins.of_rows(np.moveaxis(numbers, 2, 0), curved[0])
    flat = np.ascontiguousarray(numbers.reshape(-1, 11).T)
    place = np.arange(len(numbers))[:, None] * len(curved) + patch
    return Skins.of_rows(np.take(flat, place, axis=1), all(curved) or np.array(curved)[patch])


def patch_distance_inner(walked: Walk, x: Array, patch: int) -> tuple[Array, Array]:
    """Signed distance (panels, m) of points x (3, panels, m) to the whole surface of one patch, positive outside.

    And the derivative (panels, m, 8) by the patch's eight inner numbers.
    """
    rows = np.moveaxis(skin_numbers(walked)[:, patch], 1, 0)[:, :, None]
    distance, inner = Skins.of_rows(rows, walked.feature.curved[patch]).distance_inner(x)
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
