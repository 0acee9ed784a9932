"""What an atomic fit found: one surface, or many as arrays. Lengths are millimetres, angles radians.

The covariance of every fit is sigma^2 (J^T W J)^-1 with sigma^2 = sum(w d^2) / (samples - unknowns): the weights are
relative, and what the samples scatter about the fit is taken for their uncertainty. It belongs to the increments, in
this order, of the turn about the frame's b, t and n (for a plane only b and t), the shift along n, the curvature (not
for a plane) and the taper (only for a cone); see `ruling`. Where the samples do not determine all of them, or are no
more than the unknowns, it is infinite.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypedDict

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.atomic.deviations import angle_variance, axis_covariance

# An apex that is farther off than the samples' extent over this cannot be told from one at infinity.
_APEX_AT_INFINITY = 1e-13


@dataclass(frozen=True, slots=True, kw_only=True)
class AtomicFits:
    """n fitted surfaces of one kind.

    Attributes:
        points: (n, 3) the point of the surface's middle ruling that lies under the samples' mean, mm.
        frames: (n, 3, 3) columns there: b across, t along the ruling, n the surface's unit normal.
        curvature: (n,) 1 / mm, the inverse of the normal radius at the point; positive if n points away from the axis.
        taper: (n,) 1 / mm, the inverse of the distance from the apex, which lies on the side of -t, to the point.
        residuals: (n, m) signed orthogonal distances of the samples, positive on the side of n, mm; 0 for padding.
        rms: (n,) weighted root mean square of the residuals, mm.
        max: (n,) the largest residual, mm.
        covariance: (n, k, k) see above.
        converged: (n,) whether the minimum was reached.
        sizes: (n,) weighted root mean square distance of the samples from their mean, mm.
    """

    points: Array
    frames: Array
    curvature: Array
    taper: Array
    residuals: Array
    rms: Array
    max: Array
    covariance: Array
    converged: BoolArray
    sizes: Array

    @property
    def half_angle(self) -> Array:
        """(n,) signed as curvature and taper are: positive if the surface widens along t, seen from the side of n."""
        bent = self.curvature != 0.0
        ratio = np.divide(self.taper, self.curvature, out=np.zeros_like(self.taper), where=bent)
        return np.where(bent | (self.taper == 0.0), np.arctan(ratio), 0.5 * np.pi)


@dataclass(frozen=True, slots=True, kw_only=True)
class _AtomicFit:
    """One fitted surface; see `AtomicFits` for what each of the fields is.

    Attributes:
        point: (3,) mm.
        frame: (3, 3) columns b, t, n.
        residuals: (m,) mm.
        rms: mm.
        max: mm.
        covariance: (k, k) of the increments named above.
        converged: whether the minimum was reached.
        size: mm, the samples' extent.
    """

    point: Array
    frame: Array
    residuals: Array
    rms: float
    max: float
    covariance: Array
    converged: bool
    size: float

    def __repr__(self) -> str:
        reached = "" if self.converged else ", not converged"
        off = f"RMS {self.rms:.3g} mm, at most {self.max:.3g} mm{reached}"
        return f"<{type(self).__name__} of {len(self.residuals)} points: {off}>"

    @property
    def normal(self) -> Array:
        """(3,) the surface's unit normal at the point: on the side of the given normals, else away from the axis."""
        return self.frame[:, 2]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class PlaneFit(_AtomicFit):
    """The plane of least orthogonal squares; covariance of the turns about b and t, and the shift."""

    @property
    def normal_deviation(self) -> float:
        """Standard deviation of the normal's direction, radians."""
        return math.sqrt(self.covariance[0, 0] + self.covariance[1, 1])

    @classmethod
    def of(cls, fits: AtomicFits, i: int) -> PlaneFit:
        """One of many."""
        return cls(**_fields(fits, i))


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class CylinderFit(_AtomicFit):
    """The cylinder of least orthogonal squares; covariance of turns about b, t, n, the shift and the curvature.

    Attributes:
        curvature: 1 / mm, signed; 0 is the plane.
    """

    curvature: float

    @property
    def radius(self) -> float:
        """Signed, mm: positive if the normal points away from the axis; infinite if the cylinder is a plane."""
        return math.copysign(math.inf, self.curvature) if self.curvature == 0.0 else 1.0 / self.curvature

    @property
    def axis(self) -> Array:
        """(3,) unit direction of the axis."""
        return self.frame[:, 1]

    @property
    def axis_point(self) -> Array | None:
        """(3,) the axis under the point, mm; None if the cylinder is a plane."""
        return None if self.curvature == 0.0 else self.point - self.radius * self.normal

    @property
    def radius_deviation(self) -> float:
        """Standard deviation of the radius, mm."""
        return math.inf if self.curvature == 0.0 else self.radius**2 * math.sqrt(self.covariance[4, 4])

    @property
    def curvature_deviation(self) -> float:
        """Standard deviation of the curvature, 1 / mm."""
        return math.sqrt(self.covariance[4, 4])

    @property
    def axis_deviation(self) -> float:
        """Standard deviation of the axis' direction, radians: root of the sum of the variances in both directions."""
        return math.sqrt(self.covariance[0, 0] + self.covariance[2, 2])

    @classmethod
    def of(cls, fits: AtomicFits, i: int) -> CylinderFit:
        """One of many."""
        return cls(**_fields(fits, i), curvature=float(fits.curvature[i]))


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class ConeFit(_AtomicFit):
    """The cone of least orthogonal squares; covariance of turns about b, t, n, the shift, the curvature and the taper.

    Nearly flat samples tell the ruling and the taper sharply, but half angle and axis only as well as the taper times
    the radius: their deviations say so.

    Attributes:
        curvature: 1 / mm, signed; 0 is the plane.
        taper: 1 / mm, not negative: t points away from the apex; 0 is the cylinder.
    """

    curvature: float
    taper: float

    @property
    def radius(self) -> float:
        """Normal radius at the point, signed, mm: the length of the normal from the point to the axis."""
        return math.copysign(math.inf, self.curvature) if self.curvature == 0.0 else 1.0 / self.curvature

    @property
    def half_angle(self) -> float:
        """Between axis and generatrix, radians, 0 (cylinder) to a quarter turn (plane)."""
        return math.atan2(self.taper, abs(self.curvature))

    @property
    def axis(self) -> Array:
        """(3,) unit direction of the axis, from the apex towards the samples."""
        cosine, sine = math.cos(self.half_angle), math.copysign(math.sin(self.half_angle), self.curvature)
        axis: Array = cosine * self.frame[:, 1] - sine * self.frame[:, 2]
        return axis

    @property
    def axis_point(self) -> Array | None:
        """(3,) where the normal at the point meets the axis, mm; None if the cone is a plane."""
        return None if self.curvature == 0.0 else self.point - self.radius * self.normal

    @property
    def apex(self) -> Array | None:
        """(3,) mm; None if it is too far off to be told from infinity, which makes the cone a cylinder."""
        if self.taper * self.size < _APEX_AT_INFINITY:
            return None
        apex: Array = self.point - self.frame[:, 1] / self.taper
        return apex

    @property
    def radius_deviation(self) -> float:
        """Standard deviation of the normal radius, mm."""
        return math.inf if self.curvature == 0.0 else self.radius**2 * math.sqrt(self.covariance[4, 4])

    @property
    def half_angle_deviation(self) -> float:
        """Standard deviation of the half angle, radians; near 0 of the signed one."""
        return math.sqrt(angle_variance(self.covariance, self.curvature, self.taper))

    @property
    def axis_deviation(self) -> float:
        """Standard deviation of the axis' direction, radians: root of the sum of the variances in both directions."""
        return math.sqrt(float(np.trace(axis_covariance(self.covariance, self.curvature, self.taper))))

    @classmethod
    def of(cls, fits: AtomicFits, i: int) -> ConeFit:
        """One of many."""
        return cls(**_fields(fits, i), curvature=float(fits.curvature[i]), taper=float(fits.taper[i]))


class _Fields(TypedDict):
    point: Array
    frame: Array
    residuals: Array
    rms: float
    max: float
    covariance: Array
    converged: bool
    size: float


def _fields(fits: AtomicFits, i: int) -> _Fields:
    return _Fields(
        point=fits.points[i],
        frame=fits.frames[i],
        residuals=fits.residuals[i],
        rms=float(fits.rms[i]),
        max=float(fits.max[i]),
        covariance=fits.covariance[i],
        converged=bool(fits.converged[i]),
        size=float(fits.sizes[i]),
    )
