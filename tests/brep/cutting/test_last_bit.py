"""Whether cuts hold, and how the panels are called, does not hang on the last bit of what was drawn.

Another processor adds in another order: what lies exactly on something comes to lie on either side of it.
"""

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Ax3, gp_Dir, gp_Pln, gp_Pnt
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cadpanel.brep.curves.polyline_smoothing import corners
from cadpanel.brep.cutting.cut_panel import middle_of
from cadpanel.brep.cutting.panel_names import Link, place_names
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.errors import ReferenceFileError
from tests.cuts import model_of, panels_of
from tests.drawn import LENGTH, WIDTH, curve, cut, plate, polyline
from tests.known_faces import hem, spiral
from tests.model_files import STRIP, strip_faces
from tests.reference_shapes import kernel_face
from tests.thorough import cases

pytestmark = pytest.mark.each_value_once

# Parts of the numbers by which what is drawn differs from draw to draw.
NOISES = cases((1e-15, 1e-12), (1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11))
POINTS = 400
NOISE_OF_SIDES = 1e-14
SAME_PLACE = 0.1  # mm; as far as the smooth curve that a fine polyline stands for is left open by its facets


def layered(surface, poles=60, parts=(0.3, 0.6), count=POINTS):
    """A sheet that lies on itself, with polylines across all its layers."""
    face = kernel_face(surface, (0.0, 1.0), poles)
    patch = patch_of(face)
    along = np.linspace(0.0, 1.0, count)
    return [face], polyline_of, [patch.points(patch.at(0, along, np.array([part]))) for part in parts]


def polyline_of(points):
    return polyline(*points)


def on_plate(*lines):
    return [plate()], polyline_of, [np.array([(*place, 0.0) for place in line], dtype=float) for line in lines]


def plates(first, second, height):
    """Two plates at heights, and a line at another one."""
    return (
        [plate(first), plate(second)],
        polyline_of,
        [np.array([(3000, 0, height), (3000, WIDTH, height)], dtype=float)],
    )


def on_strip(us, vs, whole=True):
    """Three faces in a row, or one, cut along lines of their parameters."""
    along, across = np.linspace(0.0, 3.0, 41), np.linspace(0.0, 1.0, 41)
    lines = [STRIP(along, np.full(41, v)) for v in vs] + [STRIP(np.full(41, u), across) for u in us]
    return [kernel_face(STRIP, poles=40)] if whole else strip_faces(), curve, lines


def faces_of(shape):
    return [TopoDS.Face_s(face) for face in shapes_of(shape, TopAbs_FACE)]


def circle_of(x, y, radius):
    turn = np.linspace(0.0, 2.0 * np.pi, 201)
    points = np.stack([x + radius * np.cos(turn), y + radius * np.sin(turn), np.zeros(201)], axis=1)
    return [plate()], polyline_of, [np.concatenate([points[:-1], points[:1]])]


def notched(*lines):
    box = BRepPrimAPI_MakeBox(gp_Pnt(2000.0, 1000.0, -10.0), 1000.0, 2000.0, 20.0).Shape()
    _, draw, drawn = on_plate(*lines)
    return faces_of(BRepAlgoAPI_Cut(plate(), box).Shape()), draw, drawn


def tube(*heights):
    """A closed cylinder cut all around, and along its seam."""
    shape = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0)), 500.0, 2000.0).Shape()
    turn = np.linspace(0.0, 2.0 * np.pi, 201)
    rings = [np.stack([500.0 * np.cos(turn), 500.0 * np.sin(turn), np.full(201, height)], axis=1) for height in heights]
    return faces_of(shape)[:1], polyline_of, [np.concatenate([own[:-1], own[:1]]) for own in rings]


