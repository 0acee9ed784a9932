"""From samples to fits: make them ready, run the race, turn and measure what won, in millimetres."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from cadpanel.arrays import Array
from cadpanel.atomic.clouds import Clouds, clouds
from cadpanel.atomic.deviations import covariances
from cadpanel.atomic.race import race
from cadpanel.atomic.result import AtomicFits
from cadpanel.atomic.ruling import CONE, PLANE, Rulings, distances, normals, passed_apex


def fit_surfaces(
    points: ArrayLike,
    outward: ArrayLike | None,
    weights: ArrayLike | None,
    *,
    unknowns: tuple[int, ...],
    starts: Callable[[Clouds], list[Rulings]],
    what: str,
) -> AtomicFits:
    """The best surface with these unknowns for each of n sets; see `fit_planes` and its siblings for the arguments."""
    ready = clouds(points, outward, weights, least=len(unknowns), what=what)
    rulings, converged = race(ready, starts, unknowns)
    rulings = _turned(ready, rulings, unknowns)
    q = rulings.local(ready.points)
    residuals = distances(rulings, q)
    # Seen from beyond the apex the apex is what is nearest.
    residuals = np.where(ready.roots > 0.0, np.copysign(np.hypot(residuals, passed_apex(rulings, q)), residuals), 0.0)
    scale = ready.sizes
    residuals *= scale[:, None]
    return AtomicFits(
        points=ready.centres + scale[:, None] * (ready.axes @ rulings.points[:, :, None])[:, :, 0],
        frames=ready.axes @ rulings.frames,
        curvature=rulings.curvature / scale,
        taper=rulings.taper / scale,
        residuals=residuals,
        rms=np.sqrt(np.sum((ready.roots * residuals) ** 2, axis=1)),
        max=np.max(np.abs(residuals), axis=1),
        covariance=covariances(ready, rulings, unknowns),
        converged=converged,
        sizes=scale,
    )


def _turned(ready: Clouds, rulings: Rulings, unknowns: tuple[int, ...]) -> Rulings:
    """The same surfaces with their normal and their ruling turned to the side that is agreed upon.

    The normal points to the side of the given normals; without any away from the axis. The ruling of a cone points away
    from its apex; else, as the normal of a plane without normals, its largest coordinate is positive.
    """
    if ready.normals is not None:
        under = normals(rulings, rulings.local(ready.points))
        given = np.moveaxis(ready.normals @ rulings.frames, -1, 0)
        side = np.einsum("xnm,xnm,nm->n", under, given, ready.roots**2)
    else:
        side = np.zeros(len(rulings.points))
    largest = _sign_of_largest(ready.axes @ rulings.frames)
    side = np.where(side != 0.0, side, np.where(rulings.curvature != 0.0, rulings.curvature, largest[:, 2]))
    normal_sign = np.where(side < 0.0, -1.0, 1.0)
    along = rulings.taper if unknowns == CONE else np.zeros_like(side)
    ruling_sign = np.where(np.where(along != 0.0, along, largest[:, 1]) < 0.0, -1.0, 1.0)
    frames = rulings.frames.copy()
    frames[:, :, 0] *= (normal_sign * ruling_sign)[:, None]
    frames[:, :, 1] *= ruling_sign[:, None]
    frames[:, :, 2] *= normal_sign[:, None]
    return Rulings(
        points=rulings.points,
        frames=frames,
        curvature=np.zeros_like(side) if unknowns == PLANE else rulings.curvature * normal_sign,
        taper=rulings.taper * ruling_sign,
    )


def _sign_of_largest(frames: Array) -> Array:
    """(n, 3) the largest coordinate of each column."""
    largest = np.argmax(np.abs(frames), axis=1)
    values: Array = np.take_along_axis(frames, largest[:, None], axis=1)[:, 0]
    return values
