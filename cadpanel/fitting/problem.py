"""A fit as the solver sees it: panels in their own frames, terms, and which panels are coupled."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.feature import Feature
from cadpanel.features.walk import pierce, walk
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.start import SampleArrays, Start, end_plane
from cadpanel.reference.model import Reference
from cadpanel.solver.blocks import BlockPattern, Normal
from cadpanel.solver.levenberg_marquardt import Bounds
from cadpanel.terms.arc import ArcGap
from cadpanel.terms.deviation import Deviation, assign, skin_normals
from cadpanel.terms.drift import DriftLimit, Outline
from cadpanel.terms.gap import CornerGap, Placement, Seams
from cadpanel.terms.rows import Term
from cadpanel.terms.state import State

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]


@dataclass(frozen=True)
class Problem:
    """Everything that stays the same while one feature is fitted to one reference.

    Attributes:
        feature: the feature of all panels.
        place: the panels' own frames.
        deviation: the regression term.
        outline: the reference's corners.
        lengths: (panels,) the panels' lengths in units of the solver's length.
        seams: who meets whom.
        pairs: (pairs, 2) coupled panels.
    """

    feature: Feature
    place: Placement
    deviation: Deviation
    outline: Outline
    lengths: Array
    seams: Seams
    pairs: IntArray

    @property
    def panels(self) -> int:
        """Number of panels."""
        return len(self.place.origins)

    def state(self, unknowns: Array, *, derivatives: bool = False) -> State:
        """Walk the panels at the unknowns (panels, free)."""
        return State(walk(self.feature, self.feature.expand(unknowns), derivatives=derivatives))

    def corner_gap(self, tolerance: float) -> CornerGap:
        """Corners of neighbours held within `tolerance` mm."""
        corners = len(self.feature.patches) + 1
        return CornerGap(self.seams, self.place, corners=corners, tolerance=tolerance / self.place.length)

    def arc_gap(self, tolerance: float) -> ArcGap:
        """Conic arcs of neighbours held within `tolerance` mm."""
        curved = tuple(i for i, patch in enumerate(self.feature.patches) if patch.kind != "plane")
        return ArcGap(self.seams, self.place, curved=curved, tolerance=tolerance / self.place.length)

    def drift_limits(self, settings: FitSettings, margin: float) -> list[DriftLimit]:
        """Corners held within the settings' shares of the panels' lengths, less a relative margin."""
        shares = ((settings.drift_along, False), (settings.drift_across, True))
        return [DriftLimit(self.outline, (1.0 - margin) * s * self.lengths, across=across) for s, across in shares]

    def free_terms(self) -> list[Term]:
        """Deviation and the weak pull of corners to the outline: what a panel wants by itself."""
        return [self.deviation, *self.drift_limits(FitSettings(), 0.0)]

    def placement_unknowns(self) -> IntArray:
        """Indices among the unknowns of those that move a panel or trim it: all but its curved patches' numbers."""
        shape: set[int] = set()
        for i, patch in enumerate(self.feature.patches):
            if patch.kind != "plane":
                numbers = self.feature.patch_slice(i)
                shape |= set(range(numbers.start, numbers.stop))
        return np.array([i for i, number in enumerate(self.feature.free) if int(number) not in shape], dtype=np.intp)

    def deviations(self, unknowns: Array) -> tuple[Array, Array]:
        """RMS per panel (panels,), area-weighted, and signed distances (panels, m) of all samples, mm."""
        distance, _ = self.deviation.distances(self.state(unknowns).walked)
        weight = self.deviation.roots**2
        rms = np.sqrt(np.sum(weight * distance**2, axis=1) / weight.sum(axis=1))
        return rms * self.place.length, distance * self.place.length

    def normal_tilt(self, unknowns: Array, reference: Reference) -> Array:
        """(panels,) RMS angle between the reference's normals and the skin's under its samples, radians."""
        walked = self.state(unknowns).walked
        patch = assign(walked, self.deviation.samples)
        normals = np.einsum("pmx,pxa->pma", SampleArrays.of(reference).normals, self.place.axes)
        cosine = np.einsum("pma,pma->pm", normals, skin_normals(walked, self.deviation.samples, patch))
        weight = self.deviation.roots**2
        square = np.arccos(np.clip(cosine, -1.0, 1.0)) ** 2
        result: Array = np.sqrt(np.sum(weight * square, axis=1) / weight.sum(axis=1))
        return result


