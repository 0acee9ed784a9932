"""Clear widths are measured on what a file holds: between walls, parallel or not, and what is not as asked fails."""

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.proof.clearances import Clear, clearances
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam
from cadpanel.brep.proof.inspection import inspect
from cadpanel.geometry.joints import cut_to_seams
from tests.joined import leaning, polygon, quadrilaterals, seams
from tests.shapes import folded_panel, moved

CLOSE = 1e-8


def measured(shapes, wanted, joint, thickness=3.0):
    """Clear widths, and what fails."""
    facts = {shape.name: inspect(shape.name, build_solid(shape, thickness)) for shape in shapes}
    panels = [ExpectedPanel(name=shape.name, volume=1.0, kinds=(), corners=shape.corners()) for shape in shapes]
    failures: list[str] = []
    return clearances(panels, facts, wanted, joint, failures), failures


def between(shapes, found):
    return [
        ExpectedSeam(panels=(shapes[seam.panels[0]].name, shapes[seam.panels[1]].name), edges=seam.edges)
        for seam in found
    ]


@pytest.mark.parametrize("thickness", [3.0, 20.0])
def test_joints_all_round_are_as_wide_as_they_were_made(thickness):
    panels = quadrilaterals()
    cut = cut_to_seams(panels, seams(panels), 10.0, -thickness).shapes
    found, failures = measured(cut, between(panels, seams(panels)), 10.0, thickness)
    assert failures == []
    assert [(one.least, one.largest) for one in found if one] == 12 * [pytest.approx((10.0, 10.0), abs=CLOSE)]


def strip(gap, turn=0.0):
    """Two folded panels in a row, so far apart, the second one's end turned by so much."""
    one, other = folded_panel(name="A"), moved(folded_panel(name="B"), (1000.0 + gap, 0.0, 0.0))
    return [one, other.cut_back({"end 0": leaning(other, "end 0", 0.0, 0.0, turn)}, -3.0)]


ACROSS = ExpectedSeam(panels=("A", "B"), edges=("end 1", "end 0"))


def test_the_ends_of_folded_panels_are_measured_along_their_arcs():
    [clear], failures = measured(strip(4.0), [ACROSS], 4.0)
    assert failures == []
    assert (clear.least, clear.largest) == pytest.approx((4.0, 4.0), abs=CLOSE)


def test_a_joint_that_tapers_is_told_by_its_narrowest_and_widest_places():
    turn = 0.01
    shapes = strip(10.0, turn)
    [clear], failures = measured(shapes, [ACROSS], 5.0)
    corners = np.concatenate([face.corners()[0] for face in (shapes[1], shapes[1].offset(-3.0))])
    assert failures == []
    assert clear.largest == pytest.approx(corners[:, 0].max() - 500.0, abs=0.01)
    assert 5.0 < clear.least <= corners[:, 0].min() - 500.0 + CLOSE


def test_a_way_across_shows_that_walls_that_are_not_parallel_keep_apart():
    # Side by side, and lower by a step: a corner of one lies where the plane of the other's leaning wall has come near.
    flat = polygon("A", np.array([[0.0, 0.0, 0.0], [900.0, 0.0, 0.0], [900.0, 900.0, 0.0], [0.0, 900.0, 0.0]]))
    beside = polygon("B", flat.outline + np.array([910.0, 0.0, -40.0]))
    shapes = [flat.cut_back({"edge 1": leaning(flat, "edge 1", 0.0, 0.2)}, -3.0), beside]
    seam = ExpectedSeam(panels=("A", "B"), edges=("edge 1", "edge 3"))
    [alone], _ = measured(shapes, [seam], 0.0)
    told = ExpectedSeam(panels=("A", "B"), edges=("edge 1", "edge 3"), across=np.array([1.0, 0.0, 0.0]))
    [seen], failures = measured(shapes, [told], 9.4)
    assert failures == []
    assert alone.least < 6.0
    assert seen.least == pytest.approx(9.4, abs=CLOSE)


@pytest.mark.parametrize(
    ("stated", "joint", "sentence"),
    [
        ((4.0, 4.0), 4.1, "Seam 'A' to 'B': the joint is only 4 mm wide, 4.1 mm were asked for."),
        ((3.9, 4.0), 4.0, "Seam 'A' to 'B': the joint is 4 to 4 mm wide, 3.9 to 4 mm are stated."),
        ((4.0, 4.1), 4.0, "Seam 'A' to 'B': the joint is 4 to 4 mm wide, 4 to 4.1 mm are stated."),
        ((4.0, 4.0), 4.0, None),
    ],
)
def test_what_is_not_as_asked_or_stated_is_named(stated, joint, sentence):
    wanted = ExpectedSeam(panels=("A", "B"), edges=("end 1", "end 0"), clear=stated)
    found, failures = measured(strip(4.0), [wanted], joint)
    assert found == [Clear(4.0, 4.0)]
    assert failures == ([] if sentence is None else [sentence])


@pytest.mark.parametrize("edges", [("end 1", "end 7"), ("edge 0", "end 0")])
def test_an_edge_that_is_not_there_has_no_wall(edges):
    found, failures = measured(strip(4.0), [ExpectedSeam(panels=("A", "B"), edges=edges)], 4.0)
    assert found == [None]
    assert failures == ["Seam 'A' to 'B': a wall of the sheets cannot be found."]


def test_a_wall_is_found_beside_a_flange_that_is_narrower_than_the_sheet():
    shape = folded_panel(name="A", widths=(1.5, 200.0))
    beside = polygon(
        "B", shape.corners()[[0, 0, 1, 1], [0, 0, 0, 0]] + np.array([[0, 2, 0], [0, 900, 0], [0, 900, 0], [0, 2, 0]])
    )
    seam = ExpectedSeam(panels=("A", "B"), edges=("side 0", "edge 3"))
    [clear], failures = measured([shape, beside], [seam], 2.0)
    assert failures == []
    assert (clear.least, clear.largest) == pytest.approx((2.0, 2.0), abs=CLOSE)
