"""The plane nearest to samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cadpanel.atomic.clouds import Clouds, single
from cadpanel.atomic.result import AtomicFits, PlaneFit
from cadpanel.atomic.ruling import PLANE, Rulings
from cadpanel.atomic.surface import fit_surfaces


def fit_plane(points: ArrayLike, weights: ArrayLike | None = None, *, normals: ArrayLike | None = None) -> PlaneFit:
    """The plane of least orthogonal squares.

    Args:
        points: (m, 3) mm, at least 3 that are not on one line.
        weights: (m,) relative weights, not negative; a sample of weight 0 does not count.
        normals: (m, 3) outward normals, only to tell the plane's two sides.

    Raises:
        FitError: the samples are no numbers, too few, or do not determine a plane.
    """
    x, outward, w = single(points, normals, weights)
    return PlaneFit.of(fit_planes(x, w, normals=outward), 0)


def fit_planes(points: ArrayLike, weights: ArrayLike | None = None, *, normals: ArrayLike | None = None) -> AtomicFits:
    """As `fit_plane` for n sets at once: points and normals (n, m, 3), weights (n, m), 0 for padding."""
    return fit_surfaces(points, normals, weights, unknowns=PLANE, starts=_starts, what="a plane")


def _starts(clouds: Clouds) -> list[Rulings]:
    """The plane of the two longest main axes; the steps from it only polish its digits."""
    count = len(clouds.points)
    level = np.zeros(count)
    frames = np.broadcast_to(np.eye(3), (count, 3, 3)).copy()
    return [Rulings(points=np.zeros((count, 3)), frames=frames, curvature=level, taper=level.copy())]
