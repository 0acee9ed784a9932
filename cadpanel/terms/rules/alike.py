"""Radii and half angles of the bends of panels that are to be alike."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.patches import DIMENSIONS
from cadpanel.solver.hold import Hold
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm

RADIUS, HALF_ANGLE = (DIMENSIONS["cone"].index(what) for what in ("radius", "half_angle"))
# In the solver's length: bends of a tenth of the panel's length are as far apart as their radii differ by.
_SCALE = 0.1


class AlikeTerm(HeldTerm):
    """Holds the bends of pairs of panels alike: the logarithms of their radii, or their half angles, one after another.

    By logarithms a flat bend is to a flatter one as a tight one is to a tighter. Which way a patch bends does not
    matter; half angles are positive where it widens from end 0 to end 1.
    """

    def __init__(
        self, first: IntArray, second: IntArray, pair: IntArray, *, bends: int, what: int, within: float, sides: Array
    ) -> None:
        """Hold them within a share of the radius, or radians.

        Args:
            first: (g,) panels.
            second: (g,) panels that are to be like them.
            pair: (g,) which pair of coupled panels they are.
            bends: how many curved patches each of them has.
            what: `RADIUS` or `HALF_ANGLE`.
            within: share or radians.
            sides: (panels,) of all panels, -1 for those whose half angles count turned about.
        """
        self.blocks, self.pair = (first, second), pair
        self._bends, self._what, self._sides = bends, what, sides
        self.panels = len(sides)
        self.hold = Hold(np.full((len(first), bends), _SCALE * within), weight=0.0, gives_way=True)

    def vectors(self, state: State) -> Array:
        """(g, bends, 1) by how much the first panel's differ from the second's."""
        told = self._told(state, derivatives=False)[0]
        return (told[self.blocks[0]] - told[self.blocks[1]])[..., None]

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        told, rates = self._told(state, derivatives=True)
        first, second = self.blocks
        return (told[first] - told[second])[..., None], (rates[first][:, :, None], -rates[second][:, :, None])

    def _told(self, state: State, *, derivatives: bool) -> tuple[Array, Array]:
        """(panels, bends) what is compared, and how it follows the unknowns (panels, bends, size)."""
        layout = state.layout
        told = np.zeros((layout.panels, self._bends))
        rates = np.zeros((layout.panels, self._bends, layout.size if derivatives else 0))
        for group, walked in zip(layout.groups, state.walks, strict=True):
            side = self._sides[group.panels]
            curved = [i for i, bent in enumerate(group.feature.curved) if bent]
            for place, patch in enumerate(curved[: self._bends]):
                dimensions, own = walked.dimensions[patch], group.feature.patch_slice(patch)
                radius, value = dimensions.values[:, RADIUS], dimensions.values[:, self._what]
                way = side * np.sign(radius)
                told[group.panels, place] = _SCALE * (np.log(np.abs(radius)) if self._what == RADIUS else way * value)
                if not derivatives:
                    continue
                slope = 1.0 / radius if self._what == RADIUS else way
                by_numbers = np.zeros((len(radius), len(group.feature.numbers)))
                by_numbers[:, own] = _SCALE * slope[:, None] * dimensions.by_numbers()[:, self._what]
                by_unknowns = group.feature.by_unknowns(by_numbers)
                rates[group.panels, place, : by_unknowns.shape[1]] = by_unknowns
        return told, rates
