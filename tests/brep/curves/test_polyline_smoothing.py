"""A polyline so fine that it stands for a smooth curve cuts as that curve does; a coarse one keeps its corners."""

from itertools import pairwise

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakePolygon
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopoDS import TopoDS

from cadpanel.brep.curves.drawn_curve import sampled
from cadpanel.brep.files.model import Label, ModelCurve
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.kernel.splines import polyline_edge
from cadpanel.brep.kernel.tolerances import CLOSE
from cadpanel.brep.read import read_raw_panels, read_reference
from cadpanel.geometry.polyline import distances_to_polylines
from cadpanel.reference.settings import ReferenceSettings
from tests.drawn import LENGTH, WAVE, WIDTH, areas, cut, cut_points, line, plate, raw
from tests.model_files import STRIP, strip_faces, write_labelled, write_shape
from tests.thorough import cases


def sine(count, periods, noise=0.0):
    """Points of a sine across the plate, evenly in y; all but its ends moved at random."""
    y = np.linspace(0.0, WIDTH, count + 1)
    x = 0.5 * LENGTH + WAVE * np.sin(2.0 * np.pi * periods * y / WIDTH)
    points = np.stack([x, y, 0.0 * y], axis=1)
    points[1:-1, :2] += noise * np.random.default_rng(7).normal(size=(count - 1, 2))
    return points


def off_sine(points, periods):
    """How far points lie off the sine, to first order, mm."""
    turn = 2.0 * np.pi * periods / WIDTH
    x = 0.5 * LENGTH + WAVE * np.sin(turn * points[:, 1])
    return np.abs(points[:, 0] - x) / np.hypot(1.0, WAVE * turn * np.cos(turn * points[:, 1]))


def chord_error(count, periods):
    """How far the chords of the sine lie off it where it bends most, mm."""
    return WAVE * (2.0 * np.pi * periods / count) ** 2 / 8.0


def wire(points):
    making = BRepBuilderAPI_MakePolygon()
    for point in points.tolist():
        making.Add(gp_Pnt(*point))
    return making.Wire()


def reference(folder, drawn):
    skin, lines = write_shape(folder / "skin.brep", plate()), write_shape(folder / "lines.brep", drawn)
    return read_reference(skin, ReferenceSettings(unit="mm", network=lines))


def edges_of(shape):
    return [TopoDS.Edge_s(edge) for edge in shapes_of(shape, TopAbs_EDGE)]


def curves_of(edges):
    return sampled([ModelCurve(label=Label(), edge=edge) for edge in edges], "lines", np.zeros(3))


@pytest.mark.parametrize("drawn", [lambda points: polyline_edge(list(points)), wire], ids=["spline", "segments"])
@pytest.mark.parametrize(
    ("count", "periods"), cases([(200, 1), (1000, 1)], [(200, 1), (1000, 1), (4000, 1), (4000, 10)])
)
def test_fine_polyline_makes_the_panels_of_the_curve_that_it_samples(tmp_path, drawn, count, periods):
    shape = drawn(sine(count, periods))
    panels = reference(tmp_path, shape).panels
    assert [len(panel.edges) for panel in panels] == [4, 4]
    allowed = chord_error(count, periods) + CLOSE
    assert off_sine(cut_points(raw(tmp_path, plate(), [shape]).panels), periods).max() <= allowed
    half = 0.5 * LENGTH * WIDTH
    assert areas(cut([plate()], edges_of(shape))) == pytest.approx([half, half], abs=allowed * WIDTH)


@pytest.mark.parametrize("ending", ["step", "iges"])
@pytest.mark.parametrize("drawn", [lambda points: polyline_edge(list(points)), wire], ids=["spline", "segments"])
def test_fine_polyline_over_three_faces_cuts_alike_from_every_format(tmp_path, drawn, ending):
    # (The kernel parts a spline of degree 1 from an IGES file into splines of two poles.)
    u = np.linspace(0.0, 3.0, 1001)
    points = STRIP(u, 0.5 + 0.05 * np.sin(2.0 * u))
    lines = write_labelled(tmp_path / f"lines.{ending}", [(Label(name="cut"), drawn(points), [])])
    skin = write_shape(tmp_path / "skin.brep", compound_of(strip_faces()))
    panels = read_raw_panels(skin, ReferenceSettings(unit="mm", network=lines)).panels
    assert [len(panel.faces) for panel in panels] == [3, 3]


