"""Where a cut plane meets a cone patch: the exact ellipse, from formulas that never mention the apex.

Notation of one patch: the axis frame (centre, axis a, radial e, tangential b = a x e) at the level of the ruling's
point p, so that p = centre + level_radius * e. A generatrix at sweep angle phi is reached by turning e about a. The
cut plane with unit normal m meets it where m . (x - q) = 0. Projected along the axis, the section is a conic with one
focus on the axis, so phi is its true anomaly and the ellipse's own parameter its eccentric anomaly: Kepler's formulas
carry one to the other, and with half angle 0 (eccentricity 0) they are the identity. Millimetres and radians.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.patches import ConePatch, Patch
from cadpanel.geometry.vectors import cross


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisFrame:
    """A cone or cylinder patch seen from its axis.

    The surface is centre + height * cos(half_angle) * axis + (level_radius + height * sin(half_angle)) * e(phi),
    with e(phi) = cos(phi) * radial + sin(phi) * tangential, `height` measured along the generatrix from the level of p.

    Attributes:
        center: (3,) the axis point at the level of p, mm.
        axis: (3,) unit axis, on the side of t.
        radial: (3,) unit vector square to the axis, from the axis towards p where the radius is positive.
        tangential: (3,) unit axis x radial, equal to the ruling's b.
        level_radius: signed distance from the axis at the level of p, mm: radius * cos(half_angle).
        half_angle: signed, radians.
        sweep: signed, radians; phi runs from 0 to sweep.
    """

    center: Array
    axis: Array
    radial: Array
    tangential: Array
    level_radius: float
    half_angle: float
    sweep: float

    def radials(self, sweep_angles: Array) -> Array:
        """(m, 3) e(phi) for (m,) sweep angles phi."""
        turned = np.outer(np.cos(sweep_angles), self.radial) + np.outer(np.sin(sweep_angles), self.tangential)
        return np.asarray(turned)

    def normals(self, sweep_angles: Array) -> Array:
        """(m, 3) unit normals of the skin along the generatrices at (m,) sweep angles."""
        turned: Array = math.cos(self.half_angle) * self.radials(sweep_angles) - math.sin(self.half_angle) * self.axis
        return turned

    def points(self, sweep_angles: Array, heights: Array) -> Array:
        """(m, 3) points of the surface at (m,) sweep angles and (m,) heights along the generatrix, mm."""
        along = np.outer(heights * math.cos(self.half_angle), self.axis)
        radii = self.level_radius + heights * math.sin(self.half_angle)
        return self.center + along + radii[:, None] * self.radials(sweep_angles)


def axis_frame(point: Array, direction: Array, normal: Array, patch: ConePatch) -> AxisFrame:
    """The axis frame of a cone patch that starts at the ruling (point, direction, normal)."""
    cosine, sine = math.cos(patch.half_angle), math.sin(patch.half_angle)
    radial = cosine * normal + sine * direction
    axis = cosine * direction - sine * normal
    level_radius = patch.radius * cosine
    return AxisFrame(
        center=point - level_radius * radial,
        axis=axis,
        radial=radial,
        tangential=cross(axis, radial),
        level_radius=level_radius,
        half_angle=patch.half_angle,
        sweep=patch.sweep,
    )


def lifted(frame: AxisFrame, lift: float) -> AxisFrame:
    """The parallel patch at `lift` mm along the normals; its points lie at the same angles and heights."""
    shift = lift * math.sin(frame.half_angle) * frame.axis
    return replace(
        frame, center=frame.center - shift, level_radius=frame.level_radius + lift * math.cos(frame.half_angle)
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ConeCut:
    """The numbers of a cut plane in the axis frame of a cone patch.

    Along the generatrix at phi, with cosine = cos(phi - phase): height = (offset - tilt * level_radius * cosine) /
    (cos(half_angle) * rise + sin(half_angle) * tilt * cosine), and radius = axis_radius / (1 + eccentricity * cosine).

    Attributes:
        rise: cosine between the cut plane's normal and the axis; must be positive.
        tilt: sine of the same angle, >= 0.
        phase: sweep angle towards which the normal leans, radians.
        offset: distance of the cut plane from the frame's centre along its normal, mm.
        axis_radius: signed radius of the surface where the plane crosses the axis, mm.
        eccentricity: signed eccentricity of the section seen along the axis; an ellipse where its magnitude is < 1.
    """

    rise: float
    tilt: float
    phase: float
    offset: float
    axis_radius: float
    eccentricity: float


def cut_cone(frame: AxisFrame, cut_point: Array, cut_normal: Array) -> ConeCut:
    """The cut plane through `cut_point` with unit `cut_normal`, seen from the axis frame.

    Raises:
        ValueError: if the plane is parallel to the axis or its normal points against it.
    """
    rise = float(frame.axis @ cut_normal)
    if not rise > 0.0:
        raise ValueError("the cut plane does not cross the axis from below")
    along, across = float(frame.radial @ cut_normal), float(frame.tangential @ cut_normal)
    tilt = math.hypot(along, across)
    offset = float(cut_normal @ (cut_point - frame.center))
    widening = math.tan(frame.half_angle)
    return ConeCut(
        rise=rise,
        tilt=tilt,
        phase=math.atan2(across, along),
        offset=offset,
        axis_radius=frame.level_radius + widening * offset / rise,
        eccentricity=widening * tilt / rise,
    )


def radius_range(cut: ConeCut, sweep: float, begin: float = 0.0) -> tuple[float, float]:
    """Smallest and largest signed radius along the section while phi runs from `begin` to `sweep`, mm.

    Exact: the radius is monotone in cos(phi - phase), whose extremes lie at the ends or where it is 1 or -1. Needs an
    elliptic section.
    """
    first, last = sorted((begin - cut.phase, sweep - cut.phase))
    cosines = [math.cos(first), math.cos(last)]
    cosines += [math.cos(k * math.pi) for k in range(math.ceil(first / math.pi), math.floor(last / math.pi) + 1)]
    radii = [cut.axis_radius / (1.0 + cut.eccentricity * cosine) for cosine in cosines]
    return min(radii), max(radii)


@dataclass(frozen=True, slots=True, kw_only=True)
class EllipticSection:
    """An arc of ellipse center + cos(w) * cosine_axis + sin(w) * sine_axis for w from start to stop, start < stop.

    The arc runs from ruling i to ruling i + 1, or to a side that stands in a plane. |cosine_axis| >= |sine_axis|, and
    the two are square to each other.

    Attributes:
        center: (3,) mm.
        cosine_axis: (3,) the major half axis, mm.
        sine_axis: (3,) the minor half axis, mm.
        start: parameter at ruling i, in [0, 2 pi).
        stop: parameter at ruling i + 1.
        eccentricity: signed, as in ConeCut.
        phase: sweep angle at parameter 0.
        sense: +1 where the sweep angle grows with the parameter, -1 where it falls.
        mean_height: height along the generatrix at a parameter w is mean_height - height_swing * cos(w), mm.
        height_swing: see mean_height.
    """

    center: Array
    cosine_axis: Array
    sine_axis: Array
    start: float
    stop: float
    eccentricity: float
    phase: float
    sense: int
    mean_height: float
    height_swing: float

    def points(self, parameters: Array) -> Array:
        """(m, 3) points at (m,) parameters, mm."""
        turned = np.outer(np.cos(parameters), self.cosine_axis) + np.outer(np.sin(parameters), self.sine_axis)
        return np.asarray(self.center + turned)

    def sweep_angles(self, parameters: Array) -> Array:
        """(m,) sweep angles phi of the generatrices through the points at (m,) parameters, up to whole turns."""
        beta = self.eccentricity / (1.0 + math.sqrt(1.0 - self.eccentricity**2))
        anomaly = parameters + 2.0 * np.arctan2(beta * np.sin(parameters), 1.0 - beta * np.cos(parameters))
        return np.asarray(self.phase + self.sense * anomaly)

    def heights(self, parameters: Array) -> Array:
        """(m,) heights along the generatrix, measured from the level of the ruling's point p, mm."""
        return self.mean_height - self.height_swing * np.cos(parameters)


