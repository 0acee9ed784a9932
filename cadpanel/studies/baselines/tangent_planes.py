"""Every panel as a developable B-spline strip through its tangent planes (Pottmann and Wallner)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.start.cone_strips import strips_of
from cadpanel.lofting.tangent_planes import PlaneCurve
from cadpanel.reference.model import Reference
from cadpanel.studies.baselines.baseline import Baseline, Outcome
from cadpanel.studies.baselines.strips import outcome_of


@dataclass(frozen=True, slots=True)
class TangentPlanes(Baseline):
    """Developable strips, every panel's by itself."""

    def run(self, reference: Reference) -> Outcome:
        """See `Baseline`."""
        return outcome_of([_Envelope(curve) for _, curve in strips_of(reference)], reference)


@dataclass(frozen=True, slots=True)
class _Envelope:
    """The strip as `strips` asks for it."""

    curve: PlaneCurve

    @property
    def warp(self) -> float:
        """None: it is developable."""
        return 0.0

    def feet(self, points: Array) -> Array:
        """See `Strip`."""
        s, far = self.curve.feet(points)
        return np.asarray(points - far[:, None] * self.curve.planes(s)[:, :3])
