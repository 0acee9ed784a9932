"""Every panel as a loft between its two ends, as developable as they allow: what `cadpanel loft` and DevLoft span."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.geometry.vectors import cross, dot, norm, unit
from cadpanel.lofting.loft import Loft, loft
from cadpanel.reference.model import Reference
from cadpanel.studies.baselines.baseline import Baseline, Outcome
from cadpanel.studies.baselines.strips import outcome_of

# Rulings of a piece, and places on each, from which the nearest to a point is looked for.
_RULINGS, _PLACES = 257, 65


@dataclass(frozen=True, slots=True)
class Lofted(Baseline):
    """Lofts. Neighbours share their end, so that there is no gap; what is paid is warp, which no flat sheet takes."""

    def run(self, reference: Reference) -> Outcome:
        """See `Baseline`."""
        strips = [Spanned.of(loft(*panel.ends, name=panel.name)) for panel in reference.panels]
        return outcome_of(strips, reference)


@dataclass(frozen=True, slots=True)
class Spanned:
    """A loft as `strips` asks for it.

    Attributes:
        warp: radians.
        places: (q, 3) points all over it, mm.
        tree: of these.
        normals: (q, 3) of length 1.
    """

    warp: float
    places: Array
    tree: cKDTree
    normals: Array

    @classmethod
    def of(cls, surface: Loft) -> Spanned:
        """Places along rulings of every piece, with the normals there: (1 - v) A' x r + v B' x r at the share v."""
        u, v = np.linspace(0.0, 1.0, _RULINGS), np.linspace(0.0, 1.0, _PLACES)[None, :, None]
        places, normals = [], []
        for piece in surface.pieces:
            a, b = piece.jets(u)
            ruling = b.point - a.point
            places.append((a.point[:, None] + v * ruling[:, None]).reshape(-1, 3))
            across = (1.0 - v) * cross(a.first, ruling)[:, None] + v * cross(b.first, ruling)[:, None]
            normals.append(unit(across).reshape(-1, 3))
        every = np.concatenate(places)
        return cls(surface.max_warp, every, cKDTree(every), np.concatenate(normals))

    def feet(self, points: Array) -> Array:
        """See `Strip`: in the tangent plane at the nearest place."""
        _, near = self.tree.query(points)
        normals = self.normals[near]
        foot = points - dot(points - self.places[near], normals)[:, None] * normals
        # Beyond its edge the surface ends.
        spacing = norm(foot - self.places[near]) > self._spacing
        return np.where(spacing[:, None], self.places[near], foot)

    @property
    def _spacing(self) -> float:
        """How far the nearest place may be from the foot of a point beside which the surface goes on, mm."""
        steps = self.places.reshape(-1, _RULINGS, _PLACES, 3)
        along, across = (norm(np.diff(steps, axis=axis)).max() for axis in (1, 2))
        return float(np.hypot(along, across))
