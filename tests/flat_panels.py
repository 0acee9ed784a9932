"""Panels of every feature to be unrolled, and the way back from the plane."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.flat_curves import FlatCurves
from cadpanel.geometry.panel import Panel
from tests.chains import FEATURES, made_problem, random_unknowns


def panels(name: str, seed: int) -> tuple[Panel, ...]:
    """Panels of a feature, about 2 m long."""
    of = FEATURES[name]
    problem = made_problem(of, seed)
    return panel_shapes(problem, random_unknowns(of, seed, problem.panels))


def heights_and_angles(curves: FlatCurves, row: int, points: Array) -> tuple[Array, Array]:
    """Height along the generatrix and sweep angle of points (q, 2) on a rolled out cone patch."""
    along = curves.along[row]
    to = points - curves.origin[row]
    x, y = to @ np.array([along[1], -along[0]]), to @ along
    k, rho = curves.sine[row], curves.level_radius[row]
    side = np.sign(rho)
    reach = side * np.hypot(k * y + rho, k * x)
    angle = np.arctan2(side * k * x, side * (k * y + rho))
    ratio = x / (k * y + rho)
    phi = angle / k if abs(k) > 1e-6 else ratio * (1.0 - (k * ratio) ** 2 / 3.0)
    return (2.0 * rho * y + k * (x**2 + y**2)) / (reach + rho), phi


def folded(shape: Panel, curves: FlatCurves, row: int, patch: int, points: Array) -> Array:
    """Points (q, 2) of a cone patch in the plane back on the panel's skin, (q, 3)."""
    p, t, n = (of[patch] for of in shape.rulings())
    height, phi = heights_and_angles(curves, row, points)
    k, rho = curves.sine[row], curves.level_radius[row]
    cosine = np.sqrt(1.0 - k**2)
    radial, axis = cosine * n + k * t, cosine * t - k * n
    turned = np.cos(phi)[:, None] * radial + np.sin(phi)[:, None] * np.cross(axis, radial)
    return np.asarray(p - rho * radial + rho * turned + height[:, None] * (cosine * axis + k * turned))
