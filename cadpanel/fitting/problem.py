"""A fit as the solver sees it: panels in their own frames, terms, and which panels are coupled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.distance import skin_normals
from cadpanel.features.layout import Layout
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.bends.asked import Blend
from cadpanel.fitting.bends.taken import allowed_patches, check_blends, stretches
from cadpanel.fitting.bounds import natural_bounds
from cadpanel.fitting.outline import outline_of
from cadpanel.fitting.rules.bends import NUMBERS, numbers_of
from cadpanel.fitting.rules.rule import Bends, Posed
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.start.begin import Start, start
from cadpanel.reference.across_seams import AcrossSeams, across_seams
from cadpanel.reference.model import Reference, Seam
from cadpanel.solver.blocks import BlockPattern
from cadpanel.solver.components import Components
from cadpanel.terms.arc_gap import ArcGap
from cadpanel.terms.corner_gap import CornerGap
from cadpanel.terms.deviation import Deviation
from cadpanel.terms.edge_gap import MixedGap
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.outline import Outline
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import SeamBatch, batches
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm, Term

SeamTerm = CornerGap | ArcGap | MixedGap


@dataclass(frozen=True)
class Problem:
    """Everything that stays the same while features are fitted to one reference.

    Attributes:
        names: the panels' names.
        layout: which panels have which feature, in the solver's units.
        place: the panels' own frames.
        deviation: the regression term.
        outline: the reference's corners.
        lengths: (panels,) the panels' lengths in units of the solver's length.
        areas: (panels,) the mean area of those panels that each is connected with, by the mean of all.
        seams: who meets whom, in batches of seams that are alike.
        pairs: (pairs, 2) coupled panels.
        bounds: (panels, size) least and greatest unknowns.
        across: the lines that go on across seams.
        rules: for single panels.
    """

    names: tuple[str, ...]
    layout: Layout
    place: Placement
    deviation: Deviation
    outline: Outline
    lengths: Array
    areas: Array
    seams: tuple[SeamBatch, ...]
    pairs: IntArray
    bounds: tuple[Array, Array]
    across: AcrossSeams
    rules: tuple[Posed, ...] = ()

    @property
    def pair_of(self) -> IntArray:
        """(seams,) which pair of coupled panels meets there."""
        found = np.zeros(sum(len(batch.index) for batch in self.seams), dtype=np.intp)
        for batch in self.seams:
            found[batch.index] = batch.pair
        return found

    @cached_property
    def pattern(self) -> BlockPattern:
        """Which panels are coupled, as the solvers see it."""
        return BlockPattern(self.panels, self.layout.size, self.pairs)

    @property
    def panels(self) -> int:
        """Number of panels."""
        return self.layout.panels

    @property
    def met(self) -> tuple[Seam, ...]:
        """The seams one by one, in the reference's order, the lower panel first."""
        found: dict[int, Seam] = {}
        for batch in self.seams:
            rows = (batch.index.tolist(), batch.panels.tolist(), batch.edges.tolist(), batch.reversed.tolist())
            for index, (a, b), (on_a, on_b), backwards in zip(*rows, strict=True):
                found[index] = Seam(panels=(a, b), edges=(on_a, on_b), reversed=backwards)
        return tuple(found[index] for index in range(len(found)))

    def state(self, unknowns: Array, *, derivatives: bool = False) -> State:
        """Walk the panels at the unknowns (panels, size)."""
        return State(self.layout, self.layout.walk(unknowns, derivatives=derivatives))

    def corner_gaps(self, tolerance: float) -> list[CornerGap]:
        """Corners of neighbours held within `tolerance` mm, a term for each batch of seams."""
        return [CornerGap(batch, self.place, tolerance=tolerance / self.place.length) for batch in self.seams]

    def curve_gaps(self, tolerance: float) -> list[ArcGap | MixedGap]:
        """Edges of neighbours held within `tolerance` mm between their corners, where one of them is curved."""
        length = self.place.length
        terms: list[ArcGap | MixedGap] = []
        for batch in self.seams:
            if batch.straight(0) and batch.straight(1):
                continue
            kind = ArcGap if batch.alike else MixedGap
            terms.append(kind(batch, self.place, self.layout, tolerance=tolerance / length))
        return terms

    def limits(self, settings: FitSettings, margin: float = 0.0) -> list[HeldTerm]:
        """What panels may not do however wide the gaps are, less a relative margin."""
        return [term for _, term in self.named_limits(settings, margin)]

    def named_limits(self, settings: FitSettings, margin: float = 0.0) -> list[tuple[str, HeldTerm]]:
        """The same, each with the name of the limit that it holds."""
        allowed = settings.allowed
        limits = [(limit.name, term) for limit in LIMITS for term in limit.held(self, allowed, margin)]
        if not self.rules:
            return limits
        pair_of = {(int(one), int(other)): pair for pair, (one, other) in enumerate(self.pairs)}
        return limits + [("rules", term) for rule in self.rules for term in rule.held(self, pair_of)]

    def gaps(self, settings: FitSettings) -> Mapping[str, float | Array]:
        """What is allowed of gaps and their parts, mm; of every seam (seams,) where rules say so."""
        return settings.gaps_of(self.names, np.array([seam.panels for seam in self.met]).reshape(-1, 2))

    def ruled(self, rules: Sequence[Posed]) -> Problem:
        """The same panels under rules, some of which couple panels that do not meet."""
        links = np.concatenate([self.pairs, *(rule.links for rule in rules)])
        _, first = np.unique(links, axis=0, return_index=True)
        return replace(self, rules=tuple(rules), pairs=links[np.sort(first)])

    def fixed(self, bends: Bends, unknowns: Array) -> Problem:
        """The same panels with some radii and half angles fixed, which bend as they do at unknowns (panels, size)."""
        lower, upper = (bound.copy() for bound in self.bounds)
        for panel in np.flatnonzero(bends.held.any(axis=(1, 2))).tolist():
            feature = self.layout.feature_of[panel]
            values = feature.expand(unknowns[panel : panel + 1, : len(feature.free)])[0]
            signs = [np.sign(values[number]) for number in numbers_of(feature, NUMBERS[0]) if number is not None]
            for what, unit in zip(range(len(NUMBERS)), (self.place.length, 1.0), strict=True):
                for bend, number in enumerate(numbers_of(feature, NUMBERS[what])):
                    if number in feature.free and number is not None and bends.held[panel, bend, what]:
                        one = feature.numbers[number]
                        value = np.clip(signs[bend] * bends.values[panel, bend, what] / unit, one.lower, one.upper)
                        column = np.searchsorted(feature.free, number)
                        lower[panel, column] = upper[panel, column] = value
        return replace(self, bounds=(lower, upper))

    def take(self, panels: IntArray) -> Problem:
        """The same problem for some of its panels, without their seams."""
        features = [self.layout.feature_of[i] for i in panels]
        layout = Layout.of(features)
        place, outline = self.place, self.outline.take(panels)
        # The features that are left may have fewer corners than the longest of all.
        most = max(feature.corner_count for feature in features)
        return Problem(
            names=tuple(self.names[i] for i in panels),
            layout=layout,
            place=replace(place, origins=place.origins[panels], axes=place.axes[panels]),
            deviation=self.deviation.take(panels),
            outline=replace(outline, corners=outline.corners[:, :most]),
            lengths=self.lengths[panels],
            areas=self.areas[panels],
            seams=(),
            pairs=np.empty((0, 2), dtype=np.intp),
            bounds=(self.bounds[0][panels, : layout.size], self.bounds[1][panels, : layout.size]),
            across=across_seams((), ()),
        )

    def free_terms(self, settings: FitSettings) -> list[Term]:
        """Deviation, the weak pull of corners to the outline, and what can be made: what a panel wants by itself."""
        limits = [term for term in self.limits(settings) if term.hold.weight.any()]
        return [self.deviation, *limits]

    def placement_unknowns(self) -> BoolArray:
        """(panels, size) which unknowns move a panel or trim it: all but its curved patches' numbers."""
        moves = self.layout.used.copy()
        for group in self.layout.groups:
            shape: set[int] = set()
            for i, curved in enumerate(group.feature.curved):
                if curved:
                    numbers = group.feature.patch_slice(i)
                    shape |= set(range(numbers.start, numbers.stop))
            held = [i for i, number in enumerate(group.feature.free) if int(number) in shape]
            moves[group.panels[:, None], held] = False
        return moves

    def rms(self, cost: Array) -> float:
        """The RMS deviation of all panels in the solver's length, of the deviation term's cost (panels,)."""
        return float(np.sqrt(2.0 * (self.areas * cost).sum() / self.panels))

    def deviations(self, unknowns: Array) -> tuple[Array, Array]:
        """RMS per panel (panels,), area-weighted, and signed distances (panels, m) of all samples, mm."""
        distance, _ = self.deviation.distances(self.state(unknowns))
        weight = self.deviation.roots**2
        rms = np.sqrt(np.sum(weight * distance**2, axis=1) / weight.sum(axis=1))
        return rms * self.place.length, distance * self.place.length

    def normal_tilt(self, unknowns: Array, reference: Reference) -> Array:
        """(panels,) RMS angle between the reference's normals and the skin's under its samples, radians."""
        state = self.state(unknowns)
        _, patch = self.deviation.distances(state)
        normals = np.einsum("pmx,pxa->pma", SampleArrays.of(reference).normals, self.place.axes)
        square = np.zeros(patch.shape)
        for group, walked in zip(self.layout.groups, state.walks, strict=True):
            own = group.panels
            skin = skin_normals(walked, self.deviation.samples[:, own], patch[own])
            cosine = np.einsum("pma,pma->pm", normals[own], skin)
            square[own] = np.arccos(np.clip(cosine, -1.0, 1.0)) ** 2
        weight = self.deviation.roots**2
        result: Array = np.sqrt(np.sum(weight * square, axis=1) / weight.sum(axis=1))
        return result


