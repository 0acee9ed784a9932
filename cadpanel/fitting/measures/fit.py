"""The measures, one definition for every report, test and benchmark; millimetres and radians.

- corner gap: distance between corresponding corners of the two panels at a seam (the paper's Table 1).
- seam gap: symmetric Hausdorff distance between the two edges along the whole seam, conic arcs included.
- kink: largest angle between the two skins' normals across a seam.
- deviation: distance of reference samples to their patch; the RMS is over the area, the maximum also over the outline.
- Hausdorff: the larger of the distances from the reference to the trimmed skin and back.
- corner drift: distance of a panel's outer corner from its reference corner; split along and across the free edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.measures.boundary import outline_distances, overhang
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.shapes import edge_curves, panel_shapes
from cadpanel.geometry.end_curves import EndCurves, seam_gap
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference
from cadpanel.terms.seams import SeamBatch
from cadpanel.terms.state import State


@dataclass(frozen=True, slots=True)
class Measures:
    """What a fit is judged by.

    Attributes:
        corner_gaps: for each seam the gaps (corners,) at the corners that meet, in the order of its first panel, mm.
        seam_gap: (seams,) mm.
        kink: (seams,) radians.
        rms_deviation, max_deviation: (panels,) mm.
        overall_rms: over all panels, mm; every sample counts by its area.
        hausdorff: (panels,) mm.
        drift: (panels,) of the outer corner that drifted most, mm.
        drift_along: (panels,) of the corner, inner ones included, that drifted most along the strip, mm; of a panel
            whose ends cannot be told from its sides the whole drift.
        drift_across: (panels,) of the outer corner that drifted most across its free edge, mm.
        lengths: (panels,) the panels' lengths, mm.
        shapes: the panels that were measured, for those limits that hold what is to be seen of a panel alone.
    """

    corner_gaps: tuple[Array, ...]
    seam_gap: Array
    kink: Array
    rms_deviation: Array
    max_deviation: Array
    overall_rms: float
    hausdorff: Array
    drift: Array
    drift_along: Array
    drift_across: Array
    lengths: Array
    shapes: tuple[Panel, ...]

    @property
    def widest_corners(self) -> Array:
        """(seams,) the largest corner gap of each seam, mm."""
        return np.array([gaps.max(initial=0.0) for gaps in self.corner_gaps])

    @property
    def max_corner_gap(self) -> float:
        """The largest corner gap, 0 without seams, mm."""
        return float(self.widest_corners.max(initial=0.0))

    @property
    def max_seam_gap(self) -> float:
        """The largest seam gap, 0 without seams, mm."""
        return float(self.seam_gap.max(initial=0.0))


def measure(problem: Problem, reference: Reference, unknowns: Array) -> Measures:
    """Measure the panels at the unknowns."""
    state = problem.state(unknowns)
    length = problem.place.length
    rms, distance = problem.deviations(unknowns)
    weight = problem.deviation.roots**2
    largest = _largest(problem, reference, state, distance)
    hausdorff, kink = _along_seams(problem, state)
    drift, along, across = _drifts(problem, state)
    return Measures(
        corner_gaps=_corner_gaps(problem, state),
        seam_gap=hausdorff,
        kink=kink,
        rms_deviation=rms,
        max_deviation=largest,
        overall_rms=float(np.sqrt(np.sum(weight * distance**2) / weight.sum())),
        hausdorff=np.maximum(largest, overhang(problem, reference, state)),
        drift=drift,
        drift_along=along,
        drift_across=across,
        lengths=problem.lengths * length,
        shapes=panel_shapes(problem, reference, unknowns),
    )


def largest_deviations(problem: Problem, reference: Reference, unknowns: Array) -> Array:
    """(panels,) largest distance of samples and outlines to the patches, mm."""
    return _largest(problem, reference, problem.state(unknowns), problem.deviations(unknowns)[1])


def _largest(problem: Problem, reference: Reference, state: State, distance: Array) -> Array:
    sampled = np.max(np.abs(distance) * (problem.deviation.roots > 0.0), axis=1)
    largest: Array = np.maximum(sampled, outline_distances(problem, reference, state).max(axis=1))
    return largest


def seam_gaps(problem: Problem, state: State) -> Array:
    """(seams,) the seam gaps of the panels in a state, mm."""
    return _along_seams(problem, state)[0]


def _along_seams(problem: Problem, state: State) -> tuple[Array, Array]:
    """(seams,) seam gaps in mm, and kinks in radians."""
    gaps, kinks = np.zeros(problem.seam_count), np.zeros(problem.seam_count)
    for batch in problem.seams:
        first, second = (_edges(problem, state, batch, side) for side in (0, 1))
        gaps[batch.index], kinks[batch.index] = seam_gap(first, second)
    return gaps, kinks


def _edges(problem: Problem, state: State, batch: SeamBatch, side: int) -> EndCurves:
    return edge_curves(problem, state, batch.panels[:, side], batch.edges[:, side], straight=batch.straight(side))


def _corner_gaps(problem: Problem, state: State) -> tuple[Array, ...]:
    gaps: list[Array] = [np.zeros(0)] * problem.seam_count
    for term in problem.corner_gaps(1.0):
        found = np.linalg.norm(term.vectors(state), axis=-1) * problem.place.length
        for index, row in zip(term.seams.index.tolist(), found, strict=True):
            gaps[index] = row
    return tuple(gaps)


def _drifts(problem: Problem, state: State) -> tuple[Array, Array, Array]:
    """(panels,) whole drift of outer corners, drift along, and drift across free edges, mm."""
    outline = problem.outline
    rows = np.arange(problem.panels)[:, None]
    drift = outline.drift(state) * problem.place.length
    outer = np.linalg.norm(drift[rows, outline.across.corners], axis=-1)
    whole = np.max(outer * (np.abs(outline.across.part).max(axis=(2, 3)) > 0.0), axis=1)
    along, across = (
        np.linalg.norm((one.part @ drift[rows, one.corners][..., None])[..., 0], axis=-1).max(axis=1, initial=0.0)
        for one in (outline.along, outline.across)
    )
    return whole, np.where(outline.sided, along, whole), np.where(outline.sided, across, 0.0)
