"""Closest points of one curve at a time, as the measures find them for many. Millimetres."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.closest_points import closest_points, stations
from cadpanel.geometry.end_curves import EndCurves, as_chains


def closest(curves: EndCurves, points: Array) -> tuple[Array, Array]:
    """Distance (s, q) of each point (s, q, 3) to its curve, and the parameter (s, q) of the closest point."""
    origin = curves.corners[:, 0]
    count, each, _ = points.shape
    flat = np.moveaxis(points - origin[:, None], 2, 0).reshape(3, -1)
    on = stations(as_chains(curves, origin))
    column, share, distance = closest_points(on, np.repeat(np.arange(count), each), flat)
    return distance.reshape(count, each), (column % curves.patches + share).reshape(count, each)
