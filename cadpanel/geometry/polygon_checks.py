"""Can a shop cut this polygon from flat sheet? Refuses with the panel's name and one clear reason."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.limits import LARGEST_COORDINATE, SMALLEST_LENGTH
from cadpanel.geometry.panel import Outlined
from cadpanel.geometry.vectors import cross

FLATNESS = 1e-7
"""Farthest corner from the plane, mm."""


def polygon_area(shape: Outlined) -> float:
    """Area inside the outline, mm2; negative where it runs clockwise about the normal."""
    corners = shape.outline - shape.outline[0]
    return 0.5 * float(cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0) @ shape.normal)


def check_polygon(shape: Outlined) -> None:
    """Refuse a polygon that cannot be built exactly.

    Raises:
        PanelError: with one reason: not finite, not flat, too far out, an edge too short, turned inside out, or edges
            that cross.
    """
    corners, name = shape.outline, shape.name
    if not (np.isfinite(corners).all() and np.isfinite(shape.normal).all()):
        raise PanelError(name, "some of its numbers are not finite; fit it again from another start.")
    if np.abs(corners).max() > LARGEST_COORDINATE:
        raise PanelError(
            name,
            f"a corner lies {np.abs(corners).max():.4g} mm from the origin, beyond {LARGEST_COORDINATE:g} mm; "
            "move the model to a local origin.",
        )
    off = float(np.abs((corners - corners.mean(axis=0)) @ shape.normal).max())
    if off > FLATNESS:
        raise PanelError(name, f"its corners are {off:.3g} mm off their plane; fit it as a planar polygon first.")
    lengths = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    if lengths.min() < SMALLEST_LENGTH:
        raise PanelError(
            name,
            f"edge {int(lengths.argmin())} is only {lengths.min():.3g} mm long, {SMALLEST_LENGTH:g} are needed; merge "
            "its two corners.",
        )
    if polygon_area(shape) <= 0.0 or _crosses(shape):
        raise PanelError(name, "its outline crosses itself or is turned inside out; anchor its corners more strongly.")


def _crosses(shape: Outlined) -> bool:
    """Whether two edges that are not neighbours meet."""
    start = shape.outline
    stop = np.roll(start, -1, axis=0)

    def sides(others: Array) -> Array:
        """(n, n) on which side of edge i, seen along the normal, point j lies."""
        spans = (stop - start)[:, None, :]
        return np.asarray(cross(spans, others[None, :, :] - start[:, None, :]) @ shape.normal)

    splits = sides(start) * sides(stop) <= 0.0
    index = np.arange(len(start))
    apart = np.abs(index[:, None] - index[None, :])
    strangers = (apart > 1) & (apart < len(start) - 1)
    return bool((splits & splits.T & strangers).any())
