"""Shapes as STEP entities: each vertex, edge and face once, every edge twice in a solid, and only what is exact."""

import io
import re
from collections import Counter

import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere

from cadpanel.brep.building.sheet import build_skin, build_solid
from cadpanel.brep.step.text import StepText
from cadpanel.brep.step.topology import TopologyWriter, UnsupportedGeometry
from tests.known_faces import flat
from tests.shapes import folded_panel


def written(shape):
    file = io.StringIO()
    number = TopologyWriter(StepText(file)).item(shape)
    lines = [line.partition("=")[2] for line in file.getvalue().split(";\n")[:-1]]
    kinds = Counter(word for line in lines for word in re.findall(r"^\(?(\w+)", line))
    return lines, number, kinds


def used(lines, kind, place):
    """What the instances of a kind refer to in one of their places, counted."""
    pattern = re.compile(rf"^{kind}\((.*)\)$", re.DOTALL)
    found = (pattern.match(line) for line in lines)
    return Counter(one[1].split(",")[place] for one in found if one)


@pytest.mark.parametrize("thickness", [3.0, 10.0])
def test_a_solid_writes_everything_once_and_uses_every_edge_twice(thickness):
    lines, number, kinds = written(build_solid(folded_panel(), thickness))
    faces, edges, vertices = kinds["ADVANCED_FACE"], kinds["EDGE_CURVE"], kinds["VERTEX_POINT"]
    assert lines[number - 1].startswith("MANIFOLD_SOLID_BREP")
    assert faces - edges + vertices == 2  # Euler: one shell without a hole
    assert set(used(lines, "ORIENTED_EDGE", 3).values()) == {2}
    # Once each way.
    assert {*Counter(line for line in lines if line.startswith("ORIENTED_EDGE")).values()} == {1}
    # Every edge on a cone or cylinder carries its parameter curves.
    assert kinds["PCURVE"] == kinds["DEFINITIONAL_REPRESENTATION"]
    assert kinds["PCURVE"] >= 4 * (kinds["CONICAL_SURFACE"] + kinds["CYLINDRICAL_SURFACE"])


def test_a_skin_is_an_open_shell_with_a_border_that_is_used_once():
    lines, number, kinds = written(build_skin(folded_panel()))
    assert lines[number - 1].startswith("SHELL_BASED_SURFACE_MODEL")
    assert kinds["ADVANCED_FACE"] - kinds["EDGE_CURVE"] + kinds["VERTEX_POINT"] == 1
    assert set(used(lines, "ORIENTED_EDGE", 3).values()) == {1, 2}


def test_a_box_has_its_corners_to_the_last_digit():
    lines, _, kinds = written(BRepPrimAPI_MakeBox(100.0, 200.0, 300.1).Shape())
    assert (kinds["ADVANCED_FACE"], kinds["EDGE_CURVE"], kinds["VERTEX_POINT"], kinds["PCURVE"]) == (6, 12, 8, 0)
    points = re.findall(r"CARTESIAN_POINT\('',\(([^)]*)\)\)", "\n".join(lines))
    found = np.unique(np.array([[float(one) for one in point.split(",")] for point in points]), axis=0)
    corners = np.array([(x, y, z) for x in (0.0, 100.0) for y in (0.0, 200.0) for z in (0.0, 300.1)])
    assert {tuple(corner) for corner in corners} <= {tuple(one) for one in found}


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        (BRepPrimAPI_MakeSphere(10.0).Shape(), "a face on a Geom_SphericalSurface"),
        (flat([(0, 0, 0), (1, 0, 0), (0, 1, 0)]), "neither a solid with one shell nor a shell"),
    ],
    ids=["sphere", "face"],
)
def test_other_shapes_are_refused(shape, said):
    with pytest.raises(UnsupportedGeometry, match=said):
        written(shape)
