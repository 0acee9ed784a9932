"""The ends of seams, and the directions in which gaps are seen there."""

import numpy as np
import pytest

from cadpanel.geometry.vectors import dot, unit
from cadpanel.terms.corner_gap import CornerGap
from cadpanel.terms.outermost_gap import OutermostGap
from tests.terms.models import case_of


def test_only_the_outermost_corners_are_held():
    case = case_of("plane-cone-plane", 2)
    problem, state = case.problem, case.problem.state(case.unknowns)
    for batch in problem.seams:
        every, outer = (
            CornerGap(batch, problem.place, tolerance=1.0),
            OutermostGap(batch, problem.place, problem.layout, tolerance=1.0),
        )
        assert np.array_equal(outer.vectors(state), every.vectors(state)[:, [0, -1]])


@pytest.mark.parametrize("name", ["planar-quadrilateral", "plane-cone-plane"])
def test_a_seam_runs_between_both_panels_edges_also_where_these_run_against_each_other(name):
    """Along the mean of the pieces at its ends, as far as that lies in the skin, whichever way round."""
    case = case_of(name, 4)
    problem, state = case.problem, case.problem.state(case.unknowns)
    assert any(batch.reversed.any() for batch in problem.seams)
    corners, axes = problem.place.to_world(state.corners.position), problem.place.axes
    for batch in problem.seams:
        frames = OutermostGap(batch, problem.place, problem.layout, tolerance=1.0).frames(state)
        for row, panels in enumerate(batch.panels.tolist()):
            for place, (at, beside) in enumerate(((0, 1), (-1, -2))):
                ends, nexts = batch.corners[row, :, at], batch.corners[row, :, beside]
                pieces = [unit(corners[p, b] - corners[p, a]) for p, a, b in zip(panels, ends, nexts, strict=True)]
                way = np.sum(pieces, axis=0)
                normals = [axes[p] @ state.normals.position[p, a] for p, a in zip(panels, ends, strict=True)]
                out = unit(np.sum(normals, axis=0))
                along = unit(way - dot(way, out) * out)
                assert frames[row, place, 1] == pytest.approx(out, abs=1e-12)
                assert abs(dot(frames[row, place, 2], along)) == pytest.approx(1.0, abs=1e-12)
