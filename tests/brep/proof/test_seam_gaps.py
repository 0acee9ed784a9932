"""Gaps are measured on the faces in the file, carried on to where the fit has cut them."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_skin
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam, Fitted
from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.proof.seam_gaps import off_surface, seam_gaps
from tests.joined import leaning
from tests.shapes import folded_panel, moved

CLOSE = 1e-7
ACROSS = ExpectedSeam(panels=("A", "B"), edges=("end 1", "end 0"))


def strip(half_angle, gap):
    """Two folded panels in a row, so far apart; the first one's end leans."""
    lean = ((1.0, 0.0, 0.0), (np.cos(0.1), np.sin(0.1), 0.0))
    one = folded_panel(name="A", half_angle=half_angle, cut_normals=lean)
    other = replace(one, name="B", cut_points=one.cut_points[[1, 1]] + [[0.0, 0.0, 0.0], [900.0, 0.0, 0.0]])
    return [one, replace(moved(replace(other, cut_normals=one.cut_normals[[1, 1]]), (gap, 0.0, 0.0)), name="B")]


def expected(shape, cut):
    return ExpectedPanel(
        name=shape.name,
        volume=1.0,
        kinds=(),
        corners=cut.corners(),
        fitted=Fitted(corners=shape.corners(), cuts=np.stack(shape.cuts(), axis=1)),
    )


def measured(shapes, cut, seam=ACROSS, panels=None):
    skins = {shape.name: inspect(shape.name, build_skin(shape)) for shape in cut}
    failures: list[str] = []
    wanted = panels or [expected(shape, own) for shape, own in zip(shapes, cut, strict=True)]
    return seam_gaps(wanted, skins, [seam], failures), failures


def cut_back(shapes, distance):
    one, other = shapes
    return [
        one.cut_back({"end 1": leaning(one, "end 1", distance, 0.0, 0.02)}, -3.0),
        other.cut_back({"end 0": leaning(other, "end 0", distance, 0.0, -0.01)}, -3.0),
    ]


@pytest.mark.parametrize("half_angle", [-0.05, 0.0, 0.05])
@pytest.mark.parametrize("distance", [0.0, 10.0, 100.0])
def test_however_far_the_skins_are_cut_back_the_gap_is_that_of_the_fit(half_angle, distance):
    shapes = strip(half_angle, 0.5)
    plain = [ExpectedPanel(name=shape.name, volume=1.0, kinds=(), corners=shape.corners()) for shape in shapes]
    [wanted], none = measured(shapes, shapes, panels=plain)
    [gap], failures = measured(shapes, cut_back(shapes, distance))
    assert none == failures == []
    assert gap == pytest.approx(wanted, abs=CLOSE)
    assert 0.4 < gap <= 0.5 + CLOSE


def test_a_gap_wider_than_stated_is_named():
    shapes = strip(0.0, 0.5)
    stated = replace(ACROSS, gap=0.3)
    [gap], [failure] = measured(shapes, cut_back(shapes, 10.0), stated)
    assert failure == f"Seam 'A' to 'B': the gap is {gap:.6g} mm, 0.3 mm are stated."


@pytest.mark.parametrize("what", ["corners", "cuts"])
def test_a_fit_that_does_not_lie_on_the_faces_in_the_file_is_not_found(what):
    shapes = strip(0.05, 0.5)
    cut = cut_back(shapes, 10.0)
    one, other = (expected(shape, own) for shape, own in zip(shapes, cut, strict=True))
    assert one.fitted is not None
    if what == "corners":
        wrong = replace(one.fitted, corners=one.fitted.corners + np.array([0.0, 0.0, 1e-3]))
    else:
        wrong = replace(one.fitted, cuts=one.fitted.cuts * [[[1.0], [0.0]]])
    [gap], failures = measured(shapes, cut, panels=[replace(one, fitted=wrong), other])
    assert gap == float("inf")
    assert failures == ["Seam 'A' to 'B': an edge cannot be found on the skins."]


def test_how_far_a_point_lies_from_a_surface():
    cone = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 10.0, np.pi / 4, 1.0])
    plane = np.array([0.0, 0.0, 5.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0])
    assert off_surface(cone, np.array([12.0, 0.0, 2.0])) == pytest.approx(0.0, abs=1e-12)
    assert off_surface(cone, np.array([10.0, 0.0, 2.0])) == pytest.approx(np.sqrt(2.0))
    assert off_surface(plane, np.array([3.0, 4.0, 2.0])) == pytest.approx(3.0)
    assert np.isnan(off_surface(np.full(9, np.nan), np.zeros(3)))
