"""Laws of the measures, on shapes and references alone: no fit is needed to measure."""

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest
from pydantic import TypeAdapter

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.from_shape import patch_models
from cadpanel.delivery.records.patches import PatchModel
from cadpanel.delivery.records.report import read_report
from cadpanel.features.catalogue import CATALOGUE, feature
from cadpanel.fitting.measures.fit import Measures, largest_deviations, measure
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.reference.model import Seam
from cadpanel.reference.strip import strips_of
from tests.delivered import fitted as strip
from tests.elsewhere import elsewhere, shaken, turn
from tests.fitted_grids import fitted as fitted_grid
from tests.fitted_grids import gable
from tests.instances import random_polygon, random_shapes
from tests.known_panels import alone, renumbered
from tests.known_panels import moved as moved_reference
from tests.read_back import rebuilt
from tests.shapes import folded_panel, moved

# Millimetres, and radians.
EXACT = 1e-9
# What is measured twice on the same panels told in other words, mm.
SAME = 1e-8
TO_EDGE = 0.12
FOLDED = [
    name for name in CATALOGUE if sum(patch.kind != "plane" for patch in feature(name).patches) and "plane" in name
]


@cache
def strip_of_two():
    fold = folded_panel(half_angle=0.02, turns=(0.01, -0.02), cut_normals=((1.0, 0.1, 0.05), (1.0, 0.1, 0.05)))
    pair = (fold, moved(fold, (1000.0, 0.0, 0.0)))
    return list(pair), replace(alone(*pair), seams=(Seam(panels=(0, 1), edges=(1, 0), reversed=False),))


@cache
def mixed_features():
    """Chains of several features and polygons, none of which meet."""
    shapes: list[Panel] = [
        *random_shapes(feature("plane-cone-plane"), 1, 2),
        random_polygon(2, 5),
        *random_shapes(feature("cone"), 3, 1),
        *random_shapes(feature("plane-cone-cone-plane"), 4, 1),
        random_polygon(5, 6),
        *random_shapes(feature("planar-quadrilateral"), 6, 2),
    ]
    return shapes, alone(*shapes)


def gable_and_panels():
    of = gable(6.0)
    fold = folded_panel(length=1500.0)
    first, last = fold.corners()[:, -1]
    along, across, up = fold.directions[-1], fold.binormals()[-1], fold.normals[-1]
    outline = [last, first, first + 600.0 * across, first + 900.0 * across + 750.0 * along, last + 600.0 * across]
    return [fold, PolygonShape(name="plate", feature="planar-polygon", outline=np.array(outline), normal=up)], of


def grid(name):
    return lambda: (list(fitted_grid(name).shapes), fitted_grid(name).reference)


# Of the gap, within which its parts are told.
PARTS = 1e-3

CASES = {
    "a strip of chains": strip_of_two,
    "features that differ": mixed_features,
    "a polygon beside a chain": gable_and_panels,
    "a grid of cones": grid("cone"),
    "a honeycomb of polygons": grid("planar-polygon"),
}
every_case = pytest.mark.parametrize("case", CASES)


def compare(one: Measures, other: Measures, within: float) -> None:
    for field in fields(Measures):
        a, b = getattr(one, field.name), getattr(other, field.name)
        if field.name in ("shapes", "seam_panels"):
            continue
        if field.name == "corner_gaps":
            assert [len(gaps) for gaps in a] == [len(gaps) for gaps in b]
            a, b = np.concatenate([*a, np.zeros(0)]), np.concatenate([*b, np.zeros(0)])
        # Where the closest point leaps from end to end, the parts of a gap leap with it.
        most = within + PARTS * one.max_seam_gap if field.name in ("seam_width", "seam_step") else within
        a, b = np.asarray(a), np.asarray(b)
        assert np.array_equal(np.isnan(a), np.isnan(b)), field.name
        assert np.max(np.abs(np.nan_to_num(a) - np.nan_to_num(b)), initial=0.0) <= most, field.name


