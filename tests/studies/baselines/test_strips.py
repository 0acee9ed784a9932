"""Strips that are no chains are measured as panels are: by their distance, and under the drawn edges."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from cadpanel.studies.baselines.strips import outcome_of
from tests.delivered import strip


@dataclass
class Off:
    """A strip that lies off the drawn one by so much everywhere."""

    by: np.ndarray
    warp: float = 0.0

    def feet(self, points):
        return points + self.by


def test_a_strip_that_is_moved_is_off_by_that_and_gaps_are_what_two_differ_by():
    reference = replace(strip(), panels=strip().panels[:2], seams=strip().seams[:1])
    one, other = Off(np.array([3.0, 0.0, 4.0])), Off(np.array([3.0, 0.0, 5.0]), warp=np.radians(2.0))
    found = outcome_of([one, one], reference)
    assert (found.rms, found.largest, found.drift) == pytest.approx((5.0, 5.0, 5.0))
    assert (found.corner_gap, found.seam_gap, found.turn, found.warp) == pytest.approx((0.0, 0.0, 0.0, 0.0), abs=1e-3)
    found = outcome_of([one, other], reference)
    assert (found.corner_gap, found.seam_gap, found.warp) == pytest.approx((1.0, 1.0, 2.0), abs=1e-3)
    # Which way round the second edge is told changes nothing.
    turned = replace(reference.panels[1], edges=tuple(edge[::-1] for edge in reference.panels[1].edges))
    (seam,) = reference.seams
    backwards = replace(
        reference, panels=(reference.panels[0], turned), seams=(replace(seam, reversed=not seam.reversed),)
    )
    assert outcome_of([one, other], backwards).seam_gap == pytest.approx(found.seam_gap)