def unit_length(reference: Reference) -> float:
    """The solver's length, mm: the panels' mean one, nearly.

    It is a power of two: what it is of other panels is exactly what it is of these.
    """
    return float(2.0 ** np.round(np.log2(np.mean([panel.length for panel in reference.panels]))))


def pose(
    reference: Reference,
    features: Sequence[PanelFeature],
    blends: Sequence[Blend] = (),
    *,
    length: float | None = None,
) -> tuple[Problem, tuple[Array, ...]]:
    """The problem of a reference, one feature a panel, and first unknowns (panels, size), the likeliest first.

    Args:
        reference: what is to be approximated.
        features: one a panel.
        blends: which stretches are to become the curved patches, where the user says so.
        length: mm, the solver's; see `unit_length` if not given.

    Raises:
        PanelError: a panel is not what its feature is made for.
        SettingsError: a blend does not suit a panel.
    """
    check_blends(reference, features, blends)
    length = unit_length(reference) if length is None else length
    layout = Layout.of(features, length)
    samples = SampleArrays.of(reference)
    begin = start(reference, layout, samples, length, stretches(reference.panels, blends))
    allowed = allowed_patches(reference.panels, features, blends, samples.points)
    return _problem(reference, layout, samples, begin, allowed), begin.unknowns


def _problem(
    reference: Reference,
    layout: Layout,
    samples: SampleArrays,
    begin: Start,
    allowed: tuple[IntArray, IntArray] | None,
) -> Problem:
    """Turn a reference into arrays.

    Samples weigh by their area, such that the cost is half the mean square a panel; panels that nothing connects do not
    know of each other's areas.
    """
    # Positions relative to the middle of all: map-grid coordinates would cost digits in the gaps.
    centre = begin.origins.mean(axis=0)
    place = Placement(origins=begin.origins - centre, centre=centre, axes=begin.axes, length=begin.length)
    local = np.einsum("pmx,pxa->apm", samples.points - begin.origins[:, None], begin.axes) / begin.length
    seams, pairs = _seams(reference, layout)
    blocks = Components.of(BlockPattern(layout.panels, layout.size, pairs))
    area = samples.weights.sum(axis=1)
    beside = blocks.each(blocks.mean(area))
    return Problem(
        names=tuple(panel.name for panel in reference.panels),
        layout=layout,
        place=place,
        deviation=Deviation(np.ascontiguousarray(local), np.sqrt(samples.weights / beside), allowed),
        outline=outline_of(reference, layout, begin),
        lengths=np.array([panel.length for panel in reference.panels]) / begin.length,
        areas=beside[:, 0] / area.mean(),
        seams=seams,
        pairs=pairs,
        bounds=natural_bounds(layout, begin.unknowns, begin.length),
        across=across_seams(reference.panels, reference.seams),
    )


def _seams(reference: Reference, layout: Layout) -> tuple[tuple[SeamBatch, ...], IntArray]:
    panels = np.array([seam.panels for seam in reference.seams], dtype=np.intp).reshape(-1, 2)
    edges = np.array([seam.edges for seam in reference.seams], dtype=np.intp).reshape(-1, 2)
    swap = panels[:, 0] > panels[:, 1]
    panels[swap], edges[swap] = panels[swap, ::-1], edges[swap, ::-1]
    pairs, pair = np.unique(panels, axis=0, return_inverse=True)
    backwards = np.array([seam.reversed for seam in reference.seams], dtype=bool)
    return batches(layout, panels, edges, backwards, pair.reshape(-1)), pairs