# ----------------------------------------------------------------------------------------------------------------- laws
@pytest.mark.parametrize("name", CATALOGUE)
def test_an_exact_panel_has_no_deviation_and_no_drift_from_itself(name):
    shapes = random_shapes(feature(name), 3, 2)
    found = measure(shapes, alone(*shapes))
    for value in (found.rms_deviation, found.max_deviation, found.drift, found.drift_along, found.drift_across):
        assert value.shape == (2,)
        assert value.max() <= EXACT
    assert found.overall_rms <= EXACT
    assert found.hausdorff.max() <= TO_EDGE


@pytest.mark.parametrize("corners", [3, 5, 6, 8])
def test_an_exact_polygon_measures_nothing_at_all(corners):
    shape = random_polygon(7, corners)
    found = measure([shape], alone(shape))
    for value in (found.max_deviation, found.hausdorff, found.drift, found.drift_along, found.drift_across):
        assert value == pytest.approx([0.0], abs=EXACT)


@every_case
@pytest.mark.parametrize("far", [0.0, 1e6])
def test_moving_panels_and_reference_together_moves_no_measure(case, far):
    shapes, reference = CASES[case]()
    off, rotation, shift = shaken(shapes, 1), turn(4), far * np.array([1.0, -0.5, 0.2])
    there = measure([elsewhere(shape, rotation, shift) for shape in off], moved_reference(reference, rotation, shift))
    compare(measure(off, reference), there, SAME)


@every_case
def test_moving_the_panels_alone_shows(case):
    shapes, reference = CASES[case]()
    moved_by, was = measure(shaken(shapes, 1), reference), measure(shapes, reference)
    for what in ("rms_deviation", "max_deviation", "hausdorff", "drift", "drift_along"):
        assert np.abs(getattr(moved_by, what) - getattr(was, what)).max() > 0.1


@every_case
def test_renumbering_panels_changes_no_measure(case):
    shapes, reference = CASES[case]()
    off, order = shaken(shapes, 2), np.random.default_rng(3).permutation(len(shapes)).tolist()
    one, other = measure(off, reference), measure([off[i] for i in order], renumbered(reference, order))
    of_panels = (
        "rms_deviation",
        "max_deviation",
        "hausdorff",
        "drift",
        "drift_along",
        "drift_across",
        "outline_drift",
        "lengths",
    )
    also = ("edge_turns",)
    told = replace(one, **{name: getattr(one, name)[order] for name in of_panels + also})
    # Corner gaps stand in the order of the panel that comes first, which may be the other one now.
    same_way = replace(other, corner_gaps=tuple(np.sort(gaps) for gaps in other.corner_gaps))
    compare(replace(told, corner_gaps=tuple(np.sort(gaps) for gaps in told.corner_gaps)), same_way, SAME)


@every_case
def test_the_largest_deviations_are_those_of_all_measures(case):
    shapes, reference = CASES[case]()
    off = shaken(shapes, 5)
    assert np.array_equal(largest_deviations(off, reference), measure(off, reference).max_deviation)


# ------------------------------------------------------------------------------------------------------------ read back
@pytest.mark.parametrize("name", FOLDED)
def test_panels_rebuilt_from_their_records_have_the_same_measures(name):
    shapes = random_shapes(feature(name), 8, 3)
    reference = alone(*shapes)
    compare_read_back(shaken(shapes, 3), reference)


@pytest.mark.parametrize("case", ["a strip of chains", "a polygon beside a chain", "a honeycomb of polygons"])
def test_seams_of_panels_rebuilt_from_their_records_are_the_same(case):
    shapes, reference = CASES[case]()
    compare_read_back(shaken(shapes, 3), reference)


