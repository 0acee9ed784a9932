"""What the terms see: the panels walked at the current unknowns, in each panel's own frame and in common units."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.walk import Points, Walk, pierce

Array = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """The panels at one set of unknowns; points are worked out when a term first asks for them.

    Attributes:
        walked: rulings and their twists, in the panels' frames, lengths in units of the problem's length.
    """

    walked: Walk

    @cached_property
    def corners(self) -> Points:
        """Corners (panels, 2, k + 1, 3): every bounding ruling pierces both cut planes."""
        return pierce(self.walked, self.walked.edges)

    @cached_property
    def arcs(self) -> Points:
        """Points inside the conic arcs of both ends (panels, 2, arcs, 3)."""
        return pierce(self.walked, self.walked.arcs)
