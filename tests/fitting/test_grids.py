"""Panels that meet all round: grids of flat and of rolled panels, honeycombs, and plates beside folded panels."""

from itertools import product

import numpy as np
import pytest

from cadpanel.features.catalogue import feature, polygon
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.measures.verdict import keeps_limits
from cadpanel.fitting.methods.concurrent import Concurrent
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.problem import pose
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.shape import PanelShape, PolygonShape, edge_corners
from cadpanel.geometry.sheet_checks import check_buildable
from tests.fitted_grids import CASES, asked, fitted, gable, read, reference
from tests.grids import dome, write_grid, write_mixed_row
from tests.known_panels import moved, renumbered
from tests.thorough import thorough

# Millimetres, on panels of 1.5 m.
SAME = 1e-3
FOUR_EDGES = ("end 0", "end 1", "side 0", "side 1")
every_case = pytest.mark.parametrize("name", CASES)


def edge_name(shape, edge):
    return f"edge {edge}" if isinstance(shape, PolygonShape) else FOUR_EDGES[edge]


def ends_apart(shapes, seam):
    """Distances of the outermost corners that meet at a seam, by nothing that the fit uses."""
    one, other = (
        edge_corners(shapes[panel].corners(), edge_name(shapes[panel], edge))[[0, -1]]
        for panel, edge in zip(seam.panels, seam.edges, strict=True)
    )
    return np.linalg.norm(one - (other[::-1] if seam.reversed else other), axis=-1)


@every_case
def test_panels_meet_all_round(name):
    of = reference(name)
    assert len(of.seams) == 12
    met = {(panel, edge) for seam in of.seams for panel, edge in zip(seam.panels, seam.edges, strict=True)}
    middle = next(i for i, panel in enumerate(of.panels) if panel.name in ("1,1", "H0"))
    assert {edge for panel, edge in met if panel == middle} == set(range(len(of.panels[middle].edges)))


@every_case
def test_all_seams_are_closed_at_once(name):
    result = fitted(name)
    assert result.tolerance_met
    assert result.shortfall() is None
    assert result.measures.max_seam_gap <= 1.0
    # The local fits leave gaps, so there was something to do.
    assert result.local.max_seam_gap > 5.0
    assert result.measures.overall_rms <= 2.0 * result.local.overall_rms


@every_case
def test_the_shapes_have_the_gaps_that_are_measured(name):
    result = fitted(name)
    for seam, gaps in zip(result.reference.seams, result.measures.corner_gaps, strict=True):
        assert ends_apart(result.shapes, seam) == pytest.approx(gaps[[0, -1]], abs=1e-9)


@every_case
def test_panels_of_a_grid_can_be_built(name):
    for shape in fitted(name).shapes:
        check_buildable(shape, 3.0)


@every_case
def test_moving_a_grid_moves_its_panels(name):
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = np.array([3000.0, -1000.0, 500.0])
    again = fit(moved(reference(name), turn, shift), asked(name))
    for one, other in zip(again.shapes, fitted(name).shapes, strict=True):
        assert one.corners() == pytest.approx(other.corners() @ turn.T + shift, abs=SAME)


@every_case
def test_renumbering_the_panels_of_a_grid_changes_nothing(name):
    order = np.random.default_rng(2).permutation(len(reference(name).panels)).tolist()
    again = fit(renumbered(reference(name), order), asked(name))
    for one, other in zip(again.shapes, (fitted(name).shapes[i] for i in order), strict=True):
        assert one.name == other.name
        assert one.corners() == pytest.approx(other.corners(), abs=SAME)


def test_four_plates_of_a_grid_meet_in_one_point():
    """No term holds panels together that meet in a corner only; the seams do."""
    shapes = {shape.name: shape for shape in fitted("planar-quadrilateral").shapes}
    for i, j in product((0, 1), (0, 1)):
        one, other = (shapes[name].corners().reshape(-1, 3) for name in (f"{i},{j}", f"{i + 1},{j + 1}"))
        assert np.linalg.norm(one[:, None] - other, axis=-1).min() <= 2.0