def compare_read_back(shapes, reference):
    records = TypeAdapter(tuple[PatchModel, ...])
    again = [
        rebuilt(s.name, s.feature, s.corners().tolist(), records.validate_json(records.dump_json(patch_models(s))))
        for s in shapes
    ]
    assert not any(one is other for one, other in zip(again, shapes, strict=True))
    compare(measure(again, reference), measure(shapes, reference), 1e-6)


def test_a_delivery_that_was_read_back_measures_what_its_report_says(tmp_path):
    result = strip()
    deliver(result, tmp_path / "out")
    report = read_report(tmp_path / "out" / REPORT)
    # As the fit had them: sheets are cut where their neighbours' are.
    corners = [panel.corners if panel.fitted is None else panel.fitted.corners for panel in report.panels]
    shapes = [rebuilt(p.name, p.feature, at, p.patches) for p, at in zip(report.panels, corners, strict=True)]
    found = measure(shapes, result.reference)
    compare(found, result.measures, 1e-6)
    told = [panel.hausdorff for panel in report.panels]
    assert found.hausdorff == pytest.approx(told, abs=1e-6)
    assert found.max_seam_gap == pytest.approx(report.summary.max_seam_gap, abs=1e-6)


def test_a_panel_that_was_tampered_with_after_the_report_measures_otherwise():
    result = strip()
    first, *others = result.shapes
    assert isinstance(first, PanelShape)
    bent = replace(first, points=first.points + 2.0 * first.normals)
    assert measure([bent, *others], result.reference).max_seam_gap > result.measures.max_seam_gap + 0.5


# --------------------------------------------------------------------------------------------------------------- drift
@pytest.mark.parametrize("by", [0.5, 20.0])
def test_a_panel_that_moves_along_a_strip_drifts_along_it_and_not_across(by):
    fold = folded_panel()
    for vector, along, across in (((by, 0.0, 0.0), by, 0.0), ((0.0, by, 0.0), 0.0, by), ((0.0, 0.0, by), 0.0, by)):
        seen = measure([moved(fold, vector)], alone(fold))
        assert seen.drift == pytest.approx([by], abs=EXACT)
        assert seen.drift_along == pytest.approx([along], abs=EXACT)
        assert seen.drift_across == pytest.approx([across], abs=EXACT)


@pytest.mark.parametrize("cut", [(1.0, 0.0, 0.0), (1.0, 0.2, 0.1)])
@pytest.mark.parametrize("turns", [(0.0, 0.0), (0.06, -0.08)])
def test_an_end_that_leans_out_between_outer_corners_that_stay_drifts_by_its_inner_corners(cut, turns):
    """Inner corners drift by what they are out of the end's plane, counted the way the strip goes there."""
    fold = folded_panel(turns=turns, cut_normals=((1.0, 0.0, 0.0), cut))
    outer = fold.corners()[1, [0, -1]]
    chord = outer[1] - outer[0]
    lean = np.cross(chord, np.cross([1.0, 0.3, 0.2], chord))
    tilted = replace(
        fold,
        cut_normals=np.array([fold.cut_normals[0], lean / np.linalg.norm(lean)]),
        cut_points=np.array([fold.cut_points[0], outer[0]]),
    )
    seen = measure([tilted], alone(fold))
    assert seen.drift == pytest.approx([0.0], abs=EXACT)
    sides = fold.corners()[1, [0, -1]] - fold.corners()[0, [0, -1]]
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    ways = np.array([2.0 * sides[0] + sides[1], sides[0] + 2.0 * sides[1]])
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    m = fold.cut_normals[1]
    inner = np.abs((tilted.corners()[1, 1:-1] - fold.cut_points[1]) @ m / (ways @ m)).max()
    assert inner > 1.0
    assert seen.drift_along == pytest.approx([inner], abs=1e-6)