CASES = {
    "hem 20": (lambda: layered(hem(20.0)), 3),
    "hem 10": (lambda: layered(hem(10.0)), 3),
    "hem 5": (lambda: layered(hem(5.0)), 3),
    "hem 2": (lambda: layered(hem(2.0)), 3),
    "spiral": (lambda: layered(spiral(50.0), poles=80, count=100), 3),
    "network": (lambda: on_strip((1.0, 2.0), (0.2, 0.4, 0.6)), 12),
    "several faces": (lambda: on_strip((), (0.2, 0.45, 0.8), whole=False), 4),
    "along joints": (lambda: on_strip((1.0, 2.0), (0.5,), whole=False), 6),
    "along the outline": (lambda: on_strip((0.0,), (0.0, 0.5, 1.0), whole=False), 2),
    "from border to border": (
        lambda: on_plate([(3000, 0), (3000, WIDTH)], [(0, 500), (LENGTH, 500)]),
        4,
    ),
    "from corner to corner": (lambda: on_plate([(0, 0), (LENGTH, WIDTH)], [(0, WIDTH), (LENGTH, 0)]), 4),
    "three through a point": (
        lambda: on_plate([(0, 0), (LENGTH, WIDTH)], [(0, WIDTH), (LENGTH, 0)], [(3000, 0), (3000, WIDTH)]),
        6,
    ),
    "up to another curve": (lambda: on_plate([(3000, 0), (3000, WIDTH)], [(3000, 700), (LENGTH, 700)]), 3),
    "along the same border": (lambda: on_plate([(0, 0), (LENGTH, 0)], [(3000, 0), (3000, WIDTH)]), 2),
    "twice the same": (lambda: on_plate([(3000, 0), (3000, WIDTH)], [(3000, 0), (3000, WIDTH)]), 2),
    "partly the same": (
        lambda: on_plate([(3000, 0), (3000, WIDTH)], [(3000, 0), (3000, 1000), (LENGTH, 1000)]),
        3,
    ),
    "closed": (lambda: circle_of(3000.0, 1000.0, 500.0), 2),
    "centre on the border": (lambda: circle_of(3000.0, 0.0, 500.0), 2),
    "to a notch": (lambda: notched([(2500, 0), (2500, 1000)], [(0, 500), (LENGTH, 500)]), 4),
    "along a notch": (lambda: notched([(0, 1000), (LENGTH, 1000)]), 3),
    "to a notch's corner": (lambda: notched([(2000, 0), (2000, WIDTH)], [(3000, 0), (3000, 1000)]), 3),
    "over a notch": (lambda: notched([(0, 1500), (LENGTH, 1500)]), 3),
    "square": (
        lambda: on_plate([(2000, 0), (2000, WIDTH)], [(4000, 0), (4000, WIDTH)], [(0, 1000), (LENGTH, 1000)]),
        6,
    ),
    "short by the tolerance": (lambda: on_plate([(3000, 1), (3000, WIDTH - 1)]), 2),
    "too long by the tolerance": (
        lambda: on_plate([(3000, 0), (3000, WIDTH)], [(2999, 700), (LENGTH, 700)]),
        3,
    ),
    "beside a corner": (lambda: on_plate([(0.5, 0.5), (LENGTH, WIDTH)]), 2),
    "farther from one layer by the tolerance": (lambda: plates(0.0, 2.0, 0.5), 4),
    "around a tube": (lambda: tube(500.0, 1000.0), 3),
}


def called(faces, draw, lines):
    """The panels' names, each with the panel's middle."""
    return {panel.name: middle_of(panel.faces) for panel in cut(faces, [draw(line) for line in lines])}


@pytest.mark.parametrize("name", cases([*CASES][::4], [*CASES]))
def test_cut_is_the_same_however_the_numbers_are_rounded(name):
    make, count = CASES[name]
    faces, draw, lines = make()
    whole = called(faces, draw, lines)
    assert len(whole) == count
    random = np.random.default_rng(11)
    for noise in NOISES:
        rounded = [line * (1.0 + noise * random.standard_normal(line.shape)) for line in lines]
        found = called(faces, draw, rounded)
        assert found.keys() == whole.keys()
        assert all(found[panel] == pytest.approx(whole[panel], abs=SAME_PLACE) for panel in whole)


@pytest.mark.parametrize(
    "lines",
    [
        ([(1000, 700), (2000, 700)], [(3000, 700), (4000, 700)]),
        ([(3000, 0), (3000, WIDTH)], [(3001, 0), (3001, WIDTH)]),
    ],
    ids=["ends", "sliver"],
)
def test_refusal_names_the_same_curve_however_its_numbers_are_rounded(lines):
    faces, draw, drawn = on_plate(*lines)
    random = np.random.default_rng(12)
    for noise in (0.0, *2 * NOISES):
        rounded = [draw(line * (1.0 + noise * random.standard_normal(line.shape))) for line in drawn]
        with pytest.raises(ReferenceFileError, match="Curve 1 of 'lines'"):
            cut(faces, rounded)


@pytest.mark.parametrize("gap", [0.0, 0.4e-7, 0.6e-7, 1e-6, 1e-4, 0.05, 0.4])
def test_closed_curve_cuts_out_what_is_in_it_however_closely_it_closes(gap):
    faces, draw, (line,) = circle_of(3000.0, 1000.0, 500.0)
    line[-1, 0] += gap
    assert len(cut(faces, [draw(line)])) == 2


