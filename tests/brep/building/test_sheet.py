"""Skins and sheets are exact, closed, valid and of the volume that the formulas give."""

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SHELL
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from cadpanel.brep.building.sheet import build_panel, build_skin, build_solid, volume_of
from cadpanel.brep.proof.inspection import inspect
from cadpanel.errors import PanelError
from cadpanel.geometry.kink import edge_angles, surface_normals
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.geometry.volume import sheet_volume
from tests.shapes import CHAINS, folded_panel, random_panel

pytestmark = pytest.mark.each_value_once

HALF_ANGLES = [0.0, 1e-12, 1e-9, 1e-6, 5e-6, 1e-4, 1e-2, 0.1]
RELATIVE = 2e-12
TANGENCY = 1e-11  # rad


def exactly_valid(shape):
    return BRepCheck_Analyzer(shape, True, False, True).IsValid()


def area_of(shape):
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties)
    return properties.Mass()


def shell_of(solid):
    return TopoDS.Shell_s(TopExp_Explorer(solid, TopAbs_SHELL).Current())


def check(shape, thickness, skin_side="outer"):
    built = shape.straightened().shape
    solid, skin = build_solid(shape, thickness, skin_side), build_skin(shape)
    assert exactly_valid(solid)
    assert exactly_valid(skin)
    assert BRep_Tool.IsClosed_s(shell_of(solid))
    assert volume_of(solid) == pytest.approx(sheet_volume(built, thickness, skin_side), rel=RELATIVE)
    assert area_of(skin) == pytest.approx(built.area(), rel=RELATIVE)
    for facts in (inspect("solid", solid), inspect("skin", skin)):
        angles = edge_angles(facts.straight_edges, facts.edge_surfaces)
        assert angles[angles < 0.1].max(initial=0.0) < TANGENCY
    return solid, skin


@pytest.mark.parametrize("chain", sorted(CHAINS))
@pytest.mark.parametrize("concave", [False, True])
@pytest.mark.parametrize("skin_side", ["outer", "inner"])
def test_every_chain_becomes_an_exact_solid(chain, concave, skin_side):
    for seed in range(4):
        check(random_panel(seed, chain=chain, concave=concave), 3.0, skin_side)


@pytest.mark.parametrize("half_angle", [*HALF_ANGLES, *(-angle for angle in HALF_ANGLES[1:])])
@pytest.mark.parametrize("concave", [False, True])
def test_every_half_angle_becomes_an_exact_solid(half_angle, concave):
    for seed, chain in ((1, "plane-cone-plane"), (2, "cone"), (3, "cone-plane-cone")):
        solid, _ = check(random_panel(seed, chain=chain, half_angle=half_angle, concave=concave), 3.0)
        kind = "cylinder" if abs(half_angle) <= 5e-6 else "cone"
        assert inspect("solid", solid).face_kinds[kind] == 2 * CHAINS[chain].count("c")


@pytest.mark.parametrize("seed", range(6))
def test_cuts_mitred_by_forty_degrees_are_exact(seed):
    check(random_panel(seed, mitre=0.7), 3.0)


@pytest.mark.parametrize("seed", range(4))
def test_thick_sheets_are_exact(seed):
    check(random_panel(seed), 80.0)
    check(random_panel(seed), 80.0, "inner")


@pytest.mark.parametrize("sweep", [0.01, 0.5, 1.6, 1.75, 2.5, 3.1])
def test_sweeps_up_to_half_a_turn_are_exact(sweep):
    check(folded_panel(sweep=sweep, half_angle=0.05), 3.0)


@pytest.mark.parametrize("sweep", [0.006, 0.03])
@pytest.mark.parametrize("radius", [2e4, 5e4, 1e5, -5e4])
@pytest.mark.parametrize("half_angle", [0.0, 1e-6, 0.5])
def test_gentle_bends_of_large_radius_are_exact(radius, sweep, half_angle):
    # Rounding rules their parameter curves: more poles would make these worse, not better.
    bend = sweep if radius > 0.0 else -sweep
    check(folded_panel(radius=radius, sweep=bend, half_angle=half_angle, chain="c", widths=(), turns=()), 3.0)


@pytest.mark.parametrize("seed", range(6))
def test_a_solid_has_two_skins_and_four_walls_and_nothing_else(seed):
    shape = random_panel(seed)
    facts = inspect("solid", build_solid(shape, 3.0))
    assert facts.face_kinds == {"plane": 8, "cone": 2, "cylinder": 0, "other": 0}
    assert facts.solids == facts.shells == 1
    assert facts.closed
    assert len(facts.vertices) == 16


@pytest.mark.parametrize("concave", [False, True])
@pytest.mark.parametrize("half_angle", [0.02, -0.02, 0.0])
def test_skin_faces_look_outwards(concave, half_angle):
    shape = random_panel(5, concave=concave, half_angle=half_angle)
    facts = inspect("skin", build_skin(shape))
    for edge, surfaces in zip(facts.straight_edges, facts.edge_surfaces, strict=True):
        ruling = np.abs(np.linalg.norm(shape.corners()[0] - edge[0], axis=1)).argmin()
        normals = surface_normals(edge[:1], surfaces)
        assert normals @ shape.normals[ruling] == pytest.approx([1.0, 1.0], abs=1e-9)


def test_the_skin_is_the_outer_or_the_inner_face_of_the_sheet():
    shape = random_panel(8)
    sides: list[tuple[SkinSide, float]] = [("outer", -3.0), ("inner", 3.0)]
    for skin_side, distance in sides:
        vertices = inspect("solid", build_solid(shape, 3.0, skin_side)).vertices
        for corners in (shape.corners(), shape.offset(distance).corners()):
            apart = np.linalg.norm(vertices[:, None] - corners.reshape(1, -1, 3), axis=-1).min(axis=0)
            assert apart.max() < 1e-9


@pytest.mark.parametrize("skin_side", ["outer", "inner"])
def test_skin_and_sheet_built_at_once_are_those_built_alone(skin_side):
    shape = random_panel(6, half_angle=1e-6)
    built = build_panel(shape, 3.0, skin_side)
    assert built.straightened.patches == (1,)
    assert exactly_valid(built.skin)
    assert exactly_valid(built.solid)
    assert inspect("p", built.skin).vertices == pytest.approx(inspect("p", build_skin(shape)).vertices)
    assert volume_of(built.solid) == pytest.approx(volume_of(build_solid(shape, 3.0, skin_side)), rel=1e-14)


def test_what_cannot_be_built_is_refused_by_name():
    with pytest.raises(PanelError, match=r"'A-01'.*thicker"):
        build_solid(folded_panel(), 250.0)
    with pytest.raises(PanelError, match=r"'A-01'.*inside out"):
        build_skin(folded_panel(sweep=-1.0))


def test_a_nearly_cylindrical_cone_keeps_its_exact_neighbours():
    shape = random_panel(4, half_angle=4e-6)
    facts = inspect("skin", build_skin(shape))
    assert [isinstance(patch, ConePatch) for patch in shape.patches] == [False, True, False]
    assert facts.face_kinds == {"plane": 2, "cone": 0, "cylinder": 1, "other": 0}
    assert np.linalg.norm(facts.vertices[:, None] - shape.corners().reshape(-1, 3), axis=-1).min(axis=1).max() < 0.01