def test_inner_corners_may_slide_along_an_end():
    """Wider flanges bring them elsewhere on the same end."""
    fold, other = (
        folded_panel(cut_normals=2 * [(1.0, 0.2, 0.1)]),
        folded_panel(sweep=0.9, cut_normals=2 * [(1.0, 0.2, 0.1)]),
    )
    strips = strips_of(alone(fold).panels, 4)
    assert np.abs(fold.corners() - other.corners())[:, 2].max() > 10.0
    assert strips.along(other.corners()[None])[0, :, 1:-1] == pytest.approx(np.zeros((2, 2)), abs=EXACT)


def test_the_corner_that_drifted_most_counts():
    fold, wide = folded_panel(), folded_panel(widths=(200.0, 230.0))
    seen = measure([wide], alone(fold))
    assert seen.drift == pytest.approx([30.0], abs=EXACT)
    assert seen.drift_across == pytest.approx([30.0], abs=EXACT)
    shape = random_polygon(4, 5)
    outline = shape.outline.copy()
    outline[2] += 12.0 * (outline[2] - outline.mean(axis=0)) / np.linalg.norm(outline[2] - outline.mean(axis=0))
    assert measure([replace(shape, outline=outline)], alone(shape)).drift == pytest.approx([12.0], abs=EXACT)


def test_corners_that_slide_along_sides_that_are_not_parallel_drift_along_them():
    turns = (0.06, -0.08)
    seen = measure([folded_panel(turns=turns, length=1040.0)], alone(folded_panel(turns=turns)))
    assert seen.drift_across == pytest.approx([0.0], abs=EXACT)
    assert seen.drift_along == pytest.approx(seen.drift, abs=EXACT)
    assert seen.drift[0] > 20.0


# ------------------------------------------------------------------------------------------------------------ deviation
@pytest.mark.parametrize("half_angle", [0.0, 0.1, -0.1])
def test_flanges_that_face_each_other_across_a_fold_of_half_a_turn_are_told_apart(half_angle):
    """The far flange lies behind the near ruling's plane: only the ruling half-way over the fold parts them."""
    fold = folded_panel(radius=150.0, sweep=3.1, half_angle=half_angle, widths=(900.0, 900.0))
    assert measure([fold], alone(fold)).max_deviation.max() <= EXACT


# ---------------------------------------------------------------------------------------------------- drift and the fit
def test_what_the_fit_holds_in_its_limits_is_measured_within_them():
    """Inner corners are held to one point of their end each; what counts is the whole end."""
    m, how = strip().measures, FitSettings()
    assert np.all(m.drift_along <= how.drift_along * m.lengths)


def test_a_polygon_drifts_whichever_way_its_corners_move():
    shape = random_polygon(4, 5)
    by = 30.0 * np.array([0.6, 0.0, 0.8])
    seen = measure([elsewhere(shape, np.eye(3), by)], alone(shape))
    assert seen.drift == pytest.approx([30.0], abs=EXACT)
    assert seen.drift_along == pytest.approx([30.0], abs=EXACT)
    assert seen.drift_across == pytest.approx([0.0], abs=EXACT)


# ----------------------------------------------------------------------------------------------------------- boundaries
@pytest.mark.parametrize("corners", [3, 5, 6])
def test_a_polygon_that_reaches_beyond_its_reference_is_as_far_from_it_as_its_corner(corners):
    shape = random_polygon(2, corners)
    middle = shape.outline.mean(axis=0)
    less = replace(shape, outline=middle + 0.9 * (shape.outline - middle))
    seen = measure([shape], alone(less))
    reach = 0.1 * np.linalg.norm(shape.outline - middle, axis=-1).max()
    assert seen.hausdorff == pytest.approx([reach], rel=0.05)
    assert seen.max_deviation.max() <= EXACT


