"""The cylinder nearest to samples."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cadpanel.atomic.axis_starts import axis_starts
from cadpanel.atomic.clouds import Clouds, single
from cadpanel.atomic.flat_starts import flat_starts
from cadpanel.atomic.result import AtomicFits, CylinderFit
from cadpanel.atomic.ruling import CYLINDER, Rulings
from cadpanel.atomic.surface import fit_surfaces

_FLAT_STARTS, _AXIS_STARTS = 3, 9


def fit_cylinder(points: ArrayLike, normals: ArrayLike | None = None, weights: ArrayLike | None = None) -> CylinderFit:
    """The cylinder of least orthogonal squares, the best of all that were found from many starts.

    A plane is a cylinder of curvature 0 and no special case: samples of a plane give it, and nearly flat samples a
    large radius, with all the digits that they hold.

    Args:
        points: (m, 3) mm, at least 5 that are not on one line.
        normals: (m, 3) outward normals: they tell the side, and so the sign of the radius, and are one more start.
        weights: (m,) relative weights, not negative; a sample of weight 0 does not count.

    Raises:
        FitError: the samples are no numbers, too few, or do not determine a cylinder.
    """
    x, outward, w = single(points, normals, weights)
    return CylinderFit.of(fit_cylinders(x, outward, w), 0)


def fit_cylinders(points: ArrayLike, normals: ArrayLike | None = None, weights: ArrayLike | None = None) -> AtomicFits:
    """As `fit_cylinder` for n sets at once: points and normals (n, m, 3), weights (n, m), 0 for padding."""
    return fit_surfaces(points, normals, weights, unknowns=CYLINDER, starts=_starts, what="a cylinder")


def _starts(clouds: Clouds) -> list[Rulings]:
    """For gentle samples and for those that turn far."""
    return [
        flat_starts(clouds, count=_FLAT_STARTS, tapered=False),
        axis_starts(clouds, count=_AXIS_STARTS + (0 if clouds.normals is None else 2), revolved=False),
    ]
