"""A gap whose parts, width, step and shift, are allowed different lengths.

A gap's vectors are looked at in the directions of the seam, each part counted in what is allowed of it, and are held in
a ball: in an ellipsoid, whose half axes are what is allowed of the parts. No part is longer than its own. A box would
allow a little more where two parts are used up at once, and takes twice as many steps.

The directions are those of one state and do not follow the unknowns: they hardly turn while a gap is closed, and
whoever holds a part looks again where it ended (`straighten`).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.solver.hold import Hold
from cadpanel.terms.edge_gap import MixedGap
from cadpanel.terms.outermost_gap import OutermostGap
from cadpanel.terms.parts import PARTS
from cadpanel.terms.state import State
from cadpanel.terms.term import HeldTerm


class PartedGap(HeldTerm):
    """Holds some parts of a gap within tolerances of their own.

    Attributes:
        parts: which, in the order of its vectors' numbers.
    """

    def __init__(
        self, gap: OutermostGap | MixedGap, state: State, allowed: Mapping[str, float | Array], *, share: float = 1.0
    ) -> None:
        """Look at a gap in the directions of a state.

        Args:
            gap: whose vectors are looked at.
            state: where.
            allowed: by part, in units of the solver's length, of every seam (seams,) or one for all; what is not in it
                is not held, and one of the gap's is.
            share: of what is allowed, to hold.
        """
        self.gap, self.seams = gap, gap.seams
        self.blocks, self.pair, self.panels = gap.blocks, gap.pair, gap.panels
        self.parts = tuple(part for part in PARTS[: gap.parts] if part in allowed)
        count = len(gap.seams.index)
        most = np.stack([np.broadcast_to(allowed[part], count) for part in self.parts], axis=1)
        least = most.min(axis=1, keepdims=True)
        self._scale = least / most
        self.straighten(state)
        radius = np.broadcast_to(share * least, gap.hold.radius.shape).copy()
        self.hold = Hold(radius, weight=0.0, gives_way=True)

    def straighten(self, state: State) -> None:
        """From now on look in the directions of this state."""
        self._seen = self.gap.seen(state, [PARTS.index(part) for part in self.parts], self._scale)

    def vectors(self, state: State) -> Array:
        """(seams, points, parts), each part over what is allowed of it, times the least of these."""
        return self._seen.vectors(state)

    def linear(self, state: State) -> tuple[Array, tuple[Array, ...]]:
        """See `HeldTerm.linear`."""
        return self._seen.linear(state)
