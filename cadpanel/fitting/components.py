"""Panels that seams connect are fitted together, and those of different components by themselves.

What is far apart on a building has no say in each other's numbers: neither its scale, nor its damping, nor when the
other one comes to rest. So a component comes out the same, to the last bit, whatever else is fitted with it. Rules for
single panels may tie what no seam connects; with rules all is one component. Panels without any seam are fitted side
by side as one, as they are many and nothing of them is held together.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cadpanel.arrays import Array, IntArray
from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.measures.joined import joined
from cadpanel.fitting.measures.verdict import keeps_limits
from cadpanel.fitting.result import FitResult, HeldAgainst
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.solver.stop import Stop

FitPart = Callable[[Reference, FitSettings, IntArray, FitResult | None], FitResult]
"""Fits a part of a reference, told the places of its panels, and from which fit of it to go on."""


def components(reference: Reference, settings: FitSettings) -> list[IntArray]:
    """The places of the panels of each component, in the order of their first panels."""
    count = len(reference.panels)
    if settings.rules is not None or count == 0:
        return [np.arange(count)]
    pairs = np.array([seam.panels for seam in reference.seams], dtype=np.intp).reshape(-1, 2)
    _, label = connected_components(coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(count, count)), False)
    alone = ~np.isin(np.arange(count), pairs)
    label = np.where(alone, label.max() + 1, label)
    first = {one: int(np.flatnonzero(label == one)[0]) for one in np.unique(label).tolist()}
    return [np.flatnonzero(label == one) for one in sorted(first, key=first.__getitem__)]


def part_of(reference: Reference, places: IntArray) -> Reference:
    """Some panels of a reference, and the seams between them."""
    new = {place: number for number, place in enumerate(places.tolist())}
    seams = tuple(
        replace(seam, panels=(new[seam.panels[0]], new[seam.panels[1]]))
        for seam in reference.seams
        if seam.panels[0] in new
    )
    return replace(reference, panels=tuple(reference.panels[place] for place in places), seams=seams)


def fit_apart(
    reference: Reference, settings: FitSettings, parts: Sequence[IntArray], fit: FitPart, after: FitResult | None
) -> FitResult:
    """Fit every component by itself, and put them together.

    Raises:
        PanelError: a panel's faces are nothing that the feature could approximate.
    """
    began = time.perf_counter()
    found = []
    for number, places in enumerate(parts):
        part = part_of(reference, places)
        names = {panel.name for panel in part.panels}
        own = replace(settings, blend=tuple(one for one in settings.blend if one.panel is None or one.panel in names))
        found.append(fit(part, own, places, None if after is None else after.parts[number]))
    measures = joined([result.measures for result in found], parts, reference)
    return FitResult(
        reference=reference,
        settings=settings,
        shapes=measures.shapes,
        measures=measures,
        unknowns=_unknowns(parts, found),
        baselines=JoinedBaselines(
            reference=reference,
            places=tuple(parts),
            parts=tuple(result.baselines for result in found),
            measures=tuple(result.measures for result in found),
        ),
        tolerance_met=keeps_limits(measures, settings) and all(result.tolerance_met for result in found),
        starts=max(result.starts for result in found),
        agreed=min(result.agreed for result in found),
        iterations=sum(result.iterations for result in found),
        stopped=next((result.stopped for result in found if result.stopped is not Stop.HELD), Stop.HELD),
        outcomes=(),
        prices=_prices(found, measures),
        seam_prices=_seam_prices(reference, parts, found, measures),
        seconds=time.perf_counter() - began,
        parts=tuple(found),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class JoinedBaselines:
    """What the components together are held against; see `Baselines`.

    Attributes:
        reference: what is approximated.
        places: of the panels of each component.
        parts: what each is held against.
        measures: of each.
    """

    reference: Reference
    places: tuple[IntArray, ...]
    parts: tuple[HeldAgainst, ...]
    measures: tuple[Measures, ...]

    def told_of(self, reference: Reference) -> JoinedBaselines:
        """See `HeldAgainst.told_of`."""
        return replace(self, reference=reference)

    def judged_by(self, settings: FitSettings, measures: Measures) -> JoinedBaselines:
        """See `HeldAgainst.judged_by`."""
        del measures
        judged = (part.judged_by(settings, own) for part, own in zip(self.parts, self.measures, strict=True))
        return replace(self, parts=tuple(judged))

    @property
    def local(self) -> Measures:
        """See `HeldAgainst.local`."""
        return joined([part.local for part in self.parts], self.places, self.reference)

    @property
    def two_stage(self) -> Measures:
        """See `HeldAgainst.two_stage`."""
        return joined([part.two_stage for part in self.parts], self.places, self.reference)


def _unknowns(parts: Sequence[IntArray], found: Sequence[FitResult]) -> Array:
    """(panels, most) of all; nan where a component has fewer a panel."""
    most = max(result.unknowns.shape[1] for result in found)
    unknowns = np.full((sum(map(len, parts)), most), np.nan)
    for places, result in zip(parts, found, strict=True):
        unknowns[places, : result.unknowns.shape[1]] = result.unknowns
    return unknowns


def _shares(found: Sequence[FitResult], measures: Measures) -> list[float]:
    """By how much the RMS deviation of all falls where that of one component falls by 1 mm, to first order.

    R^2 = sum of a r^2 with shares a of the area: dR / dr = a r / R.
    """
    areas = np.array([sum(float(p.weights.sum()) for p in result.reference.panels) for result in found])
    rms = np.array([result.measures.overall_rms for result in found])
    whole = measures.overall_rms
    return [0.0] * len(found) if whole == 0.0 else (areas / areas.sum() * rms / whole).tolist()


def _prices(found: Sequence[FitResult], measures: Measures) -> Mapping[str, float]:
    """Empty where not everything is held, as of a fit of all at once."""
    if any(result.stopped is not Stop.HELD for result in found):
        return {}
    names = dict.fromkeys(name for result in found for name in result.prices)
    shares = _shares(found, measures)
    return {
        name: sum(share * result.prices.get(name, 0.0) for share, result in zip(shares, found, strict=True))
        for name in names
    }


def _seam_prices(
    reference: Reference, parts: Sequence[IntArray], found: Sequence[FitResult], measures: Measures
) -> tuple[float, ...]:
    if any(result.stopped is not Stop.HELD for result in found) or not any(result.seam_prices for result in found):
        return ()
    prices = np.zeros(len(reference.seams))
    for places, result, share in zip(parts, found, _shares(found, measures), strict=True):
        own = [number for number, seam in enumerate(reference.seams) if seam.panels[0] in places]
        if result.seam_prices:
            prices[own] = share * np.array(result.seam_prices)
    return tuple(prices.tolist())
