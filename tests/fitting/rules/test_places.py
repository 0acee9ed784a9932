"""Rules about where panels are: features, seams, locked corners, mirror images."""

from typing import Any

import numpy as np
import pytest

from cadpanel.arrays import Array
from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.boundary import boundary_of
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from tests.known_panels import moved
from tests.ruled import free, radii, ruled, strip


def test_a_panel_has_the_feature_that_its_rule_gives() -> None:
    found = ruled({"feature": [{"panels": "N 2", "feature": "plane-cylinder-plane"}]})
    assert [shape.feature for shape in found.shapes] == [
        "plane-cone-plane",
        "plane-cylinder-plane",
        "plane-cone-plane",
        "plane-cone-plane",
    ]
    assert found.outcomes[0].kept


def test_one_seam_is_narrower_and_one_wider_than_all_others() -> None:
    general = free().measures.seam_step
    assert general.max() > 1.0
    asked = {"seam": [{"between": ["N 1", "N 2"], "step": 0.3}, {"between": ["N 4", "N 3"], "step": 9.0}]}
    found = ruled(asked, step=1.0)
    assert found.tolerance_met
    assert found.measures.seam_step[0] <= 0.3
    assert found.measures.seam_step[1] <= 1.0 < found.measures.seam_step[2] <= 9.0
    assert [outcome.allowed for outcome in found.outcomes] == [0.3, 9.0]


def test_a_seam_that_is_given_more_saves_what_its_price_tells() -> None:
    tight, more = ruled(None, gap_tolerance=0.2), 0.05
    found = ruled({"seam": [{"between": ["N 1", "N 2"], "gap": 0.2 + more}]}, gap_tolerance=0.2)
    saved = tight.measures.overall_rms - found.measures.overall_rms
    assert saved == pytest.approx(more * tight.seam_prices[0], rel=0.1)
    assert tight.seam_prices[1] < 0.2 * tight.seam_prices[0]


def test_a_part_that_is_held_nowhere_else_and_the_whole_gap_of_one_seam() -> None:
    found = ruled(
        {"seam": [{"between": ["N 1", "N 2"], "gap": 0.5}, {"between": ["N 2", "N 3"], "shift": 0.05}]},
        gap_tolerance=2.0,
    )
    assert found.tolerance_met
    assert found.measures.gaps["gap"][0] <= 0.5 < found.measures.gaps["gap"].max() <= 2.0
    assert found.measures.seam_shift[1] <= 0.05


def test_a_locked_corner_stays_in_the_drawn_place() -> None:
    drawn = strip().panels[1].corners.reshape(-1, 3)
    outer = [0, 3, 4, 7]

    def off(result, corner):
        return np.linalg.norm(boundary_of(result.shapes[1])[outer[corner]] - drawn[corner])

    found = ruled({"lock": [{"panels": "N 2", "corners": [1, 2], "within": 0.05}]})
    assert found.tolerance_met
    assert max(off(found, 1), off(found, 2)) <= 0.05
    assert min(off(free(), 1), off(free(), 2)) > 1.0
    assert off(found, 0) > 0.1


def test_a_panel_mirrors_another_to_its_arcs() -> None:
    found = ruled({"mirror": [{"panel": "N 4", "of": "N 1"}, {"panel": "N 2", "of": "N 3", "within": 0.2}]})
    assert found.tolerance_met
    assert [outcome.allowed for outcome in found.outcomes] == [0.05, 0.2]
    first, last = (boundary_of(found.shapes[i]) for i in (0, 3))
    within = np.linalg.norm(first[:, None] - first[None], axis=2)
    # Distances between the points of a panel are those between their images, the ends the other way round.
    order = np.concatenate([np.arange(8).reshape(2, 4)[::-1].ravel(), 8 + np.arange(6).reshape(2, 3)[::-1].ravel()])
    there = np.linalg.norm(last[order][:, None] - last[order][None], axis=2)
    assert np.abs(within - there).max() <= 0.1
    assert radii(found)[0] == pytest.approx(radii(found)[3], abs=1.0)
    assert abs(radii(free())[0] - radii(free())[3]) > 10.0


def upright() -> Array:
    """Turns the strip such that the seam in its middle is drawn level: its plane's normal, by least squares, is up."""
    drawn = strip().panels[1].edges[1]
    _, _, ways = np.linalg.svd(drawn - drawn.mean(axis=0))
    return np.asarray(np.linalg.det(ways) * ways)


def test_a_level_seam_is_at_the_height_at_which_it_is_drawn() -> None:
    tower = moved(strip(), upright(), np.zeros(3))
    rules: Any = {"level": [{"between": ["N 2", "N 3"], "within": 0.1}]}
    heights = {}
    for name, how in (("free", FitSettings(step=1.0)), ("level", FitSettings(step=1.0, rules=rules))):
        result = fit(tower, how)
        assert result.tolerance_met
        ends = [boundary_of(result.shapes[panel])[:, 2] for panel in (1, 2)]
        heights[name] = np.concatenate([ends[0][[4, 5, 6, 7, 11, 12, 13]], ends[1][[0, 1, 2, 3, 8, 9, 10]]])
    assert np.ptp(heights["level"]) <= 0.1 < 0.2 < np.ptp(heights["free"])


def test_a_strip_whose_seams_are_upright_has_none_that_are_level() -> None:
    with pytest.raises(SettingsError, match="level in the drawing"):
        ruled({"level": [{}]})
