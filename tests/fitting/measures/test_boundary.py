"""Distances between boundaries: to a sampled outline, to the patches under it, and how far either reaches beyond."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.features.catalogue import CATALOGUE, feature
from cadpanel.fitting.measures.boundary import overhang, polyline_distance
from cadpanel.fitting.measures.deviation import outline_distances
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.geometry.shape import PolygonShape
from cadpanel.geometry.vectors import norm
from tests.closest import closest
from tests.elsewhere import elsewhere, scaled, scaled_reference, shaken, turn
from tests.instances import random_polygon, random_shapes
from tests.known_panels import alone, end_curve, renumbered, ring
from tests.known_panels import moved as moved_reference
from tests.shapes import CHAINS, folded_panel, moved, random_panel
from tests.thorough import thorough

pytestmark = pytest.mark.each_value_once

EXACT = 1e-9
TINY = np.finfo(float).tiny
RADIUS = 300.0
COUNT = 17


def reach(shapes, reference):
    return overhang(PanelEdges.of(shapes), reference)


def arc(angles):
    """Points of an arc, which leaves the plane so that no coordinate is idle."""
    return np.stack([RADIUS * np.cos(angles), RADIUS * np.sin(angles), 40.0 * angles], axis=-1)


ANGLES = np.linspace(0.2, 1.4, COUNT)
STEP = ANGLES[1] - ANGLES[0]
# Half-way between two points the chord is off by this, mm.
SAGITTA = RADIUS * (1.0 - np.cos(STEP / 2.0))


# ------------------------------------------------------------------------------------------------ to a sampled outline
@pytest.mark.parametrize("segment", range(COUNT - 1))
@pytest.mark.parametrize("share", [0.15, 0.5, 0.85])
def test_a_point_of_a_curve_is_on_it_wherever_it_lies_between_the_curves_points(segment, share):
    """The first and the last segment take the cubic of the four outermost points, the others that of those around."""
    point = arc(ANGLES[segment] + share * STEP)
    assert SAGITTA > 0.2
    (found,) = polyline_distance(point[None, None], arc(ANGLES)[None])[0]
    # The error of a cubic is of the fourth order in the step, that of a chord of the second.
    assert found <= 0.01 * SAGITTA


@pytest.mark.parametrize("off", [0.05, 1.0, 20.0])
def test_a_point_off_a_curve_is_as_far_from_it_as_it_was_moved(off):
    angles = ANGLES[:-1] + 0.5 * STEP
    outwards = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=-1)
    found = polyline_distance((arc(angles) + off * outwards)[None], arc(ANGLES)[None])[0]
    assert found == pytest.approx(np.full(COUNT - 1, off), abs=0.01 * SAGITTA)


def test_a_point_is_as_far_from_a_straight_line_as_from_its_segment_or_its_end():
    line = np.linspace([0.0, 0.0, 0.0], [100.0, 0.0, 0.0], 6)
    points = np.array([[50.0, 3.0, 4.0], [13.0, 0.0, 2.0], [-3.0, 4.0, 0.0], [106.0, 0.0, 8.0], [100.0, 0.0, 0.0]])
    found = polyline_distance(points[None], line[None])[0]
    assert found == pytest.approx([5.0, 2.0, 5.0, 10.0, 0.0], abs=EXACT)


def test_points_of_a_line_with_a_kink_are_on_it():
    line = np.array([[0.0, 0.0, 0.0], [30.0, 0.0, 0.0], [60.0, 0.0, 0.0], [60.0, 40.0, 0.0], [60.0, 80.0, 0.0]])
    points = np.array([[45.0, 0.0, 0.0], [60.0, 20.0, 0.0], [60.0, 60.0, 0.0]])
    assert polyline_distance(points[None], line[None])[0] == pytest.approx(np.zeros(3), abs=EXACT)


def test_points_that_repeat_make_no_distance():
    line = np.repeat(np.linspace([0.0, 0.0, 0.0], [90.0, 0.0, 0.0], 4), 3, axis=0)
    points = np.array([[10.0, 1.0, 0.0], [45.0, 0.0, 2.0], [90.0, 0.0, 0.0]])
    assert polyline_distance(points[None], line[None])[0] == pytest.approx([1.0, 2.0, 0.0], abs=EXACT)


def test_each_panel_has_a_line_of_its_own():
    lines = np.array([arc(ANGLES), arc(ANGLES) + np.array([0.0, 0.0, 500.0])])
    points = np.array([arc(ANGLES), arc(ANGLES)])
    found = polyline_distance(points, lines)
    assert found[0] == pytest.approx(np.zeros(COUNT), abs=EXACT)
    assert found[1].min() > 100.0


# ------------------------------------------------------------------------------------------------------- to the patches
@pytest.mark.parametrize("by", [0.0, 0.5, -12.0])
def test_an_outline_off_the_skin_is_as_far_from_its_patches(by):
    fold = folded_panel(half_angle=0.02)
    found = outline_distances([fold], alone(fold.offset(by)))
    assert found.shape[0] == 1
    assert found == pytest.approx(np.full(found.shape, abs(by)), abs=EXACT)


def test_an_outline_within_the_surface_is_on_the_patches_however_far_it_is_trimmed():
    fold = folded_panel()
    shorter = folded_panel(length=700.0, widths=(150.0, 120.0))
    assert outline_distances([fold], alone(moved(shorter, (0.0, -50.0, 0.0)))).max() == pytest.approx(0.0, abs=EXACT)


def test_panels_with_fewer_edges_are_measured_by_their_own():
    shapes = [random_polygon(1, 3), random_polygon(2, 6)]
    assert outline_distances(shapes, alone(*shapes)).max() <= EXACT
    assert reach(shapes, alone(*shapes)) == pytest.approx([0.0, 0.0], abs=EXACT)


# ----------------------------------------------------------------------------------------------------- laws of overhang
def off(shapes, seed):
    """The panels turned and moved a little, or much, or hardly: each by its own share of 30 mm."""
    random = np.random.default_rng(seed)
    found = []
    for shape in shapes:
        share = 10.0 ** random.uniform(-4.0, 0.0)
        axes, _ = np.linalg.qr(np.eye(3) + 0.02 * share * random.normal(size=(3, 3)))
        rotation = axes * np.sign(np.diag(axes))
        middle = shape.corners().mean(axis=(0, 1))
        found.append(elsewhere(shape, rotation, middle - rotation @ middle + 30.0 * share * random.normal(size=3)))
    return found


def with_fewer_points(reference, seed):
    """Each outline with all of its points, or every second, or every fourth."""
    random = np.random.default_rng(seed)
    panels = (
        replace(panel, edges=tuple(edge[:: random.choice([1, 2, 4])] for edge in panel.edges))
        for panel in reference.panels
    )
    return replace(reference, panels=tuple(panels))


def ring_of_folds():
    sixth = np.array([[0.5, -np.sqrt(0.75), 0.0], [np.sqrt(0.75), 0.5, 0.0], [0.0, 0.0, 1.0]])
    shape = moved(folded_panel(half_angle=0.02, length=900.0), (0.0, -1500.0, 0.0))
    turns = [np.linalg.matrix_power(sixth, i) for i in range(6)]
    return [elsewhere(shape, turn, np.zeros(3)) for turn in turns], ring(alone(shape).panels[0], 6, sixth)


def those(shapes):
    return lambda: (shapes, alone(*shapes))


def mixture():
    chains = [shape for name in CATALOGUE for shape in random_shapes(feature(name), 8, 3)]
    shapes = [*chains, *(random_polygon(seed, 3 + 2 * (seed % 4)) for seed in range(20))]
    return [shapes[i] for i in np.random.default_rng(1).permutation(len(shapes))]


BOUNDARIES = {
    **{name: those(random_shapes(feature(name), 7, 6)) for name in CATALOGUE},
    **{chain: those([random_panel(seed, chain=chain) for seed in range(4)]) for chain in CHAINS},
    "concave": those([random_panel(seed, chain="plane-cone-plane", concave=True) for seed in range(4)]),
    "polygons": those([random_polygon(seed, corners) for seed, corners in enumerate((3, 5, 6, 8, 5))]),
    "one panel": those(random_shapes(feature("plane-cone-plane"), 9, 1)),
    "a ring": ring_of_folds,
    "all kinds": those(mixture()),
}
every_boundary = pytest.mark.parametrize("case", BOUNDARIES)


def skin_edges(shape):
    """For each edge its end curve, or where it is straight the two corners (2, 3)."""
    corners = shape.corners()
    if not shape.four_sided:
        return list(np.stack([corners[0], np.roll(corners[0], -1, axis=0)], axis=1))
    flat = [patch.kind for patch in shape.patches] == ["plane"]
    ends = list(corners) if flat else [end_curve(shape, end) for end in (0, 1)]
    return [*ends, corners[:, 0], corners[:, -1]]


def to_segment(points, ends):
    share = np.clip((points - ends[0]) @ (ends[1] - ends[0]) / max(np.sum((ends[1] - ends[0]) ** 2), TINY), 0.0, 1.0)
    return norm(points - ends[0] - share[:, None] * (ends[1] - ends[0]))


def closely(points, curve):
    """From points (q, 3) to the curve, as the closest points of curves are found."""
    return closest(curve, points[None])[0][0]


def densely(points, curve):
    """From points (q, 3) to the chords of the curve between thousands of points."""
    line = curve.follow(np.linspace(0.0, curve.patches, 4000 * curve.patches + 1)[None])[0][0]
    nearest = np.array([np.argmin(np.sum((line - point) ** 2, axis=1)) for point in points])
    around = [line[np.clip(nearest + i, 0, len(line) - 1)] for i in (-1, 0, 1)]
    chords = (np.stack(pair, axis=1) for pair in (around[:2], around[1:]))
    ways = [[to_segment(x[None], ends)[0] for x, ends in zip(points, pair, strict=True)] for pair in chords]
    return np.min(ways, axis=0)


def all_places(shape, outlines, to_curve):
    """The farthest of all places of both boundaries, each looked at."""
    farthest = 0.0
    for edge, line in zip(skin_edges(shape), outlines, strict=True):
        if isinstance(edge, np.ndarray):
            points, back = edge[0] + np.linspace(0.0, 1.0, 5)[:, None] * (edge[1] - edge[0]), to_segment(line, edge)
        else:
            points, back = edge.follow(edge.stations()[None])[0][0], to_curve(line, edge)
        there = polyline_distance(points[None], line[None])[0]
        farthest = max(farthest, there.max(), back.max())
    return farthest


@every_boundary
def test_what_is_not_looked_at_is_nowhere_the_farthest(case):
    shapes, whole = BOUNDARIES[case]()
    for seed in range(3):
        skins, reference = off(shapes, seed), with_fewer_points(whole, seed)
        pairs = zip(skins, reference.panels, strict=True)
        expected = np.array([all_places(skin, panel.edges, closely) for skin, panel in pairs])
        assert expected.min() > 1e-4
        assert reach(skins, reference) == pytest.approx(expected, rel=1e-9, abs=1e-10)


@every_boundary
@thorough
def test_the_farthest_is_as_far_as_curves_followed_densely_are(case):
    shapes, reference = BOUNDARIES[case]()
    skins = off(shapes, 5)[:8]
    reference = replace(reference, panels=reference.panels[:8], seams=())
    pairs = zip(skins, reference.panels, strict=True)
    expected = np.array([all_places(skin, panel.edges, densely) for skin, panel in pairs])
    assert reach(skins, reference) == pytest.approx(expected, rel=1e-6, abs=1e-5)


@every_boundary
def test_an_outline_of_another_panel_altogether_is_measured_all_the_same(case):
    """Nothing of what is likely to be near is near."""
    shapes, _ = BOUNDARIES[case]()
    skins = [elsewhere(shape, turn(i), 300.0 * turn(i)[0]) for i, shape in enumerate(shapes)]
    reference = alone(*shapes)
    pairs = zip(skins, reference.panels, strict=True)
    expected = np.array([all_places(skin, panel.edges, closely) for skin, panel in pairs])
    assert reach(skins, reference) == pytest.approx(expected, rel=1e-9)


def test_the_order_of_panels_and_how_many_there_are_change_nothing():
    """More than are measured at a time."""
    shapes = [shape for seed in range(6) for shape in mixture()]
    skins, reference = off(shapes, 3), with_fewer_points(alone(*shapes), 3)
    assert len(shapes) > 256
    found = reach(skins, reference)
    order = np.random.default_rng(4).permutation(len(shapes)).tolist()
    assert reach([skins[i] for i in order], renumbered(reference, order)) == pytest.approx(found[order], rel=1e-11)
    for i in order[:12]:
        one = replace(reference, panels=(reference.panels[i],))
        assert reach([skins[i]], one) == pytest.approx([found[i]], rel=1e-11)


@every_boundary
def test_moving_skins_and_outlines_together_changes_nothing(case):
    shapes, reference = BOUNDARIES[case]()
    skins, rotation, shift = shaken(shapes, 1), turn(4), np.array([3e5, -2e5, 1e4])
    there = reach([elsewhere(skin, rotation, shift) for skin in skins], moved_reference(reference, rotation, shift))
    assert there == pytest.approx(reach(skins, reference), abs=1e-8)


@every_boundary
@pytest.mark.parametrize("factor", [1e-3, 25.4])
def test_units_scale_what_is_found(case, factor):
    shapes, reference = BOUNDARIES[case]()
    skins = shaken(shapes, 2)
    found = reach([scaled(skin, factor) for skin in skins], scaled_reference(reference, factor))
    assert found == pytest.approx(factor * reach(skins, reference), rel=1e-9)


# ------------------------------------------------------------------------------------------------- examples of overhang
@pytest.mark.parametrize("by", [-25.0, -1.0, 1.0, 25.0])
def test_a_boundary_reaches_beyond_by_what_it_is_longer_or_shorter(by):
    fold, other = folded_panel(), folded_panel(length=1000.0 + 2.0 * by)
    assert reach([other], alone(fold)) == pytest.approx([abs(by)], abs=1e-3)


@pytest.mark.parametrize("by", [-25.0, 25.0])
def test_a_flange_that_is_wider_or_narrower_shows_at_its_free_edge(by):
    fold, other = folded_panel(), folded_panel(widths=(200.0, 200.0 + by))
    assert reach([other], alone(fold)) == pytest.approx([abs(by)], abs=1e-3)


def test_a_dent_in_the_reference_shows_only_on_the_way_from_the_reference():
    """Between its points the skin's edge is straight: from there the way to the dented outline is short enough."""
    corners = np.array(
        [[0.0, 0.0, 0.0], [800.0, 0.0, 0.0], [900.0, 500.0, 0.0], [400.0, 800.0, 0.0], [-100.0, 500.0, 0.0]]
    )
    shape = PolygonShape(name="a", feature="planar-polygon", outline=corners, normal=np.array([0.0, 0.0, 1.0]))
    whole = alone(shape)
    (panel,) = whole.panels
    first = panel.edges[0].copy()
    first[16, 1] -= 30.0
    dented = replace(whole, panels=(replace(panel, edges=(first, *panel.edges[1:])),))
    assert reach([shape], dented) == pytest.approx([30.0], abs=EXACT)
    assert reach([shape], whole) == pytest.approx([0.0], abs=EXACT)


def test_a_spike_of_the_skin_shows_only_on_the_way_from_the_skin():
    """Its edges pass by the reference's all the way; only its tip is far from any point of them."""
    corners = np.array([[0.0, 0.0, 0.0], [1000.0, 10.0, 0.0], [0.0, 20.0, 0.0]])
    shape = PolygonShape(name="a", feature="planar-polygon", outline=corners, normal=np.array([0.0, 0.0, 1.0]))
    longer = replace(shape, outline=corners + np.array([[0.0] * 3, [100.0, 0.0, 0.0], [0.0] * 3]))
    assert reach([longer], alone(shape)) == pytest.approx([100.0], abs=0.1)


def test_between_the_points_of_an_outline_an_arc_is_no_overhang():
    """The chord is off by its sagitta, which is no distance between two panels that are the same."""
    fold = folded_panel(radius=400.0, sweep=1.5)
    assert reach([fold], alone(fold))[0] <= 1e-3
