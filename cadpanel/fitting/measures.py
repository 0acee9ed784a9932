"""The measures, one definition for every report, test and benchmark; millimetres and radians.

- corner gap: distance between corresponding corners of the two panels at a seam (the paper's Table 1).
- seam gap: symmetric Hausdorff distance between the two end curves along the whole seam, conic arcs included.
- kink: largest angle between the two skins' normals across a seam.
- deviation: distance of reference samples to their patch; the RMS is over the area, the maximum also over the outline.
- Hausdorff: the larger of the distances from the reference to the trimmed skin and back.
- corner drift: distance of a panel's outer corner from its reference corner; split along and across the free edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.fitting.problem import Problem
from cadpanel.fitting.shapes import end_curves
from cadpanel.geometry.seam import EndCurves, closest, seam_gap
from cadpanel.reference.model import Reference
from cadpanel.terms.deviation import Deviation
from cadpanel.terms.state import State

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Measures:
    """What a fit is judged by.

    Attributes:
        corner_gaps: (seams, corners) mm.
        seam_gap: (seams,) mm.
        kink: (seams,) radians.
        rms_deviation, max_deviation: (panels,) mm.
        overall_rms: over all panels, mm; every sample counts by its area.
        hausdorff: (panels,) mm.
        drift: (panels, 2, 2) mm, [end, side].
        drift_along: (panels, 2, k + 1) mm, at all corners.
        drift_across: (panels, 2, 2) mm, across the free edges.
        lengths: (panels,) the panels' lengths, mm.
    """

    corner_gaps: Array
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

    @property
    def max_corner_gap(self) -> float:
        """The largest corner gap, 0 without seams, mm."""
        return float(self.corner_gaps.max(initial=0.0))

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
    outline = _outline_distances(problem, reference, state)
    largest = np.maximum(np.max(np.abs(distance) * (weight > 0.0), axis=1), outline.max(axis=1))
    drift = problem.outline.drift(state) * length
    along = np.einsum("pesx,pesx->pes", drift, problem.outline.gauge)
    across = np.linalg.norm(drift - along[..., None] * problem.outline.along, axis=-1)
    gaps = np.linalg.norm(problem.corner_gap(1.0).vectors(state), axis=-1) * length
    first, second = _seam_ends(problem, state)
    hausdorff, kink = seam_gap(first, second) if len(gaps) else (np.zeros(0), np.zeros(0))
    return Measures(
        corner_gaps=gaps,
        seam_gap=hausdorff,
        kink=kink,
        rms_deviation=rms,
        max_deviation=largest,
        overall_rms=float(np.sqrt(np.sum(weight * distance**2) / weight.sum())),
        hausdorff=np.maximum(largest, _overhang(problem, reference, state)),
        drift=np.linalg.norm(drift[:, :, [0, -1]], axis=-1),
        drift_along=np.abs(along),
        drift_across=across[:, :, [0, -1]],
        lengths=problem.lengths * length,
    )


def seam_gaps(problem: Problem, state: State) -> Array:
    """(seams,) the seam gaps of the panels in a state, mm."""
    if not len(problem.seams.panels):
        return np.zeros(0)
    return seam_gap(*_seam_ends(problem, state))[0]


def _seam_ends(problem: Problem, state: State) -> tuple[EndCurves, EndCurves]:
    """The two end curves of every seam, (seams,) each."""
    both = [end_curves(problem, state.walked, state.corners.position, end) for end in (0, 1)]

    def side(which: int) -> EndCurves:
        panels, ends = problem.seams.panels[:, which], problem.seams.ends[:, which]
        picked = [curves.take(panels) for curves in both]
        return EndCurves(
            *(
                np.where(
                    ends.reshape(-1, *(1,) * (getattr(picked[0], f).ndim - 1)) == 0, *(getattr(c, f) for c in picked)
                )
                for f in EndCurves.__slots__
            )
        )

    return side(0), side(1)


def _outlines(problem: Problem, reference: Reference) -> Array:
    """(panels, q, 3) points all around every reference outline, in the panels' own frames and the solver's length."""
    count = max(len(line) for panel in reference.panels for line in (*panel.ends, *panel.sides))
    lines = np.array(
        [np.concatenate([_resample(line, count) for line in (*p.ends, *p.sides)]) for p in reference.panels]
    )
    origins = problem.place.origins + problem.place.centre
    local: Array = np.einsum("pqx,pxa->pqa", lines - origins[:, None], problem.place.axes) / problem.place.length
    return local


def _resample(line: Array, count: int) -> Array:
    # Repeating points is enough to bring all polylines to one length.
    return line[np.round(np.linspace(0, len(line) - 1, count)).astype(np.intp)]


def _outline_distances(problem: Problem, reference: Reference, state: State) -> Array:
    """(panels, q) distance of the reference's outline to the skin's patches, mm."""
    points = np.ascontiguousarray(np.moveaxis(_outlines(problem, reference), 2, 0))
    distance, _ = Deviation(points, np.ones(points.shape[1:])).distances(state.walked)
    return np.abs(distance) * problem.place.length


def _overhang(problem: Problem, reference: Reference, state: State) -> Array:
    """(panels,) how far the skin's and the reference's boundaries reach beyond each other, mm.

    Inside both outlines the two surfaces are apart by the deviation; what the Hausdorff distance adds happens at the
    boundaries: each point of one to the nearest of the other.
    """
    length = problem.place.length
    outline = _outlines(problem, reference) * length
    result = np.zeros(problem.panels)
    corners = state.corners.position * length
    for end in (0, 1):
        curves = end_curves(problem, state.walked, state.corners.position, end)
        stations = curves.stations()
        world, _ = curves.follow(np.broadcast_to(stations, (problem.panels, len(stations))))
        local = np.einsum("pqx,pxa->pqa", world - problem.place.origins[:, None], problem.place.axes)
        quarter = outline.shape[1] // 4
        reference_end = outline[:, end * quarter : (end + 1) * quarter]
        result = np.maximum(result, _polyline_distance(local, reference_end).max(axis=1))
        there, _ = closest(curves, _to_world(problem, reference_end))
        result = np.maximum(result, there.max(axis=1))
    for side in (0, 1):
        edge = corners[:, :, -side][:, :, None] if side else corners[:, :, 0][:, :, None]
        edge = np.concatenate([edge[:, 0], edge[:, 1]], axis=1)
        quarter = outline.shape[1] // 4
        reference_side = outline[:, (2 + side) * quarter : (3 + side) * quarter]
        result = np.maximum(result, _polyline_distance(edge, reference_side).max(axis=1))
        result = np.maximum(result, _polyline_distance(reference_side, edge).max(axis=1))
    return result


def _to_world(problem: Problem, points: Array) -> Array:
    world: Array = np.einsum("pqa,pxa->pqx", points, problem.place.axes) + problem.place.origins[:, None]
    return world


def _polyline_distance(points: Array, line: Array) -> Array:
    """(panels, q) distance of points (panels, q, 3) to polylines (panels, r, 3)."""
    start, step = line[:, None, :-1], (line[:, 1:] - line[:, :-1])[:, None]
    square = np.maximum(np.sum(step**2, axis=-1), np.finfo(float).tiny)
    share = np.clip(np.sum((points[:, :, None] - start) * step, axis=-1) / square, 0.0, 1.0)
    foot = start + share[..., None] * step
    nearest: Array = np.sqrt(np.min(np.sum((points[:, :, None] - foot) ** 2, axis=-1), axis=2))
    return nearest
