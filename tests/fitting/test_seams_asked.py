"""What --seams means to a fit."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.fitting.run import fit
from cadpanel.fitting.seams_asked import for_seams
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.settings import ReferenceSettings
from tests.columns import column
from tests.delivered import strip


@pytest.mark.parametrize("seams", ["square", "level", "conjugate"])
def test_seams_that_are_not_free_keep_their_limits(seams: str) -> None:
    assert for_seams(FitSettings(), seams) == FitSettings()  # type: ignore[arg-type] # one of the words


def test_of_free_seams_counts_what_was_asked_for_beside() -> None:
    free = for_seams(FitSettings(evenness=0.01), "free")
    assert (free.seam_turn, free.evenness, free.seam_level) == (90.0, 0.01, 1000.0)
    assert for_seams(free, "free") == free


def test_free_seams_turn_further_and_save_deviation() -> None:
    free = fit(replace(strip(), settings=ReferenceSettings(seams="free")), FitSettings(step=0.5))
    square = fit(strip(), FitSettings(step=0.5))
    assert free.tolerance_met
    assert free.measures.overall_rms < 0.995 * square.measures.overall_rms
    assert np.degrees(free.measures.turn.max()) > 3.0


def test_level_cuts_are_held_in_their_planes_whether_they_close_to_a_ring_or_not() -> None:
    ring = column(rows=2)
    open_ = replace(ring, seams=ring.seams[1:], settings=ReferenceSettings(divide=2, seams="level"))
    level = fit(open_, FitSettings(feature="cone"))
    assert level.tolerance_met
    assert level.measures.off_level.max() <= 1.0