def problem(reference: Reference, feature: Feature, samples: SampleArrays, begin: Start) -> Problem:
    """Turn a reference into the arrays of a problem.

    Samples weigh by their area, such that the deviation's cost is half the panels' number times the mean square.
    """
    # Positions relative to the middle of all: map-grid coordinates would cost digits in the gaps.
    centre = begin.origins.mean(axis=0)
    place = Placement(origins=begin.origins - centre, centre=centre, axes=begin.axes, length=begin.length)
    local = np.einsum("pmx,pxa->apm", samples.points - begin.origins[:, None], begin.axes) / begin.length
    share = samples.weights / (samples.weights.sum() / len(samples.weights))
    outline = _outline(reference, feature, begin)
    seams, pairs = _seams(reference)
    deviation = Deviation(np.ascontiguousarray(local), np.sqrt(share))
    lengths = np.array([panel.length for panel in reference.panels]) / begin.length
    return Problem(feature, place, deviation, outline, lengths, seams, pairs)


def _outline(reference: Reference, feature: Feature, begin: Start) -> Outline:
    """The outline's corners, and on the ends the points that the fold's corners start nearest to."""
    walked = walk(feature, begin.values, derivatives=False)
    started = pierce(walked, walked.edges).position
    sides = np.array([panel.corners for panel in reference.panels])
    chords = sides[:, 1] - sides[:, 0]
    chords = np.einsum("psx,pxa->psa", chords, begin.axes) / np.linalg.norm(chords, axis=-1)[..., None]
    corners, along = np.empty_like(started), np.empty_like(started)
    end_normals = np.empty((*started.shape[:2], 3))
    share = np.linspace(0.0, 1.0, started.shape[2])[None, :, None]
    along[:] = ((1.0 - share) * chords[:, None, 0] + share * chords[:, None, 1])[:, None]
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    for i, panel in enumerate(reference.panels):
        for end in (0, 1):
            line = (panel.ends[end] - begin.origins[i]) @ begin.axes[i] / begin.length
            nearest = np.argmin(np.linalg.norm(line[None] - started[i, end, 1:-1, None], axis=-1), axis=1)
            corners[i, end] = line[[0, *nearest, -1]]
            end_normals[i, end] = end_plane(line, tilt=True)[1]
    return Outline(corners, along, end_normals)


def _seams(reference: Reference) -> tuple[Seams, IntArray]:
    panels = np.array([seam.panels for seam in reference.seams], dtype=np.intp).reshape(-1, 2)
    ends = np.array([seam.ends for seam in reference.seams], dtype=np.intp).reshape(-1, 2)
    swap = panels[:, 0] > panels[:, 1]
    panels[swap], ends[swap] = panels[swap, ::-1], ends[swap, ::-1]
    pairs, pair = np.unique(panels, axis=0, return_inverse=True)
    backwards = np.array([seam.reversed for seam in reference.seams], dtype=bool)
    return Seams(panels=panels, ends=ends, reversed=backwards, pair=pair.reshape(-1)), pairs


class Objective:
    """A sum of terms on a problem, as the solver's model.

    Attributes:
        problem: what the terms are about.
        terms: the terms.
        pattern: which panels are coupled through these terms.
    """

    def __init__(self, of: Problem, terms: Sequence[Term], *, coupled: bool) -> None:
        """`coupled` where some term sees both panels of a seam."""
        self.problem = of
        self.terms = tuple(terms)
        pairs = of.pairs if coupled else np.empty((0, 2), dtype=np.intp)
        self.pattern = BlockPattern(of.panels, len(of.feature.free), pairs)
        self.bounds: Bounds | None = None

    def cost(self, unknowns: Array) -> Array:
        """See `solver.Model.cost`."""
        state = self.problem.state(unknowns)
        cost = np.zeros(self.problem.panels)
        for term in self.terms:
            cost += term.cost(state)
        return np.where(np.isfinite(cost), cost, np.inf)

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """See `solver.Model.linearize`."""
        state = self.problem.state(unknowns, derivatives=True)
        normal = Normal.zero(self.pattern.count, self.pattern.size, len(self.pattern.pairs))
        cost = np.zeros(self.problem.panels)
        for term in self.terms:
            cost += term.add_to(normal, state)
        return cost, normal


class Subset:
    """A model of which only some unknowns of every panel may move.

    Attributes:
        active: indices of the unknowns that move.
        pattern: which panels are coupled.
    """

    def __init__(self, model: Objective, frozen: Array, active: IntArray) -> None:
        """The others stay at `frozen` (panels, free)."""
        self.active = active
        self.pattern = BlockPattern(model.pattern.count, len(active), model.pattern.pairs)
        self.bounds: Bounds | None = None
        self._model, self._frozen = model, frozen

    def fill(self, unknowns: Array) -> Array:
        """(panels, free) all unknowns from the active ones."""
        full = self._frozen.copy()
        full[:, self.active] = unknowns
        return full

    def cost(self, unknowns: Array) -> Array:
        """See `solver.Model.cost`."""
        return self._model.cost(self.fill(unknowns))

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """See `solver.Model.linearize`."""
        cost, normal = self._model.linearize(self.fill(unknowns))
        rows, columns = self.active[:, None], self.active[None, :]
        return cost, Normal(
            normal.gradient[:, self.active], normal.diagonal[:, rows, columns], normal.coupling[:, rows, columns]
        )
