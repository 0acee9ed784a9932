"""Where the panels' own frames stand at the start, and the same chain seen from another frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.feature import Feature
from cadpanel.fitting.samples import SampleArrays
from cadpanel.reference.model import PanelReference


@dataclass(frozen=True, slots=True)
class Frames:
    """Frames of n panels and one or more starts in them.

    Attributes:
        origins: (n, 3) mm.
        axes: (n, 3, 3) columns b, t, n.
        values: arrays (n, numbers) of all numbers.
    """

    origins: Array
    axes: Array
    values: list[Array]


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """What the starts of n panels of one feature are told by.

    Attributes:
        panels: of the reference.
        source: the reference's file.
        samples: the panels' own.
        length: mm, the solver's.
        stretches: (n, 2, 2) where on both ends the curved patches are to begin and end, mm from side 0; nan where the
            normals are to tell.
        ways: how many starts are wanted of a feature whose patches are easy to cut in the wrong place.
    """

    panels: Sequence[PanelReference]
    source: str
    samples: SampleArrays
    length: float
    stretches: Array
    ways: int


def reframe(feature: Feature, values: Array, shift: Array, axes: Array, into: Array) -> None:
    """Tell chains whose anchor rulings stand in one frame by the numbers of another; their cuts are left alone.

    The anchor ruling's point slides along the ruling into the middle plane of the frame, and the radii and widths,
    which are measured at that point, follow to first order.

    Args:
        feature: the chain.
        values: (n, numbers), changed in place.
        shift: (n, 3) from the new frames' origins to the old ones', in the solver's length and the file's directions.
        axes: (n, 3, 3) old frames.
        into: (n, 3, 3) new frames.
    """
    p = np.einsum("px,pxa->pa", shift, into)
    turn = np.swapaxes(into, 1, 2) @ axes
    t = turn[:, :, 1]
    slide = -p[:, 1] / t[:, 1]
    p = p + slide[:, None] * t
    # The Gibbs-Rodrigues vector, of length 2 tan(angle / 2).
    trace = np.trace(turn, axis1=1, axis2=2)
    skew = np.stack(
        [turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], axis=1
    )
    values[:, 0], values[:, 1] = p[:, 0], p[:, 2]
    values[:, 2:5] = 2.0 * skew / (1.0 + trace)[:, None]
    for i, patch in enumerate(feature.patches):
        own = feature.patch_slice(i)
        dimensions = patch.dimensions(values[:, own]).values.copy()
        dimensions[:, 0] += slide * np.tan(dimensions[:, 1]) * (1.0 if feature.curved[i] else -1.0)
        values[:, own] = patch.numbers_for(dimensions)
