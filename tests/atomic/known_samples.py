"""Samples of planes, cylinders and cones whose numbers are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Known:
    """Samples (m, 3) and outward normals of a cone about `axis` through `centre`, and what was sampled.

    Attributes:
        points: (m, 3) mm, with the noise.
        normals: (m, 3) of the surface, away from the axis.
        noise: (m,) how far along the normal each sample was moved, mm.
        axis: (3,) from the apex to the samples.
        apex: (3,) or None for the cylinder.
        radius: normal radius in the middle of the samples' range along the generatrix, mm.
        half_angle: radians.
    """

    points: Array
    normals: Array
    noise: Array
    axis: Array
    apex: Array | None
    radius: float
    half_angle: float


def rotation(random: np.random.Generator) -> Array:
    """Any rotation."""
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn[:, 0] *= np.linalg.det(turn)
    return turn


def known_cone(
    random: np.random.Generator,
    *,
    radius: float,
    half_angle: float = 0.0,
    arc: float,
    length: float,
    count: int = 60,
    noise: float = 0.0,
) -> Known:
    """Samples of an arc (radians) of a cone, `length` along the generatrices; half angle 0 is the cylinder.

    The samples are made about the ruling's point, not about the far axis, so that a large radius costs no digits.
    """
    angle = random.uniform(-0.5, 0.5, count) * arc
    along = random.uniform(-0.5, 0.5, count) * length
    cosine, sine = np.cos(half_angle), np.sin(half_angle)
    rho = cosine * radius + along * sine
    x, y = rho * -2.0 * np.sin(0.5 * angle) ** 2 + along * sine, rho * np.sin(angle)
    normals = np.stack([cosine * np.cos(angle), cosine * np.sin(angle), np.full(count, -sine)], axis=-1)
    moved_by = noise * random.normal(size=count)
    points = np.stack([x, y, along * cosine], axis=-1) + moved_by[:, None] * normals
    turn, offset = rotation(random), length * random.normal(size=3)
    axis_point = np.array([-cosine * radius, 0.0, 0.0])
    apex = (
        None if half_angle == 0.0 else (axis_point - [0.0, 0.0, cosine * radius / np.tan(half_angle)]) @ turn.T + offset
    )
    return Known(
        points=points @ turn.T + offset,
        normals=normals @ turn.T,
        noise=moved_by,
        axis=turn[:, 2],
        apex=apex,
        radius=radius,
        half_angle=half_angle,
    )


def between(first: Array, second: Array) -> float:
    """Angle between two lines, radians."""
    return float(np.arctan2(np.linalg.norm(np.cross(first, second)), abs(first @ second)))
