"""The certificate on seams along any edge: sides of chains, edges of polygons, and both at one seam."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_skin, build_solid
from cadpanel.brep.proof.certificate import certify
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam, PatchKind
from cadpanel.brep.step.file import write_step
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.volume import sheet_volume
from tests.instances import random_polygon
from tests.shapes import folded_panel, moved
from tests.thorough import thorough

THICKNESS = 3.0
GAP = 0.25
UP = np.array([0.0, 0.0, 1.0])


def expected(shape: PanelShape | PolygonShape) -> ExpectedPanel:
    kinds: list[PatchKind] = ["cylinder" if isinstance(patch, ConePatch) else "plane" for patch in shape.patches]
    if isinstance(shape, PolygonShape):
        far = np.array([[shape.outline[0] - THICKNESS * shape.normal, shape.normal]])
    else:
        flat = [i for i, patch in enumerate(shape.patches) if not isinstance(patch, ConePatch)]
        far = np.array([[shape.points[i] - THICKNESS * shape.normals[i], shape.normals[i]] for i in flat])
    volume = sheet_volume(shape, THICKNESS)
    return ExpectedPanel(
        name=shape.name, volume=volume, kinds=tuple(kinds), corners=shape.corners(), far_planes=far.reshape(-1, 2, 3)
    )


def certified(folder, shapes, seams, wanted=None):
    """The certificate of shapes as they are written, against those that were wanted."""
    files = folder / "panels.step", folder / "skins.step"
    write_step(files[0], [(shape.name, build_solid(shape, THICKNESS), None) for shape in shapes], title="t")
    write_step(files[1], [(shape.name, build_skin(shape), None) for shape in shapes], title="t")
    return certify(*files, [expected(shape) for shape in wanted or shapes], seams)


def rows() -> list[PanelShape]:
    """Two folded panels side by side; the second one's first flange continues the first one's last."""
    one = folded_panel(name="A")
    b, n = one.binormals()[-1], one.normals[-1]
    # The frame (x, b, n) of the last ruling takes the place of the first one's (x, -y, z).
    turn = np.stack([one.directions[0], b, n], axis=1) @ np.diag([1.0, -1.0, 1.0])
    shift = one.points[-1] + GAP * b
    other = replace(
        one,
        name="B",
        points=one.points @ turn.T + shift,
        directions=one.directions @ turn.T,
        normals=one.normals @ turn.T,
        cut_points=one.cut_points @ turn.T + shift,
        cut_normals=one.cut_normals @ turn.T,
    )
    return [one, other]


ROWS = ExpectedSeam(panels=("A", "B"), edges=("side 1", "side 0"), gap=GAP)


def tiles() -> list[PolygonShape]:
    """A square and a pentagon in one plane, a quarter of a millimetre apart."""
    shift = np.array([800.0 + GAP, 0.0, 0.0])
    square = np.array([[0.0, 0.0, 0.0], [800.0, 0.0, 0.0], [800.0, 600.0, 0.0], [0.0, 600.0, 0.0]])
    house = np.array([[0.0, 0.0, 0.0], [500.0, 0.0, 0.0], [700.0, 300.0, 0.0], [500.0, 600.0, 0.0], [0.0, 600.0, 0.0]])
    return [
        PolygonShape(name="A", feature="planar-polygon", outline=square, normal=UP),
        PolygonShape(name="B", feature="planar-polygon", outline=house + shift, normal=UP),
    ]


TILES = ExpectedSeam(panels=("A", "B"), edges=("edge 1", "edge 4"), gap=GAP)

every_neighbourhood = pytest.mark.parametrize(
    ("shapes", "seam"), [(rows(), ROWS), (tiles(), TILES)], ids=["rows", "tiles"]
)


@thorough
@every_neighbourhood
def test_a_seam_along_sides_or_polygon_edges_is_measured(tmp_path, shapes, seam):
    found = certified(tmp_path, shapes, [seam])
    assert found.failures == ()
    assert found.seam_gaps == pytest.approx([GAP], abs=1e-9)
    assert found.max_corner_error < 1e-9
    assert found.volume_error < 1e-12


@every_neighbourhood
def test_such_a_seam_is_no_wider_than_stated(tmp_path, shapes, seam):
    assert certified(tmp_path, shapes, [replace(seam, gap=GAP - 5e-5)]).holds
    [failure] = certified(tmp_path, shapes, [replace(seam, gap=GAP - 2e-4)]).failures
    assert failure == "Seam 'A' to 'B': the gap is 0.25 mm, 0.2498 mm are stated."


@every_neighbourhood
def test_the_wrong_edge_of_a_panel_is_far_away(tmp_path, shapes, seam):
    wrong = ("side 0", "side 0") if seam is ROWS else ("edge 0", "edge 4")
    found = certified(tmp_path, shapes, [replace(seam, edges=wrong)])
    assert not found.holds
    assert found.max_seam_gap > 100.0


@every_neighbourhood
@pytest.mark.parametrize("edge", ["edge 5", "end 2", "side 7", ""])
def test_an_edge_that_a_panel_does_not_have_fails_and_stops_nothing(tmp_path, shapes, seam, edge):
    found = certified(tmp_path, shapes, [replace(seam, edges=(edge, seam.edges[1])), seam])
    assert found.failures == ("Seam 'A' to 'B': an edge cannot be found on the skins.",)
    assert found.seam_gaps == (np.inf, pytest.approx(GAP, abs=1e-9))


def test_a_chain_and_a_polygon_may_share_a_seam(tmp_path):
    plate = folded_panel(name="A", chain="p", widths=(400.0,), turns=(0.0,))
    corners = plate.corners()
    first, last = corners[:, -1] + [0.0, -GAP, 0.0]
    point = 0.5 * (first + last) + [0.0, -300.0, 0.0]
    gable = PolygonShape(name="B", feature="planar-polygon", outline=np.array([last, first, point]), normal=UP)
    found = certified(tmp_path, [plate, gable], [ExpectedSeam(panels=("A", "B"), edges=("side 1", "edge 0"), gap=GAP)])
    assert found.failures == ()
    assert found.seam_gaps == pytest.approx([GAP], abs=1e-9)


@pytest.mark.parametrize("corners", [3, 5, 6])
def test_a_polygon_that_was_moved_or_has_another_thickness_fails(tmp_path, corners):
    shape = random_polygon(3, corners)
    assert certified(tmp_path, [shape], []).holds
    away = replace(shape, outline=shape.outline + 0.01 * shape.normal)
    found = certified(tmp_path, [away], [], [shape])
    assert any("a corner 0.01 mm away" in failure for failure in found.failures)
    assert any("the far face of its solid does not lie where" in failure for failure in found.failures)


def test_a_polygon_with_a_corner_less_fails(tmp_path):
    shape = random_polygon(3, 6)
    found = certified(tmp_path, [replace(shape, outline=shape.outline[:5])], [], [shape])
    assert any("has the faces 7 plane, expected 8 plane" in failure for failure in found.failures)
    assert any("has a corner" in failure for failure in found.failures)


def test_a_sheet_on_the_wrong_side_of_a_polygon_fails(tmp_path):
    shape = random_polygon(4, 5)
    away = replace(shape, normal=-shape.normal, outline=shape.outline[::-1])
    found = certified(tmp_path, [away], [], [shape])
    assert found.max_corner_error < 1e-9
    assert any("the far face of its solid does not lie where" in failure for failure in found.failures)


def test_panels_may_meet_all_round(tmp_path):
    """Four plates about a point: every one meets a neighbour along an end and another along a side."""
    plate = folded_panel(chain="p", widths=(1000.0,), turns=(0.0,))
    shapes = [replace(moved(plate, (1000.0 * i, -1000.0 * j, 0.0)), name=f"P{i}{j}") for i in (0, 1) for j in (0, 1)]
    seams = [ExpectedSeam(panels=(f"P0{j}", f"P1{j}"), edges=("end 1", "end 0"), gap=0.0) for j in (0, 1)]
    seams += [ExpectedSeam(panels=(f"P{i}0", f"P{i}1"), edges=("side 1", "side 0"), gap=0.0) for i in (0, 1)]
    found = certified(tmp_path, shapes, seams)
    assert found.failures == ()
    assert found.max_seam_gap < 1e-9


@pytest.mark.parametrize("turn", [0.001, 0.08])
def test_a_polygon_may_hardly_turn_at_a_corner(tmp_path, turn):
    # The walls beside such a corner meet almost smoothly, which nobody promised of them.
    outline = np.array([[0.0, 0.0, 0.0], [500.0, -500.0 * turn, 0.0], [1000.0, 0.0, 0.0], [500.0, 700.0, 0.0]])
    kite = PolygonShape(name="A", feature="planar-polygon", outline=outline, normal=UP)
    assert certified(tmp_path, [kite], []).failures == ()
