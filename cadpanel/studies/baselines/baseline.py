"""What every way to approximate panels takes and gives."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from cadpanel.fitting.measures.fit import Measures
from cadpanel.reference.model import Reference


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What came of a reference, in the measures of `fitting.measures.fit`.

    Attributes:
        panels: how many.
        rms: deviation over all panels, by area, mm.
        largest: deviation of samples and outlines, mm.
        corner_gap: the widest between corners that meet, mm.
        seam_gap: the widest along a seam, mm.
        drift: the farthest that a corner lies from the drawn one, mm.
        turn: the largest angle of an end with the drawn one, degrees.
        warp: the largest angle between the tangent planes at both ends of a ruling, degrees; 0 of what can be rolled
            from flat sheet.
    """

    panels: int
    rms: float
    largest: float
    corner_gap: float
    seam_gap: float
    drift: float
    turn: float
    warp: float = 0.0

    @classmethod
    def of(cls, measures: Measures) -> Outcome:
        """That of panels of planes, cylinders and cones."""
        return cls(
            panels=len(measures.drift),
            rms=measures.overall_rms,
            largest=float(measures.max_deviation.max()),
            corner_gap=measures.max_corner_gap,
            seam_gap=measures.max_seam_gap,
            drift=float(measures.drift.max()),
            turn=float(np.degrees(measures.turn.max())),
        )


class Baseline(ABC):
    """A way to approximate the panels of a reference.

    One more is a class with `run`, in a file of its own, and a line in the catalogue.
    """

    @abstractmethod
    def run(self, reference: Reference) -> Outcome:
        """Approximate all panels, and measure what came of it.

        Raises:
            CadpanelError: a panel is not what this way is made for; the sentence names it.
        """