@pytest.mark.parametrize("noise", [0.001, 0.01])
def test_noise_of_a_digitised_curve_is_smoothed_away(tmp_path, noise):
    edge = polyline_edge(list(sine(4000, 1, noise)))
    assert [len(panel.edges) for panel in reference(tmp_path, edge).panels] == [4, 4]
    (curve,) = curves_of([edge])
    (piece,) = curve.pieces
    assert len(piece.points) <= 300
    assert off_sine(piece.points, 1).max() <= 2.0 * noise


def test_segments_are_joined_whichever_way_round_each_was_drawn():
    points = sine(100, 1)
    ends = np.stack([points[:-1], points[1:]], axis=1)
    ends[::3] = ends[::3, ::-1]
    (curve,) = curves_of([line(*pair) for pair in ends])
    np.testing.assert_allclose(curve.points[[0, -1]], points[[0, -1]], atol=1e-9)


def test_segments_that_turn_or_lie_apart_stay_curves_of_their_own_and_keep_their_numbers():
    corners = [(0, 0, 0), (1000, 0, 0), (2000, 0, 0), (2000, 1000, 0)]
    drawn = [*(line(*pair) for pair in pairwise(corners)), line((5, 5, 0), (5, 900, 0))]
    assert [curve.number for curve in curves_of(drawn)] == [1, 3, 4]


def angle(chamfer, noise):
    """An L across the plate in steps of half a millimetre, its corner chamfered, as points."""
    up = np.arange(0.0, 1000.0 - chamfer + 1e-9, 0.5)
    over = np.arange(3000.0 + max(chamfer, 0.5), LENGTH + 1e-9, 0.5)
    flat = np.concatenate([[(3000.0, y) for y in up], [(x, 1000.0) for x in over]])
    flat[-1, 0] = LENGTH
    flat[1:-1] += noise * np.random.default_rng(3).normal(size=(len(flat) - 2, 2))
    return np.column_stack([flat, np.zeros(len(flat))])


@pytest.mark.parametrize(
    ("chamfer", "noise"),
    cases([(0.0, 0.0), (0.3, 0.005)], [(0.0, 0.0), (0.0, 0.005), (0.3, 0.0), (0.7, 0.0), (0.3, 0.005)]),
)
def test_fine_polyline_keeps_its_corner(tmp_path, chamfer, noise):
    edge = polyline_edge(list(angle(chamfer, noise)))
    panels = reference(tmp_path, edge).panels
    assert sorted(len(panel.edges) for panel in panels) == [4, 6]
    assert (
        np.linalg.norm(cut_points(raw(tmp_path, plate(), [edge]).panels) - (3000.0, 1000.0, 0.0), axis=1).min() <= 0.75
    )
    small = 3000.0 * 1000.0
    assert areas(cut([plate()], [edge])) == pytest.approx([small, LENGTH * WIDTH - small], abs=10.0)


@pytest.mark.parametrize("apart", [0.0, 1e-5, 1e-3, 0.05, 0.5])
def test_corner_of_long_segments_may_be_drawn_twice(tmp_path, apart):
    corners = [(3000, 0, 0), (3000, 1000 - apart, 0), (3000 + apart, 1000, 0), (LENGTH, 1000, 0)]
    panels = reference(tmp_path, polyline_edge(list(np.array(corners, dtype=float)))).panels
    assert sorted(len(panel.edges) for panel in panels) == [4, 6]


def test_how_far_a_smooth_curve_passes_beside_its_segments_is_said(tmp_path):
    edge = polyline_edge(list(sine(200, 1)))
    (note,) = reference(tmp_path, edge).notes
    (curve,) = curves_of([edge])
    assert note == (
        "The segments of curve 1 of 'lines.brep' stand for a smooth curve, which passes up to "
        f"{curve.beside:.2g} mm beside them."
    )
    # The middles of its chords lie that far off the sine.
    assert curve.beside == pytest.approx(chord_error(200, 1), rel=0.5)
    assert reference(tmp_path, polyline_edge(list(sine(4000, 1)))).notes == ()


def test_polyline_coarser_than_a_facet_is_followed_exactly():
    points = sine(20, 1)
    (curve,) = curves_of([polyline_edge(list(points))])
    assert curve.beside == 0.0
    assert distances_to_polylines(curve.points[None], points[None]).max() <= CLOSE
    assert distances_to_polylines(points[None], curve.points[None]).max() <= CLOSE
