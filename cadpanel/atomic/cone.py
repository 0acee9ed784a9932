"""The cone nearest to samples."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cadpanel.atomic.axis_starts import axis_starts
from cadpanel.atomic.clouds import Clouds, single
from cadpanel.atomic.flat_starts import flat_starts
from cadpanel.atomic.result import AtomicFits, ConeFit
from cadpanel.atomic.ruling import CONE, Rulings
from cadpanel.atomic.surface import fit_surfaces

_FLAT_STARTS, _AXIS_STARTS = 8, 7


def fit_cone(points: ArrayLike, normals: ArrayLike | None = None, weights: ArrayLike | None = None) -> ConeFit:
    """The cone of least orthogonal squares, the best of all that were found from many starts.

    The cylinder (half angle 0) and the plane (curvature 0) are cones like others and no special cases. The cone has
    one nappe; samples beyond the apex are measured to the apex.

    Args:
        points: (m, 3) mm, at least 6 that are not on one line.
        normals: (m, 3) outward normals: they tell the side, and so the sign of the radius, and are one more start.
        weights: (m,) relative weights, not negative; a sample of weight 0 does not count.

    Raises:
        FitError: the samples are no numbers, too few, or do not determine a cone.
    """
    x, outward, w = single(points, normals, weights)
    return ConeFit.of(fit_cones(x, outward, w), 0)


def fit_cones(points: ArrayLike, normals: ArrayLike | None = None, weights: ArrayLike | None = None) -> AtomicFits:
    """As `fit_cone` for n sets at once: points and normals (n, m, 3), weights (n, m), 0 for padding."""
    return fit_surfaces(points, normals, weights, unknowns=CONE, starts=_starts, what="a cone")


def _starts(clouds: Clouds) -> list[Rulings]:
    """Gentle cones, cylinders that turn far, cones that turn far."""
    around = _AXIS_STARTS + (0 if clouds.normals is None else 2)
    return [
        flat_starts(clouds, count=_FLAT_STARTS, tapered=True),
        axis_starts(clouds, count=around, revolved=False),
        axis_starts(clouds, count=around, revolved=True),
    ]
