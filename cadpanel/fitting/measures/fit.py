"""The measures, one definition for every report, test and benchmark; millimetres and radians.

- corner gap: distance between corresponding corners of the two panels at a seam (the paper's Table 1).
- seam gap: symmetric Hausdorff distance between the two edges along the whole seam, conic arcs included. Its parts:
  width in the skins' mean tangent plane and square to the seam, step along their mean normal, shift along the seam.
- kink: largest angle between the two skins' normals across a seam.
- deviation: distance of reference samples to their patch; the RMS is over the area, the maximum also over the outline.
- Hausdorff: the larger of the distances from the reference to the trimmed skin and back.
- outline drift: distance of a panel's free edges from the drawn ones, square to these.
- corner drift: distance of a panel's outer corner from its reference corner; split along and across the free edge.

All of them hang on the panels' shapes and on the reference alone, so that a delivery that was read back is measured by
the same code as a fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.fitting.measures.boundary import overhang
from cadpanel.fitting.measures.deviation import deviations, outline_distances
from cadpanel.fitting.measures.drift import drifts
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.free_outline import outline_drift
from cadpanel.fitting.measures.seams import AlongSeams, along_seams, corner_gaps
from cadpanel.fitting.measures.turns import edge_turns, off_level, seam_unevenness
from cadpanel.fitting.samples import SampleArrays
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference


@dataclass(frozen=True, slots=True)
class Measures:
    """What a fit is judged by.

    Attributes:
        corner_gaps: for each seam the gaps (corners,) at the corners that meet, in the order of its first panel, mm.
        seam_gap: (seams,) mm.
        seam_width, seam_step, seam_shift: (seams,) largest parts of the gap, see `seams.AlongSeams`, mm.
        kink: (seams,) radians.
        rms_deviation, max_deviation: (panels,) mm.
        overall_rms: over all panels, mm; every sample counts by its area.
        hausdorff: (panels,) mm.
        edge_turns: (panels, most edges) how far each end, and each edge on a seam, turns from the drawn one, radians.
        uneven: (seams,) how far the corners on a seam lie off the middle between those before and after it, against
            the drawing, mm.
        off_level: (panels,) of the place on a level seam that is farthest from its drawn plane, mm; nan where a panel
            has no such seam.
        seam_panels: (seams, 2) which panels meet there.
        drift: (panels,) of the outer corner that drifted most, mm.
        drift_along: (panels,) of the corner, inner ones included, that drifted most along the strip, mm; of a panel
            whose ends cannot be told from its sides the whole drift.
        drift_across: (panels,) of the outer corner that drifted most across its free edge, mm.
        outline_drift: (panels,) of the place on a free edge that is farthest from the drawn outline, mm.
        lengths: (panels,) the panels' lengths, mm.
        shapes: the panels that were measured, for those limits that hold what is to be seen of a panel alone.
    """

    corner_gaps: tuple[Array, ...]
    seam_gap: Array
    seam_width: Array
    seam_step: Array
    seam_shift: Array
    kink: Array
    rms_deviation: Array
    max_deviation: Array
    overall_rms: float
    hausdorff: Array
    edge_turns: Array
    uneven: Array
    off_level: Array
    seam_panels: IntArray
    drift: Array
    drift_along: Array
    drift_across: Array
    outline_drift: Array
    lengths: Array
    shapes: tuple[Panel, ...]

    def __repr__(self) -> str:
        return (
            f"<Measures of {len(self.drift)} panels and {len(self.seam_gap)} seams: gaps up to "
            f"{self.max_seam_gap:.2f} mm, deviations up to {self.max_deviation.max():.2f} mm>"
        )

    @property
    def widest_corners(self) -> Array:
        """(seams,) the largest corner gap of each seam, mm."""
        return np.array([gaps.max(initial=0.0) for gaps in self.corner_gaps])

    @property
    def turn(self) -> Array:
        """(panels,) of the end, or of the edge on a seam, that turns most from the drawn one, radians."""
        return np.asarray(self.edge_turns.max(axis=1))

    @property
    def gaps(self) -> dict[str, Array]:
        """(seams,) each of what can be held of gaps, see `FitSettings.gaps`, mm."""
        whole = np.maximum(self.widest_corners, self.seam_gap)
        return {"gap": whole, "width": self.seam_width, "step": self.seam_step, "shift": self.seam_shift}

    @property
    def max_corner_gap(self) -> float:
        """The largest corner gap, 0 without seams, mm."""
        return float(self.widest_corners.max(initial=0.0))

    @property
    def max_seam_gap(self) -> float:
        """The largest seam gap, 0 without seams, mm."""
        return float(self.seam_gap.max(initial=0.0))


def measure(
    shapes: Sequence[Panel],
    reference: Reference,
    *,
    edges: PanelEdges | None = None,
    met: AlongSeams | None = None,
) -> Measures:
    """Measure fitted panels against what they approximate; one shape a panel, in the reference's order.

    Args:
        shapes: the panels.
        reference: what they approximate.
        edges: of these shapes, where they are known already.
        met: what was measured along their seams, likewise.
    """
    samples = SampleArrays.of(reference)
    distance, weight = deviations(shapes, samples.points), samples.weights
    largest = _largest(shapes, reference, distance, weight)
    edges = PanelEdges.of(shapes) if edges is None else edges
    met = along_seams(edges, reference.seams) if met is None else met
    drifted = drifts(edges, reference)
    return Measures(
        corner_gaps=corner_gaps(edges, reference.seams),
        seam_gap=met.gap,
        seam_width=met.width,
        seam_step=met.step,
        seam_shift=met.shift,
        kink=met.kink,
        rms_deviation=np.sqrt(np.sum(weight * distance**2, axis=1) / weight.sum(axis=1)),
        max_deviation=largest,
        overall_rms=float(np.sqrt(np.sum(weight * distance**2) / weight.sum())),
        hausdorff=np.maximum(largest, overhang(edges, reference)),
        edge_turns=edge_turns(edges, reference),
        uneven=seam_unevenness(edges, reference),
        off_level=off_level(edges, reference),
        seam_panels=np.array([seam.panels for seam in reference.seams], dtype=np.intp).reshape(-1, 2),
        drift=drifted.whole,
        drift_along=drifted.along,
        drift_across=drifted.across,
        outline_drift=outline_drift(edges, reference),
        lengths=np.array([panel.length for panel in reference.panels]),
        shapes=tuple(shapes),
    )


def largest_deviations(shapes: Sequence[Panel], reference: Reference) -> Array:
    """(panels,) largest distance of samples and outlines to the patches, mm."""
    samples = SampleArrays.of(reference)
    return _largest(shapes, reference, deviations(shapes, samples.points), samples.weights)


def _largest(shapes: Sequence[Panel], reference: Reference, distance: Array, weight: Array) -> Array:
    sampled = np.max(np.abs(distance) * (weight > 0.0), axis=1)
    largest: Array = np.maximum(sampled, outline_distances(shapes, reference).max(axis=1))
    return largest
