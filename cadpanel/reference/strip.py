"""Which way is along the strip at a chain's corners, and how far out of a reference's ends corners are that way.

At the four outer corners drift counts from the outline's own corner. Inside the fold a panel has corners too, where its
flanges begin. Where across the fold they lie is a matter of the fit, but along the strip they belong on the reference's
end like the outer ones. How far they are from it is told in the direction of the strip, so that a corner may slide
along an end that runs askew.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, dot, unit
from cadpanel.reference.model import PanelReference

# An end that is nearly straight does not tell its plane's tilt: singular values below this share are left out.
_LEAST_SINGULAR = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Strip:
    """One panel with four edges as the corners of k patches see it; [end, ruling].

    Attributes:
        panel: whose.
        direction: (2, k + 1, 3) unit vectors along the strip, from chord to chord.
        gauge: (2, k + 1, 3) whose inner product with a drift is the drift along the strip: the direction itself at the
            outer corners, at the inner ones the normal m of the end's plane over m . direction.
    """

    panel: PanelReference
    direction: Array
    gauge: Array

    def outer_drift(self, corners: Array) -> Array:
        """(2, 2, 3) from the reference's corners to the outer ones of corners (2, k + 1, 3), mm."""
        drift: Array = corners[:, [0, -1]] - self.panel.corners
        return drift

    def along(self, corners: Array) -> Array:
        """(2, k + 1) how far corners (2, k + 1, 3) drifted along the strip, whichever way, mm.

        An inner corner has drifted by what it is beyond all points of its end: an end need not lie in one plane.
        """
        found = np.zeros(corners.shape[:2])
        found[:, [0, -1]] = np.abs(dot(self.gauge[:, [0, -1]], self.outer_drift(corners)))
        for end, line in enumerate(self.panel.ends):
            inner = self.gauge[end, 1:-1]
            # Counted from a corner of the end: map-grid coordinates would cost digits.
            heights, own = inner @ (line - line[0]).T, dot(inner, corners[end, 1:-1] - line[0])
            found[end, 1:-1] = np.maximum(np.maximum(own - heights.max(axis=1), heights.min(axis=1) - own), 0.0)
        return found


def strip_of(panel: PanelReference, rulings: int) -> Strip:
    """A panel with four edges as the corners of a chain with so many rulings see it."""
    outer = panel.corners
    chords = unit(outer[1] - outer[0])
    share = np.linspace(0.0, 1.0, rulings)[:, None]
    direction = np.broadcast_to(unit((1.0 - share) * chords[0] + share * chords[1]), (2, rulings, 3))
    gauge = direction.copy()
    axes = _axes(panel, chords)
    for end, line in enumerate(panel.ends):
        _, normal = end_plane((line - line.mean(axis=0)) @ axes / panel.length, tilt=True)
        m = np.broadcast_to(axes @ normal, (rulings - 2, 3))
        gauge[end, 1:-1] = m / dot(m, direction[end, 1:-1])[:, None]
    return Strip(panel=panel, direction=direction, gauge=gauge)


def _axes(panel: PanelReference, chords: Array) -> Array:
    """(3, 3) columns b, t, n: across the panel, along it, outwards."""
    t = unit(chords.sum(axis=0))
    outwards = panel.weights @ panel.normals
    n = unit(outwards - (outwards @ t) * t)
    return np.column_stack([cross(t, n), t, n])


def end_plane(line: Array, *, tilt: bool) -> tuple[float, Array]:
    """The plane m . x = position through an end by least squares, m = (skew, 1, tilt), tilt 0 unless it is wanted.

    `line` (q, 3) runs along the end, in the axes b, t, n of a panel.
    """
    columns = [0, 2] if tilt else [0]
    matrix = np.column_stack([np.ones(len(line)), -line[:, columns]])
    solution = np.linalg.lstsq(matrix, line[:, 1], rcond=_LEAST_SINGULAR)[0]
    return float(solution[0]), np.array([solution[1], 1.0, solution[2] if tilt else 0.0])
