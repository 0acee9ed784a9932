"""The cheapest feature that will do: for each panel the first of a list that stays within a largest deviation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.errors import PanelError
from cadpanel.features.catalogue import POLYGON, for_corners
from cadpanel.features.layout import Layout
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.effort import Effort
from cadpanel.fitting.measures.fit import largest_deviations
from cadpanel.fitting.methods.holding import EXACT
from cadpanel.fitting.methods.local import Local
from cadpanel.fitting.problem import pose, unit_length
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import PanelReference, Reference
from cadpanel.reference.suitability import check_fold

CHEAPEST_FIRST = (
    POLYGON,
    "cylinder",
    "cone",
    "plane-cylinder-plane",
    "plane-cone-plane",
    "tri-cone",
    "plane-cone-cone-plane",
    "plane-cone-plane-cone-plane",
)
"""What a shop makes with less work comes first: flat sheet, one roll, one tapered roll, folds, double folds."""


COMMON = CHEAPEST_FIRST.index("plane-cone-plane")
"""The place of the feature that lips are fitted with where none is asked for."""

# A feature that is this much farther off, a share, is as close to a panel as another.
_AS_CLOSE = 1e-6
# Neighbours of different features are held together from here within a few steps or not at all, so the fits alone are
# brought to rest more closely than for others: see `fitting.methods.local`.
_SETTLED = 1e-5


class Choice:
    """Which feature each panel has, and what it might have instead.

    Attributes:
        deviations: (panels, features) largest deviation of each panel fitted alone, mm; infinite where the feature does
            not suit the panel.
        rms: (panels, features) the RMS deviation likewise.
        chosen: (panels,) index into CHEAPEST_FIRST.
        effort: what the fits of single panels took, and may take.
    """

    def __init__(self, reference: Reference, settings: FitSettings) -> None:
        """Fit every panel alone with one feature after the other, until it stays within the largest deviation."""
        if settings.max_deviation is None:
            raise ValueError("without a largest deviation every feature would do")
        self._reference, self._settings, self._largest = reference, settings, settings.max_deviation
        self._length = unit_length(reference)
        self._alone: dict[tuple[int, int], Array] = {}
        panels = len(reference.panels)
        self.deviations = np.full((panels, len(CHEAPEST_FIRST)), np.inf)
        self.rms = self.deviations.copy()
        self.effort = Effort()
        self._tried = np.zeros(self.deviations.shape, dtype=bool)
        self.chosen = np.zeros(panels, dtype=np.intp)
        waiting = np.arange(panels)
        for place in range(len(CHEAPEST_FIRST)):
            waiting = waiting[self.deviations[waiting].min(axis=1) > self._largest]
            self._try(place, waiting)
        self.chosen = self._first_within(self.deviations)

    def features(self) -> list[PanelFeature]:
        """The chosen feature of every panel."""
        return [
            self._feature(place, panel)
            for place, panel in zip(self.chosen.tolist(), self._reference.panels, strict=True)
        ]

    def alone(self, layout: Layout) -> Array:
        """(panels, size) the unknowns of the panels fitted alone with the features chosen, posed as they were tried.

        Raises:
            PanelError: no start was found for a panel with any feature.
        """
        unknowns = np.zeros((layout.panels, layout.size))
        for panel, place in enumerate(self.chosen.tolist()):
            own = self._alone.get((panel, place))
            if own is None:
                name = self._reference.panels[panel].name
                raise PanelError(name, "no feature comes near it; check its faces, or take it out of the file")
            unknowns[panel, : len(own)] = own
        return unknowns

    def promote(self, panels: IntArray) -> bool:
        """Give panels that break a limit the next feature that suits them.

        Returns:
            whether any panel has another feature now.
        """
        changed = False
        waiting = panels
        for place in range(1, len(CHEAPEST_FIRST)):
            asked = waiting[self.chosen[waiting] < place]
            self._try(place, asked[~self._tried[asked, place]])
            closer = asked[self._follows(asked, place)]
            self.chosen[closer] = place
            waiting = np.setdiff1d(waiting, closer)
            changed |= len(closer) > 0
        return changed

    def forbid(self, panels: IntArray) -> bool:
        """Take panels' features away, as nothing could be built of them among their neighbours, and choose others.

        Returns:
            whether each of them has another one.
        """
        self.deviations[panels, self.chosen[panels]] = self.rms[panels, self.chosen[panels]] = np.inf
        for panel in panels.tolist():
            for place in np.flatnonzero(~self._tried[panel]).tolist():
                if self.deviations[panel].min() > self._largest:
                    self._try(place, np.array([panel]))
        self.chosen[panels] = self._first_within(self.deviations[panels])
        return bool(np.isfinite(self.deviations[panels, self.chosen[panels]]).all())

    def _follows(self, panels: IntArray, place: int) -> BoolArray:
        """(n,) which of some panels a feature may follow better than the one that they have.

        One that is no closer alone, RMS as it was fitted, will be no closer among its neighbours. One that is as close
        may be: a cone can do all that a cylinder does.
        """
        mine, its = (self.rms[panels, of] for of in (self.chosen[panels], place))
        near = self.deviations[panels, place] <= np.maximum(self.deviations[panels, self.chosen[panels]], self._largest)
        return np.asarray(near & np.isfinite(its) & (its <= mine * (1.0 + _AS_CLOSE) + EXACT * self._length))

    def common(self) -> IntArray:
        """(panels,) the place of `COMMON`, or of what is chosen where that does not suit a panel."""
        missing = np.flatnonzero(~self._tried[:, COMMON])
        self._try(COMMON, missing)
        return np.where(np.isfinite(self.deviations[:, COMMON]), COMMON, self.chosen)

    def _first_within(self, deviations: Array) -> IntArray:
        within = deviations <= self._largest
        first: IntArray = np.where(within.any(axis=1), within.argmax(axis=1), deviations.argmin(axis=1))
        return first

    def _try(self, place: int, panels: IntArray) -> None:
        self._tried[panels, place] = True
        suited = [i for i in panels.tolist() if self._suits(self._reference.panels[i], place)]
        if not suited:
            return
        try:
            part = replace(self._reference, panels=tuple(self._reference.panels[i] for i in suited), seams=())
            features = [self._feature(place, panel) for panel in part.panels]
            problem, starts = pose(part, features, length=self._length)
        except PanelError as error:
            # No start was found for one of them, which the next feature may suit better.
            self._try(place, np.array([i for i in suited if self._reference.panels[i].name != error.panel]))
            return
        found = Local(settled=_SETTLED).fit(problem, starts, self._settings)
        for i, row, feature in zip(suited, found.unknowns, problem.layout.feature_of, strict=True):
            self._alone[i, place] = row[: len(feature.free)]
        self.effort.spend(problem, found.iterations)
        self.deviations[suited, place] = largest_deviations(panel_shapes(problem, found.unknowns), part)
        self.rms[suited, place] = problem.deviations(found.unknowns)[0]

    def _suits(self, panel: PanelReference, place: int) -> bool:
        if CHEAPEST_FIRST[place] == POLYGON:
            return True
        if not panel.four_sided:
            return False
        feature = self._feature(place, panel)
        folds = sum(feature.curved)
        try:
            check_fold(panel, self._reference.source, flanged=folds < len(feature.curved), folds=folds)
        except PanelError:
            return False
        return True

    def _feature(self, place: int, panel: PanelReference) -> PanelFeature:
        return for_corners(CHEAPEST_FIRST[place], tilt=self._settings.tilt)(len(panel.edges))


def can_be_built(shape: Panel) -> bool:
    """Whether an exact skin can be built of a panel."""
    try:
        shape.check()
    except PanelError:
        return False
    return True