def _eccentric_anomaly(true_anomaly: float, eccentricity: float) -> float:
    beta = eccentricity / (1.0 + math.sqrt(1.0 - eccentricity**2))
    return true_anomaly - 2.0 * math.atan2(beta * math.sin(true_anomaly), 1.0 + beta * math.cos(true_anomaly))


def elliptic_section(frame: AxisFrame, cut: ConeCut, span: tuple[float, float] | None = None) -> EllipticSection:
    """The arc of ellipse in which the cut plane meets the patch, or what of it lies between the angles of a span.

    With x towards the phase and y square to it, seen along the axis: x^2 + y^2 = (A - B x)^2, A the axis_radius and B
    the eccentricity, hence half axes A / (1 - B^2) and A / sqrt(1 - B^2) about x = -A B / (1 - B^2).

    Raises:
        ValueError: if the section is a parabola or hyperbola.
    """
    flatness = 1.0 - cut.eccentricity**2
    if not (flatness > 0.0 and math.isfinite(cut.axis_radius)):
        raise ValueError(f"the section is no ellipse: its eccentricity is {abs(cut.eccentricity):.6g}")
    toward, square = frame.radials(np.array([cut.phase, cut.phase + 0.5 * math.pi]))
    slope = cut.tilt / cut.rise
    in_plane = toward - slope * frame.axis
    shift = -cut.axis_radius * cut.eccentricity / flatness
    sense = 1 if frame.sweep > 0.0 else -1
    first, last = (0.0, frame.sweep) if span is None else span
    start = sense * _eccentric_anomaly(first - cut.phase, cut.eccentricity)
    stop = sense * _eccentric_anomaly(last - cut.phase, cut.eccentricity)
    whole_turns = 2.0 * math.pi * math.floor(start / (2.0 * math.pi))
    stretch = cut.axis_radius / flatness
    to_height = 1.0 / math.cos(frame.half_angle)
    return EllipticSection(
        center=frame.center + (cut.offset / cut.rise) * frame.axis + shift * in_plane,
        cosine_axis=stretch * in_plane,
        sine_axis=(sense * cut.axis_radius / math.sqrt(flatness)) * square,
        start=start - whole_turns,
        stop=stop - whole_turns,
        eccentricity=cut.eccentricity,
        phase=cut.phase,
        sense=sense,
        mean_height=to_height * (cut.offset / cut.rise - slope * shift),
        height_swing=to_height * slope * stretch,
    )


