"""Panels built and written, and held against their formulas."""

from __future__ import annotations

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from cadpanel.brep.building.sheet import build_panel, volume_of
from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.step.file import read_step_shapes, write_step
from cadpanel.geometry.kink import edge_angles
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.volume import sheet_volume

RELATIVE = 1e-12
TANGENCY = 1e-11  # rad
# Vertices keep their digits in the file, mm.
WRITTEN = 1e-11


def check_exact(shape, thickness, skin_side, relative=RELATIVE):
    """Build a panel and hold it against its formulas; returns what was built."""
    built = build_panel(shape, thickness, skin_side)
    own = built.straightened.shape
    assert exactly_valid(built.solid)
    assert exactly_valid(built.skin)
    assert BRep_Tool.IsClosed_s(TopoDS.Shell_s(TopExp_Explorer(built.solid, TopAbs_SHELL).Current()))
    assert volume_of(built.solid) == pytest.approx(sheet_volume(own, thickness, skin_side), rel=relative)
    assert area_of(built.skin) == pytest.approx(own.area(), rel=RELATIVE)
    solid, skin = inspect("solid", built.solid), inspect("skin", built.skin)
    walls = len(own.outline) if isinstance(own, PolygonShape) else 4
    expected = kinds(own)
    assert skin.face_kinds == expected
    assert solid.face_kinds == {kind: 2 * count + walls * (kind == "plane") for kind, count in expected.items()}
    smooth = len(own.patches) - 1
    for facts, ways in ((solid, 2), (skin, 1)):
        angles = edge_angles(facts.straight_edges, facts.edge_surfaces)
        assert np.sum(angles < TANGENCY) == ways * smooth
        assert np.sum(angles < 0.1) == ways * smooth
    assert len(skin.straight_edges) == smooth
    corners = own.corners().reshape(-1, 3)
    assert len(solid.vertices) == 2 * len(skin.vertices) == 2 * len(corners)
    assert np.linalg.norm(skin.vertices[:, None] - corners, axis=-1).min(axis=0).max() < 1e-9
    return built


def assert_written_as_it_is(path, shape):
    """Write a panel's skin and sheet, read them back, and find the same."""
    built = build_panel(shape, 3.0)
    for kind, before in ((TopAbs_SOLID, built.solid), (TopAbs_SHELL, built.skin)):
        write_step(path, [(shape.name, before, None)], title="t")
        [(name, after)] = read_step_shapes(path)
        assert name == shape.name
        assert after.ShapeType() == kind
        assert exactly_valid(after)
        one, other = inspect("p", before), inspect("p", after)
        assert other.face_kinds == one.face_kinds
        assert np.linalg.norm(other.vertices[:, None] - one.vertices, axis=-1).min(axis=0).max() < WRITTEN
        if kind == TopAbs_SOLID:
            assert volume_of(after) == pytest.approx(volume_of(before), rel=RELATIVE)


def exactly_valid(shape):
    return BRepCheck_Analyzer(shape, True, False, True).IsValid()


def area_of(shape):
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties)
    return properties.Mass()


def kinds(shape):
    """How many faces of each kind the skin has, as it is built."""
    cones = [patch for patch in shape.patches if isinstance(patch, ConePatch)]
    tapered = sum(patch.half_angle != 0.0 for patch in cones)
    return {
        "plane": len(shape.patches) - len(cones),
        "cone": tapered,
        "cylinder": len(cones) - tapered,
        "other": 0,
    }