SMALL = tuple(noise for noise in NOISES if noise <= 1e-13)


def test_chamfer_has_its_corner_at_the_same_end_however_it_is_rounded():
    chamfer = np.array([(0.0, 0.0, 0.0), (500.0, 0.0, 0.0), (500.5, 0.5, 0.0), (500.5, 400.5, 0.0)]) + 1000.0
    random = np.random.default_rng(4)
    drawn = [chamfer * (1.0 + noise * random.standard_normal(chamfer.shape)) for noise in (0.0, *5 * SMALL)]
    assert {tuple(corners(own, np.array([1, 2])).tolist()) for own in drawn} == {(True, False)}


def square(turn, scales):
    """A square turned about the z axis, its sides of 1 m a little longer or shorter."""
    along = gp_Dir(np.cos(turn), np.sin(turn), 0.0)
    plane = gp_Pln(gp_Ax3(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0), along))
    width, length = (1000.0 * scales).tolist()
    return [BRepBuilderAPI_MakeFace(plane, 0.0, width, 0.0, length).Face()]


def halves(turn, scales):
    """The same as two triangles, of which neither runs from end to end."""
    width, length = (1000.0 * scales).tolist()
    ways = np.array([(np.cos(turn), np.sin(turn), 0.0), (-np.sin(turn), np.cos(turn), 0.0)])
    corners = np.array([(0.0, 0.0), (width, 0.0), (width, length), (0.0, length)]) @ ways
    return [
        BRepBuilderAPI_MakeFace(
            BRepBuilderAPI_MakePolygon(*(gp_Pnt(*corners[place].tolist()) for place in triangle), True).Wire()
        ).Face()
        for triangle in ((0, 1, 2), (0, 2, 3))
    ]


@pytest.mark.parametrize("sheet", [square, halves])
@pytest.mark.parametrize("turn", [0.0, 0.3, np.pi / 4])
def test_square_is_divided_the_same_way_however_its_sides_are_rounded(sheet, turn):
    random = np.random.default_rng(6)
    found = [
        {panel.name: middle_of(panel.faces) for panel in panels_of(model_of(*sheet(turn, scales)), divide=3)}
        for scales in (np.ones(2), *(1.0 + NOISE_OF_SIDES * random.standard_normal((8, 2))))
    ]
    assert all(found[0].keys() == own.keys() for own in found)
    assert all(own[name] == pytest.approx(found[0][name], abs=SAME_PLACE) for own in found for name in own)


def grid(columns, rows, turn):
    """Middles of square panels in rows and columns, turned about the z axis, and the edges between them."""
    ways = 1000.0 * np.array([(np.cos(turn), np.sin(turn), 0.0), (-np.sin(turn), np.cos(turn), 0.0)])
    places = [(column, row) for column in range(columns) for row in range(rows)]
    middles = np.array(places) @ ways + 0.0625
    steps = [(one, (one[0] + right, one[1] + 1 - right)) for one in places for right in (0, 1)]
    pairs = [(places.index(one), places.index(other)) for one, other in steps if other in places]
    return middles, [(pair, middles[list(pair)].mean(axis=0)) for pair in pairs]


def ring(count):
    turn = 2.0 * np.pi * np.arange(2 * count) / count / 2.0
    around = 1000.0 * np.stack([np.cos(turn), np.sin(turn), np.zeros(2 * count)], axis=1)
    return around[::2], [((place, (place + 1) % count), around[2 * place + 1]) for place in range(count)]


@pytest.mark.parametrize(
    ("middles", "borders"),
    [
        *(grid(3, 3, 0.0), grid(3, 3, 0.3), grid(4, 4, np.pi / 4), grid(3, 5, np.pi / 4), grid(1, 5, -np.pi / 4)),
        *(ring(3), ring(4), ring(12)),
    ],
    ids=["square", "square at 17", "square at 45", "rows at 45", "strip at 45", "ring of 3", "ring of 4", "ring of 12"],
)
def test_name_is_the_same_however_the_middle_is_rounded(middles, borders):
    random = np.random.default_rng(2)
    links = [Link(panels=panels, middle=middle, length=1000.0) for panels, middle in borders]
    drawn = [middles + 1000.0 * noise * random.standard_normal(middles.shape) for noise in (0.0, *5 * NOISES)]
    assert len({tuple(place_names("S1", own, links)) for own in drawn}) == 1
