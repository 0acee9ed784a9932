"""Which way is along the strip at chains' corners, and how far out of their references' ends corners are that way.

At the four outer corners drift counts from the outline's own corner. Inside the fold a panel has corners too, where its
flanges begin. Where across the fold they lie is a matter of the fit, but along the strip they belong on the reference's
end like the outer ones. How far they are from it is told in the direction of the strip, so that a corner may slide
along an end that runs askew.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.vectors import cross, dot, unit
from cadpanel.reference.model import PanelReference

# An end that is nearly straight does not tell its plane's tilt: singular values below this share are left out.
_LEAST_SINGULAR = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Strips:
    """m panels with four edges as the corners of k patches see them; [panel, end, ruling].

    Attributes:
        ends: 2 m polylines (q, 3), end 0 and end 1 of each panel.
        corners: (m, 2, 2, 3) of the references, mm.
        direction: (m, 2, k + 1, 3) unit vectors along the strip, from chord to chord.
        gauge: (m, 2, k + 1, 3) whose inner product with a drift is the drift along the strip: the direction itself at
            the outer corners, at the inner ones the normal m of the end's plane over m . direction.
    """

    ends: tuple[Array, ...]
    corners: Array
    direction: Array
    gauge: Array

    def outer_drift(self, corners: Array) -> Array:
        """(m, 2, 2, 3) from the references' corners to the outer ones of corners (m, 2, k + 1, 3), mm."""
        drift: Array = corners[:, :, [0, -1]] - self.corners
        return drift

    def along(self, corners: Array) -> Array:
        """(m, 2, k + 1) how far corners (m, 2, k + 1, 3) drifted along the strip, whichever way, mm.

        An inner corner has drifted by what it is beyond all points of its end: an end need not lie in one plane.
        """
        found = np.zeros(corners.shape[:3])
        found[..., [0, -1]] = np.abs(dot(self.gauge[:, :, [0, -1]], self.outer_drift(corners)))
        of_ends = (2 * len(corners), corners.shape[2], 3)
        inner, gauge = corners.reshape(of_ends)[:, 1:-1], self.gauge.reshape(of_ends)[:, 1:-1]
        beyond = found.reshape(of_ends[:2])[:, 1:-1]
        for which, lines in _by_count(self.ends):
            # Counted from a corner of the end: map-grid coordinates would cost digits.
            origin = lines[:, :1]
            heights = gauge[which] @ np.swapaxes(lines - origin, 1, 2)
            own = dot(gauge[which], inner[which] - origin)
            beyond[which] = np.maximum(np.maximum(own - heights.max(axis=2), heights.min(axis=2) - own), 0.0)
        return found


def strips_of(panels: Sequence[PanelReference], rulings: int) -> Strips:
    """Panels with four edges as the corners of chains with so many rulings see them."""
    outer = np.array([panel.corners for panel in panels])
    ends = tuple(end for panel in panels for end in panel.ends)
    chords = unit(outer[:, 1] - outer[:, 0])
    share = np.linspace(0.0, 1.0, rulings)[:, None]
    way = unit((1.0 - share) * chords[:, None, 0] + share * chords[:, None, 1])
    direction = np.repeat(way[:, None], 2, axis=1)
    gauge = direction.copy()
    if rulings > 2:
        axes = _axes(panels, chords)
        lengths = [panel.length for panel in panels]
        local = [(end - end.mean(axis=0)) @ axes[i // 2] / lengths[i // 2] for i, end in enumerate(ends)]
        _, normals = end_planes(local, tilt=True)
        m = np.einsum("pxa,pea->pex", axes, normals.reshape(len(panels), 2, 3))[:, :, None]
        gauge[:, :, 1:-1] = m / dot(m, direction[:, :, 1:-1])[..., None]
    return Strips(ends=ends, corners=outer, direction=direction, gauge=gauge)


def _axes(panels: Sequence[PanelReference], chords: Array) -> Array:
    """(m, 3, 3) columns b, t, n: across each panel, along it, outwards; its sides' chords are (m, 2, 3)."""
    t = unit(chords.sum(axis=1))
    outwards = np.array([panel.weights @ panel.normals for panel in panels])
    n = unit(outwards - dot(outwards, t)[:, None] * t)
    return np.stack([cross(t, n), t, n], axis=2)


def end_planes(lines: Sequence[Array], *, tilt: bool) -> tuple[Array, Array]:
    """The planes m . x = position through ends by least squares: positions (e,), and m = (skew, 1, tilt) (e, 3).

    Each line (q, 3) runs along an end, in the axes b, t, n of a panel; the tilt is 0 unless it is wanted.
    """
    positions, normals = np.empty(len(lines)), np.tile([0.0, 1.0, 0.0], (len(lines), 1))
    columns = [0, 2] if tilt else [0]
    for which, points in _by_count(lines):
        matrix = np.concatenate([np.ones((*points.shape[:2], 1)), -points[..., columns]], axis=2)
        left, singular, right = np.linalg.svd(matrix, full_matrices=False)
        told = np.einsum("eqs,eq->es", left, points[..., 1])
        kept = singular > _LEAST_SINGULAR * singular[:, :1]
        solution = np.einsum("es,esc->ec", np.where(kept, told / np.where(kept, singular, 1.0), 0.0), right)
        positions[which] = solution[:, 0]
        for place, column in enumerate(columns):
            normals[which, column] = solution[:, 1 + place]
    return positions, normals


def _by_count(lines: Sequence[Array]) -> Iterator[tuple[IntArray, Array]]:
    """Which lines have as many points as each other, and these (e, q, 3)."""
    counts = np.array([len(line) for line in lines])
    for count in np.unique(counts).tolist():
        which = np.flatnonzero(counts == count)
        yield which, np.array([lines[i] for i in which.tolist()])
