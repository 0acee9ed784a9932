"""The Hausdorff distance between chains of segments and arcs."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from cadpanel.geometry.cone_sections import axis_frame, cut_cone, elliptic_section
from cadpanel.geometry.curve_hausdorff import hausdorff_distances
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape
from tests.dense_seam_gap import Density, dense_seam_gap
from tests.known_panels import end_curve
from tests.shapes import folded_panel, moved, random_panel
from tests.thorough import cases

DENSE = Density(points=48, peaks=4, close=1e-4, targets=96)


def pieces(rows) -> CurvePieces:
    centers, cosines, sines, starts, stops, arcs = (np.array(column) for column in zip(*rows, strict=True))
    return CurvePieces(
        centers=centers.astype(float),
        cosine_axes=cosines.astype(float),
        sine_axes=sines.astype(float),
        starts=starts.astype(float),
        stops=stops.astype(float),
        arcs=arcs,
    )


def segment(start, stop):
    return start, np.subtract(stop, start), (0.0, 0.0, 0.0), 0.0, 1.0, False


def circle(radius, start, stop, center=(0.0, 0.0, 0.0)):
    return center, (radius, 0.0, 0.0), (0.0, radius, 0.0), start, stop, True


def end_of(shape: PanelShape, end: int) -> CurvePieces:
    rows = []
    for index, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
            arc = elliptic_section(frame, cut_cone(frame, shape.cut_points[end], shape.cut_normals[end]))
            rows.append((arc.center, arc.cosine_axis, arc.sine_axis, arc.start, arc.stop, True))
        else:
            rows.append(segment(*shape.corners()[end, index : index + 2]))
    return pieces(rows)


def joined_curves(curves) -> EndCurves:
    return EndCurves(*(np.concatenate([getattr(of, name) for of in curves]) for name in EndCurves.__slots__))


def test_a_curve_is_at_no_distance_from_itself():
    chains = [end_of(random_panel(seed, mitre=0.6), 0) for seed in range(20)]
    assert hausdorff_distances(chains, chains).max() < 1e-9


def test_parallel_segments_and_the_overhang_of_a_longer_one():
    one = pieces([segment((0, 0, 0), (10, 0, 0))])
    assert hausdorff_distances([one], [pieces([segment((0, 3, 0), (10, 3, 0))])])[0] == pytest.approx(3.0, abs=1e-12)
    assert hausdorff_distances([one], [pieces([segment((0, 0, 0), (14, 0, 0))])])[0] == pytest.approx(4.0, abs=1e-12)


@pytest.mark.parametrize("away", [0.0, 2.0**20, -(2.0**30)])
def test_where_two_chains_stand_costs_their_distance_no_digits(away):
    """They are seen from between them."""
    corners = np.array([(0, 0, 0), (7, 1, 0), (10, 5, 2)]) + away
    chains = [pieces([segment(*(corners[i : i + 2] + shift)) for i in range(2)]) for shift in (0.0, [0.0, 0.0, 0.25])]
    arcs = [pieces([circle(100.0, 0.5, 2.0, np.array(center) + away)]) for center in ((0, 0, 0), (0, 0, 0.25))]
    assert hausdorff_distances([chains[0], arcs[0]], [chains[1], arcs[1]])[1] == pytest.approx(0.25, abs=1e-9)
    found = hausdorff_distances([chains[0]], [chains[1]])[0]
    assert found == pytest.approx(
        hausdorff_distances([moved_to(chains[0], -away)], [moved_to(chains[1], -away)])[0], abs=1e-9
    )
    assert 0.1 < found <= 0.25


def moved_to(of, by):
    return replace(of, centers=of.centers + by)


def test_concentric_arcs_are_apart_by_their_radii():
    gap = hausdorff_distances([pieces([circle(100.0, 0.5, 2.0)])], [pieces([circle(101.0, 0.5, 2.0)])])
    assert gap[0] == pytest.approx(1.0, abs=1e-9)


def test_an_arc_bulges_over_its_chord_by_its_sagitta():
    ends = [(100 * math.cos(w), 100 * math.sin(w), 0) for w in (0.3, 1.5)]
    gap = hausdorff_distances([pieces([circle(100.0, 0.3, 1.5)])], [pieces([segment(*ends)])])
    assert gap[0] == pytest.approx(100 * (1 - math.cos(0.6)), abs=1e-6)


def test_the_distance_is_symmetric_and_blind_to_the_direction_of_a_chain():
    one, two = end_of(random_panel(1), 0), end_of(moved(random_panel(1), (3.0, 1.0, -2.0)), 0)
    back = pieces([segment((10, 0, 0), (0, 0, 0))])
    assert hausdorff_distances([one], [two])[0] == pytest.approx(hausdorff_distances([two], [one])[0], abs=1e-9)
    assert hausdorff_distances([back], [pieces([segment((0, 0, 0), (10, 0, 0))])])[0] < 1e-12


def test_chains_of_different_lengths_can_be_measured_together():
    short, long = folded_panel(chain="p", widths=(300.0,), turns=(0.0,)), folded_panel()
    gaps = hausdorff_distances(
        [end_of(short, 0), end_of(long, 0)],
        [end_of(moved(short, (0.5, 0, 0)), 0), end_of(moved(long, (0.25, 0, 0)), 0)],
    )
    assert gaps == pytest.approx([0.5, 0.25], abs=1e-9)


@pytest.mark.each_value_once
@pytest.mark.parametrize("mitre", [0.3001, 0.31, 0.5])
@pytest.mark.parametrize("chain", ["plane-cone-plane", "plane-cone-cone-plane", "cone-plane-cone", "cone"])
def test_the_distance_agrees_with_a_dense_measure_within_a_thousandth(chain, mitre):
    """Ellipses here, generatrices that are cut there: the same curves told in two ways."""
    pairs = [[random_panel(seed, chain=chain, mitre=of) for of in (0.3, mitre)] for seed in range(cases(10, 30))]
    found = hausdorff_distances(*([end_of(pair[side], 1) for pair in pairs] for side in (0, 1)))
    ends = [joined_curves([end_curve(pair[side], 1) for pair in pairs]) for side in (0, 1)]
    dense, *_ = dense_seam_gap(ends[0], ends[1], DENSE)
    assert dense.max() > 0.01
    assert found == pytest.approx(dense, rel=1e-3, abs=1e-7)


def test_pieces_may_stand_in_any_order():
    one, two = (end_of(random_panel(seed, chain="plane-cone-cone-plane"), 1) for seed in (3, 4))
    shift = two.centers[0] - one.centers[0]
    two = replace(two, centers=two.centers - shift)
    mixed = CurvePieces(**{name: getattr(one, name)[[2, 0, 3, 1]] for name in CurvePieces.__slots__})
    expected, found = hausdorff_distances([one, one], [two, one]), hausdorff_distances([mixed, mixed], [two, one])
    assert found == pytest.approx(expected, rel=1e-3, abs=1e-9)
    assert expected[0] > 10.0


def test_no_pairs_have_no_distances():
    assert len(hausdorff_distances([], [])) == 0


def ellipse(random, flat):
    """A half axis of a length between 100 and 500 mm, the other one flatter by a factor, over any part of the turn."""
    axes, _ = np.linalg.qr(random.normal(size=(3, 3)))
    major = random.uniform(100.0, 500.0)
    start = random.uniform(0.0, 2.0 * np.pi)
    return CurvePieces(
        centers=random.uniform(-200.0, 200.0, (1, 3)),
        cosine_axes=major * axes[:1],
        sine_axes=flat * major * axes[1:2],
        starts=np.array([start]),
        stops=np.array([start + random.uniform(0.5, 2.0 * np.pi)]),
        arcs=np.array([True]),
    )


def sampled_arc(piece, count=1500):
    at = np.linspace(piece.starts[0], piece.stops[0], count)
    return piece.centers + np.outer(np.cos(at), piece.cosine_axes[0]) + np.outer(np.sin(at), piece.sine_axes[0])


@pytest.mark.parametrize("flat", [1.0, 0.6, 0.2])
def test_distances_between_ellipses_anywhere_are_those_of_many_points_on_them(flat):
    random = np.random.default_rng(5)
    pairs = [(ellipse(random, flat), ellipse(random, flat)) for _ in range(12)]
    found = hausdorff_distances(*zip(*pairs, strict=True))
    for distance, pair in zip(found, pairs, strict=True):
        points = [sampled_arc(piece) for piece in pair]
        wanted = max(np.max(cKDTree(points[k]).query(points[1 - k])[0]) for k in range(2))
        assert distance == pytest.approx(wanted, abs=1.0)
