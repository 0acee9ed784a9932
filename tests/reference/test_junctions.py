"""Brick bonds: panels whose sides meet two others each, parted at the corners of those."""

from itertools import pairwise

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import RawPanel
from tests.reference_shapes import polygon_face, raw_grid, sheet_of, shuffled

CLOSE = 1e-6  # mm
ROWS = 4
VAULT = sheet_of(lambda _, v: 1200.0 * np.cos(1.2 * (v - 0.5)))  # its rows are straight along u
# Every second row begins with half a brick; three whole ones fill a row.
BRICKS = [np.linspace(0.0, 1.0, 4), np.array([0.0, 1.0, 3.0, 5.0, 6.0]) / 6.0]


def bond(surface=VAULT):
    """The bricks row by row, and how many meet along and across."""
    panels = []
    for row in range(ROWS):
        joints = BRICKS[row % 2].tolist()
        for place, (first, last) in enumerate(pairwise(joints)):
            low, high = row / ROWS, (row + 1) / ROWS
            corners = np.array([[first, low], [last, low], [last, high], [first, high]])
            panels.append(RawPanel(name=f"{row}/{place}", faces=(polygon_face(surface, corners),)))
    return panels


def seams_between(reference):
    return {frozenset(reference.panels[panel].name for panel in seam.panels) for seam in reference.seams}


def expected():
    """Bricks of one row that follow each other, and those of two rows that share more than a corner."""
    found = set()
    for row in range(ROWS):
        joints = BRICKS[row % 2]
        found |= {frozenset((f"{row}/{place}", f"{row}/{place + 1}")) for place in range(len(joints) - 2)}
        if row + 1 < ROWS:
            above = BRICKS[(row + 1) % 2]
            for one in range(len(joints) - 1):
                for other in range(len(above) - 1):
                    if min(joints[one + 1], above[other + 1]) - max(joints[one], above[other]) > 1e-9:
                        found.add(frozenset((f"{row}/{one}", f"{row + 1}/{other}")))
    return found


def test_without_junctions_bricks_meet_in_their_rows_only_and_a_note_tells():
    reference = assemble(bond(), "bricks.step")
    assert all(len({name.split("/")[0] for name in pair}) == 1 for pair in seams_between(reference))
    (note,) = reference.notes
    assert "--junctions" in note


def test_junctions_make_a_seam_of_every_part_that_two_bricks_share():
    reference = assemble(bond(), "bricks.step", junctions=True)
    assert seams_between(reference) == expected()
    assert reference.notes == ()


def test_parted_sides_are_as_long_as_whole_ones():
    whole, parted = (assemble(bond(), "bricks.step", junctions=junctions) for junctions in (False, True))

    def around(panel):
        return sum(np.linalg.norm(np.diff(side, axis=0), axis=1).sum() for side in panel.edges)

    for one, other in zip(whole.panels, parted.panels, strict=True):
        assert len(other.edges) >= len(one.edges) == 4
        assert around(other) == pytest.approx(around(one), rel=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_neither_order_nor_direction_of_faces_and_edges_matters(seed):
    random = np.random.default_rng(seed)
    panels = [shuffled(panel, random) for panel in bond()]
    mixed = [panels[index] for index in random.permutation(len(panels))]
    assert seams_between(assemble(mixed, "bricks.step", junctions=True)) == expected()


def test_where_sides_meet_as_wholes_nothing_is_parted():
    grid = raw_grid(VAULT, 3, 3)
    plain, asked = (assemble(grid, "grid.step", junctions=junctions) for junctions in (False, True))
    assert [len(panel.edges) for panel in asked.panels] == 9 * [4]
    assert asked.seams == plain.seams


def test_flat_bricks_on_a_vault_close():
    bricks = assemble(bond(), "bricks.step", junctions=True)
    result = cp.fit(bricks, feature="planar-polygon", gap_tolerance=0.1)
    assert result.tolerance_met
    assert result.measures.max_seam_gap < 0.1


def test_a_triangle_with_a_single_junction_stays_whole_and_the_note_tells_what_helps():
    flat = sheet_of(lambda x, _: 0.0 * x, 1.0, 1.0)
    triangle = np.array([[0.0, 0.0], [4000.0, 0.0], [2000.0, 3000.0]])
    below = [np.array([[x, -1000.0], [x + 2000.0, -1000.0], [x + 2000.0, 0.0], [x, 0.0]]) for x in (0.0, 2000.0)]
    halves = [np.array([[0.0, 0.0], [2000.0, 0.0], [2000.0, 3000.0]]), np.array([[2000.0, 0.0], *triangle[1:]])]

    def assembled(*parts):
        panels = [RawPanel(name=f"P{n}", faces=(polygon_face(flat, part),)) for n, part in enumerate(parts)]
        return assemble(panels, "gable.step", junctions=True)

    whole = assembled(triangle, *below)
    assert len(whole.seams) == 1
    (note,) = whole.notes
    assert note.endswith("a triangle with a single corner of others on its sides stays whole, so cut it in two there.")
    parted = assembled(*halves, *below)
    assert len(parted.seams) == 4
    assert parted.notes == ()