def chain_arcs(
    rulings: tuple[Array, Array, Array], patches: Sequence[Patch], cuts: tuple[Array, Array], spans: Array
) -> CurvePieces:
    """The arcs in which the planes that cut a chain's ends meet its round patches, patch by patch.

    Args:
        rulings: points, directions and normals (k + 1, 3).
        patches: the k patches.
        cuts: points and normals (e, 3).
        spans: (e, k, 2) between which angles the cuts run over the patches.

    Raises:
        ValueError: if a section is a parabola or hyperbola.
    """
    points, directions, normals = rulings
    frames = {
        index: axis_frame(points[index], directions[index], normals[index], patch)
        for index, patch in enumerate(patches)
        if isinstance(patch, ConePatch)
    }
    planes = list(zip(*cuts, spans.tolist(), strict=True))
    return as_pieces(
        [
            elliptic_section(frame, cut_cone(frame, point, normal), (own[index][0], own[index][1]))
            for index, frame in frames.items()
            for point, normal, own in planes
        ]
    )


def as_pieces(sections: Sequence[EllipticSection]) -> CurvePieces:
    """Arcs as one table."""
    return CurvePieces(
        centers=np.array([one.center for one in sections]).reshape(-1, 3),
        cosine_axes=np.array([one.cosine_axis for one in sections]).reshape(-1, 3),
        sine_axes=np.array([one.sine_axis for one in sections]).reshape(-1, 3),
        starts=np.array([one.start for one in sections], dtype=np.float64),
        stops=np.array([one.stop for one in sections], dtype=np.float64),
        arcs=np.ones(len(sections), dtype=bool),
    )
