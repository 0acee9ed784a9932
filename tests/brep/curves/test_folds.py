"""Lines that turn back along themselves are drawn straight on; those that turn back beside themselves stay."""

import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeSphere
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cadpanel.brep.curves.folds import kept_unfolded, turns_back
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.kernel.tolerances import CLOSE
from tests.drawn import plate
from tests.known_faces import hem
from tests.reference_shapes import kernel_face

MOST_NOISE = 1e-11


@pytest.fixture(scope="module")
def patch():
    return patch_of(plate())


def left(patch, line):
    return kept_unfolded(patch, np.array(line, dtype=float)).tolist()


def test_line_that_goes_one_way_keeps_all_its_points(patch):
    assert left(patch, [(0, 0), (1, 0), (2, 0.1), (3, 0.5), (3, 2)]) == [0, 1, 2, 3, 4]


def test_line_that_turns_back_along_itself_is_drawn_straight_on(patch):
    assert left(patch, [(0, 0), (5, 0), (4, 0), (9, 0)]) == [0, 3]
    assert left(patch, [(0, 0), (5, 0), (4.5, 0), (4, 0), (4.6, 0), (9, 0), (9, 5)]) == [0, 2, 4, 5, 6]
    assert left(patch, [(0, 0), (5, 0), (4.5, 0), (4, 0), (4.4, 0), (9, 0), (9, 5)]) == [0, 5, 6]


def test_line_that_turns_back_at_an_end_keeps_the_end(patch):
    assert left(patch, [(5, 0), (4.9, 0), (9, 0)]) == [0, 2]
    assert left(patch, [(0, 0), (5, 0), (4.9, 0)]) == [0, 2]


@pytest.mark.parametrize(("width", "tip"), [(0.9 * CLOSE, []), (1.1 * CLOSE, [1])])
def test_line_that_turns_back_beside_itself_keeps_its_tip(patch, width, tip):
    assert left(patch, [(0, 0), (5, 0), (3, width)]) == [0, *tip, 2]
    assert left(patch, [(3, width), (5, 0), (0, 0)]) == [0, *tip, 2]


def test_line_over_a_pole_does_not_turn_back():
    patch = patch_of(TopoDS.Face_s(shapes_of(BRepPrimAPI_MakeSphere(1000.0).Shape(), TopAbs_FACE)[0]))
    line = np.array([(1.0, 0.5), (1.0, np.pi / 2), (1.0 + np.pi, 0.5)])
    assert kept_unfolded(patch, line).tolist() == [0, 1, 2]


def test_rounding_does_not_tell_whether_a_line_turns_back():
    patch = patch_of(kernel_face(hem(10.0), (0.0, 1.0), 60))
    random = np.random.default_rng(3)
    at = patch.at(0, random.uniform(0.4, 0.6, 500), random.uniform(size=500))
    way = random.uniform(-0.005, 0.005, (500, 2))
    for part, back in ((0.1, True), (1.0, True), (8.0, True), (-0.1, False), (-1.0, False)):
        before, after = (at + step + MOST_NOISE * random.normal(size=at.shape) for step in (part * way, way))
        assert (turns_back(patch, before, at, after) == back).all()
