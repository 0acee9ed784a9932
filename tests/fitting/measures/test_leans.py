"""By how much flat flanges that were fitted alone would have to lean their seams to meet."""

import numpy as np
import pytest

from cadpanel.fitting.measures.leans import leans
from cadpanel.geometry.patches import PlanePatch
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.vectors import unit
from cadpanel.reference.model import Seam
from tests.delivered import fitted, fitted_alone, strip

SEAM = Seam(panels=(0, 1), edges=(1, 0), reversed=False)


def plate(normal: tuple[float, float, float]) -> PanelShape:
    """A flat panel whose end 1 runs along x."""
    return PanelShape(
        name="N",
        feature="planar-quadrilateral",
        points=np.array([[0.0, 0.0, 0.0], [900.0, 0.0, 0.0]]),
        directions=np.tile([0.0, 1.0, 0.0], (2, 1)),
        normals=np.tile(unit(np.array(normal)), (2, 1)),
        patches=(PlanePatch(),),
        cut_points=np.array([[0.0, 0.0, 0.0], [0.0, 700.0, 0.0]]),
        cut_normals=np.tile([0.0, 1.0, 0.0], (2, 1)),
    )


@pytest.mark.parametrize("degrees", [0.0, 20.0, 90.0])
def test_two_planes_that_cross_askew_want_a_seam_that_leans_like_their_line(degrees: float) -> None:
    lean = np.radians(degrees)
    tilted = plate((-0.1 * np.sin(lean), 0.1 * np.cos(lean), 1.0))
    assert np.degrees(leans(plate((0.0, 0.0, 1.0)), tilted, SEAM)) == pytest.approx([degrees], abs=1e-6)


def test_planes_that_hardly_differ_and_sides_tell_nothing() -> None:
    assert leans(plate((0.0, 0.0, 1.0)), plate((0.0, 1e-4, 1.0)), SEAM).tolist() == []
    side = Seam(panels=(0, 1), edges=(3, 2), reversed=False)
    assert leans(fitted().shapes[0], fitted().shapes[1], side).tolist() == []


def test_flanges_that_close_lean_no_farther_than_those_that_were_fitted_alone() -> None:
    seam = strip().seams[0]
    first, second = seam.panels
    alone, closed = (leans(of.shapes[first], of.shapes[second], seam) for of in (fitted_alone(), fitted()))
    assert len(alone) == len(closed) == 2
    assert closed.max() < alone.max()
