"""All panels' samples in arrays of one shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.reference.model import Reference


@dataclass(frozen=True, slots=True)
class SampleArrays:
    """All panels' samples, padded to one length.

    Attributes:
        points, normals: (panels, m, 3), mm.
        weights: (panels, m) mm^2, 0 for padding.
    """

    points: Array
    normals: Array
    weights: Array

    @staticmethod
    def of(reference: Reference) -> SampleArrays:
        """Stack the panels of a reference."""
        panels = reference.panels
        most = max(len(panel.points) for panel in panels)
        points, normals = np.empty((len(panels), most, 3)), np.empty((len(panels), most, 3))
        weights = np.zeros((len(panels), most))
        for i, panel in enumerate(panels):
            own = len(panel.points)
            points[i, :own], normals[i, :own], weights[i, :own] = panel.points, panel.normals, panel.weights
            points[i, own:], normals[i, own:] = panel.points[0], panel.normals[0]
        return SampleArrays(points, normals, weights)

    def take(self, panels: IntArray) -> SampleArrays:
        """Those of some panels."""
        return SampleArrays(self.points[panels], self.normals[panels], self.weights[panels])
