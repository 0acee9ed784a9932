"""The Hausdorff distance between chains of segments and arcs."""

import math

import numpy as np
import pytest

from cadpanel.geometry.cone_sections import axis_frame, cut_cone, elliptic_section
from cadpanel.geometry.curve_hausdorff import CurvePieces, hausdorff_distances
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape
from tests.shapes import folded_panel, moved, random_panel


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


def dense(chain: CurvePieces, count: int) -> np.ndarray:
    points = []
    for index in range(len(chain)):
        w = np.linspace(chain.starts[index], chain.stops[index], count)[:, None]
        cosine, sine = (np.cos(w), np.sin(w)) if chain.arcs[index] else (w, 0.0 * w)
        points.append(chain.centers[index] + cosine * chain.cosine_axes[index] + sine * chain.sine_axes[index])
    return np.concatenate(points)


def test_a_curve_is_at_no_distance_from_itself():
    chains = [end_of(random_panel(seed, mitre=0.6), 0) for seed in range(20)]
    assert hausdorff_distances(chains, chains).max() < 1e-9


def test_parallel_segments_and_the_overhang_of_a_longer_one():
    one = pieces([segment((0, 0, 0), (10, 0, 0))])
    assert hausdorff_distances([one], [pieces([segment((0, 3, 0), (10, 3, 0))])])[0] == pytest.approx(3.0, abs=1e-12)
    assert hausdorff_distances([one], [pieces([segment((0, 0, 0), (14, 0, 0))])])[0] == pytest.approx(4.0, abs=1e-12)


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


@pytest.mark.parametrize("seed", range(12))
def test_the_distance_agrees_with_a_dense_sampling(seed):
    one, two = (end_of(random_panel(seed, mitre=mitre), 1) for mitre in (0.05, 0.06))
    first, second = dense(one, 1500), dense(two, 1500)
    apart = np.linalg.norm(first[:, None] - second[None], axis=-1)
    expected = max(apart.min(axis=0).max(), apart.min(axis=1).max())
    assert hausdorff_distances([one], [two])[0] == pytest.approx(expected, abs=2e-2)


def test_no_pairs_have_no_distances():
    assert len(hausdorff_distances([], [])) == 0