@thorough
def test_a_tolerance_that_no_grid_of_plates_can_hold_is_missed_and_told():
    """The smallest case that fails: a corner may not move."""
    how = FitSettings(
        feature="planar-quadrilateral", gap_tolerance=0.1, drift_along=1e-4, drift_across=1e-4, method="concurrent"
    )
    result = fit(reference("planar-quadrilateral"), how)
    assert not result.tolerance_met
    sentence = result.shortfall()
    assert sentence is not None
    assert "not met" in sentence


def test_arcs_of_gently_curved_panels_are_held_where_leaning_cuts_meet_them_at_a_small_angle():
    """A point near the other panel's cylinder and near its cut plane may be far from where the two meet."""
    of = read(write_grid, dome(100_000.0, 8000.0, 0.005))
    result = fit(of, FitSettings(feature="cylinder", gap_tolerance=1.0))
    assert result.tolerance_met
    assert result.measures.max_seam_gap <= 1.0
    assert result.measures.overall_rms <= 2.0 * result.local.overall_rms


# ---------------------------------------------------------------------------------------------- plates beside folds
CLOSED = FitSettings(gap_tolerance=1.0)


def mixed(twist, features):
    """A strip of two lips with a plate beside each, fitted concurrently: what was read, the shapes and the measures."""
    of = read(write_mixed_row, twist)
    by_name = [features[panel.name.partition(" ")[0]] for panel in of.panels]
    problem, starts = pose(of, by_name)
    local = fit_local(problem, of, starts)
    found = Concurrent().fit(problem, [local.unknowns], CLOSED)
    shapes = panel_shapes(problem, found.unknowns)
    return of, shapes, measure(panel_shapes(problem, local.unknowns), of), measure(shapes, of)


@pytest.mark.parametrize("plate", ["planar-quadrilateral", "planar-polygon"])
@pytest.mark.parametrize("twist", [0.5, 1.0])
def test_a_plate_meets_the_flange_of_a_folded_panel(twist, plate):
    chains = {"lip": feature("plane-cone-plane"), "plate": FitSettings(feature=plate).feature_for(4)}
    of, shapes, before, after = mixed(twist, chains)
    assert before.max_seam_gap > 2.0
    assert keeps_limits(after, CLOSED)
    for seam, gaps in zip(of.seams, after.corner_gaps, strict=True):
        assert ends_apart(shapes, seam) == pytest.approx(gaps[[0, -1]], abs=1e-9)
    sorts = [{of.panels[panel].name.partition(" ")[0] for panel in seam.panels} for seam in of.seams]
    along_folds = [i for i, sort in enumerate(sorts) if len(sort) == 2]
    assert len(along_folds) == 2
    # A flange and a plate meet along one straight edge of each: its two corners decide.
    assert [len(after.corner_gaps[i]) for i in along_folds] == [2, 2]
    assert after.seam_gap[along_folds] == pytest.approx([after.corner_gaps[i].max() for i in along_folds], abs=1e-6)
    kinds = {shape.name: [patch.kind for patch in shape.patches] for shape in shapes if isinstance(shape, PanelShape)}
    assert kinds["lip 0"] == ["plane", "cone", "plane"]
    assert kinds["plate 0"] == ["plane"]


@pytest.mark.parametrize("open_by", [0.0, 6.0])
def test_a_polygon_meets_the_flange_of_a_folded_panel(open_by):
    of = gable(open_by)
    problem, starts = pose(of, [feature("plane-cone-plane"), polygon(5)])
    local = fit_local(problem, of, starts)
    assert measure(panel_shapes(problem, local.unknowns), of).max_seam_gap == pytest.approx(open_by, abs=1e-3)
    found = Concurrent().fit(problem, [local.unknowns], CLOSED)
    after = measure(panel_shapes(problem, found.unknowns), of)
    assert keeps_limits(after, CLOSED)
    assert after.max_seam_gap <= min(1.0, open_by + 1e-6)
    assert after.overall_rms <= open_by + 1e-6
