"""Level seams: rings of a column stay in their planes, in whatever way the column stands, and the last to give way."""

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cadpanel.fitting.result import FitResult
from cadpanel.fitting.rules.boundary import boundary_of
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.terms.limits.planes import PlaneTerm
from cadpanel.terms.limits.seam_level import SeamLevel
from tests.columns import column, turned
from tests.delivered import fitted
from tests.known_panels import posed

TURN = Rotation.from_rotvec([0.4, -0.7, 0.2]).as_matrix()
SMALL = column(rows=2, columns=4)


@cache
def leaning(seam_level: float) -> FitResult:
    return fit(turned(SMALL, TURN), FitSettings(feature="cone", seam_level=seam_level))


def test_by_default_rings_stay_in_their_planes_which_they_would_leave() -> None:
    usual, free = leaning(SeamLevel.default), leaning(SeamLevel.most)
    assert usual.tolerance_met
    assert usual.measures.off_level.max() <= 1.0 < 5.0 < free.measures.off_level.max()
    assert usual.measures.overall_rms <= 1.01 * free.measures.overall_rms


def test_what_is_measured_is_the_farthest_corner_or_arc_point_of_the_ring() -> None:
    free = leaning(SeamLevel.most)
    heights = [boundary_of(shape) @ TURN[:, 2] - 1500.0 for shape in free.shapes]
    off = [np.abs(own[[2, 3, 7, 8, 9]] if p < 4 else own[[0, 1, 4, 5, 6]]).max() for p, own in enumerate(heights)]
    assert free.measures.off_level == pytest.approx(off, abs=1e-6)
    assert SeamLevel().worst(free.measures) == pytest.approx(max(off), abs=1e-6)


def test_of_a_strip_nothing_is_level() -> None:
    assert np.isnan(fitted().measures.off_level).all()
    assert SeamLevel().worst(fitted().measures) is None
    assert not SeamLevel().measure(fitted().measures).any()


def test_panels_by_themselves_are_held_to_the_same_planes() -> None:
    problem, (begin, *_) = posed(SMALL, FitSettings(feature="cone"))
    chosen = np.array([6, 1])
    whole, part = (SeamLevel().held(of, FitSettings().allowed, 0.0)[0] for of in (problem, problem.take(chosen)))
    assert isinstance(part, PlaneTerm)
    mine = [np.flatnonzero(whole.blocks[0] == panel) for panel in chosen.tolist()]
    its = part.vectors(problem.take(chosen).state(begin[chosen]))
    for row, places in enumerate(mine):
        assert its[part.blocks[0] == row] == pytest.approx(whole.vectors(problem.state(begin))[places], abs=1e-12)