# ---------------------------------------------------------------------------------------------------------------- seams
@pytest.mark.parametrize("gap", [0.0, 0.25, 7.0])
@pytest.mark.parametrize("chain", ["pcp", "p"])
def test_panels_apart_by_a_known_gap_have_that_gap_at_all_corners_and_along_the_seam(gap, chain):
    fold = folded_panel() if chain == "pcp" else folded_panel(chain="p", widths=(500.0,), turns=(0.0,))
    pair = fold, moved(fold, (1000.0 + gap, 0.0, 0.0))
    reference = replace(alone(*pair), seams=(Seam(panels=(0, 1), edges=(1, 0), reversed=False),))
    found = measure(pair, reference)
    (gaps,) = found.corner_gaps
    assert gaps == pytest.approx(np.full(len(fold.points), gap), abs=EXACT)
    assert found.seam_gap == pytest.approx([gap], abs=EXACT)
    assert (found.max_corner_gap, found.max_seam_gap) == (gaps.max(), found.seam_gap.max())
    assert found.kink == pytest.approx([0.0], abs=1e-6)


def test_a_seam_told_from_the_other_panel_has_the_same_gaps_in_the_order_of_the_first():
    fold = folded_panel()
    pair = fold, moved(fold, (1003.0, 2.0, 0.0))
    told = [Seam(panels=(0, 1), edges=(1, 0), reversed=False), Seam(panels=(1, 0), edges=(0, 1), reversed=False)]
    one, other = (measure(pair, replace(alone(*pair), seams=(seam,))) for seam in told)
    assert one.corner_gaps[0] == pytest.approx(other.corner_gaps[0], abs=EXACT)
    assert one.seam_gap == pytest.approx(other.seam_gap, abs=EXACT)


def test_edges_of_different_pieces_meet_at_their_outermost_corners():
    """The end of a fold and a straight edge: inner corners have none that they could meet."""
    fold = folded_panel()
    first, last = fold.corners()[1, [0, -1]]
    beyond, along = np.array([400.0, 0.0, 0.0]), last - first
    outline = np.array([first, last, last + beyond, first + 0.5 * along + 1.5 * beyond, first + beyond])
    normal = np.cross(along, beyond) / np.linalg.norm(np.cross(along, beyond))
    pent = PolygonShape(name="plate", feature="planar-polygon", outline=outline, normal=-normal)
    reference = replace(alone(fold, pent), seams=(Seam(panels=(0, 1), edges=(1, 0), reversed=False),))
    found = measure([fold, pent], reference)
    assert found.corner_gaps[0] == pytest.approx([0.0, 0.0], abs=EXACT)
    assert found.seam_gap[0] > 50.0


def test_panels_that_meet_at_an_angle_have_that_kink():
    up, lean = np.array([0.0, 0.0, 1.0]), np.array([np.sin(0.1), 0.0, np.cos(0.1)])
    down = np.array([np.cos(0.1), 0.0, -np.sin(0.1)])
    base = np.array([[0.0, 0.0, 0.0], [800.0, 0.0, 0.0], [800.0, 600.0, 0.0], [400.0, 900.0, 0.0], [0.0, 600.0, 0.0]])
    roof = PolygonShape(name="a", feature="planar-polygon", outline=base, normal=up)
    edge = base[[1, 2]]
    low = edge + 700.0 * down
    beyond = np.stack([edge[0], low[0], low.mean(axis=0) + 200.0 * down, low[1], edge[1]])
    wall = PolygonShape(name="b", feature="planar-polygon", outline=beyond, normal=lean)
    pair = replace(alone(roof, wall), seams=(Seam(panels=(0, 1), edges=(1, 4), reversed=True),))
    found = measure([roof, wall], pair)
    assert found.kink == pytest.approx([0.1], abs=EXACT)
    assert found.seam_gap == pytest.approx([0.0], abs=EXACT)


def test_without_seams_there_is_no_gap():
    fold = folded_panel()
    found = measure([fold], alone(fold))
    assert found.corner_gaps == ()
    assert found.seam_gap.shape == found.kink.shape == found.widest_corners.shape == (0,)
    assert found.max_corner_gap == found.max_seam_gap == 0.0
