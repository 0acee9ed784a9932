"""The law of components: what no seam connects comes out the same, to the last bit, with others or without."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.fitting.bends.asked import blends_of
from cadpanel.fitting.components import components, part_of
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.rules.book import rules_of
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.studies.held_points import judged_by
from tests.delivered import fitted, strip


def shifted(reference: Reference, prefix: str, by: float) -> Reference:
    """The same elsewhere, under other names."""
    move = np.array([0.0, by, 0.0])
    panels = tuple(
        replace(
            panel,
            name=f"{prefix}{panel.name}",
            points=panel.points + move,
            edges=tuple(edge + move for edge in panel.edges),
        )
        for panel in reference.panels
    )
    return replace(reference, panels=panels)


def together(first: Reference, second: Reference, order: list[int]) -> Reference:
    """Both in one reference, their panels in any order."""
    count = len(first.panels)
    panels = [*first.panels, *second.panels]
    new = {old: place for place, old in enumerate(order)}
    seams = [
        *first.seams,
        *(replace(one, panels=(one.panels[0] + count, one.panels[1] + count)) for one in second.seams),
    ]
    moved = [replace(one, panels=(new[one.panels[0]], new[one.panels[1]])) for one in seams]
    return replace(first, panels=tuple(panels[old] for old in order), seams=tuple(moved))


OTHER = shifted(strip(), "far ", 1e5)
ORDER = [4, 0, 5, 1, 2, 3]


@pytest.fixture(scope="module")
def both() -> FitResult:
    return fit(together(strip(), OTHER, ORDER))


def test_a_component_alone_is_as_with_others_in_any_order(both: FitResult) -> None:
    alone = fitted()
    for panel in strip().panels:
        place = [one.name for one in both.reference.panels].index(panel.name)
        own = alone.reference.panels.index(next(one for one in alone.reference.panels if one.name == panel.name))
        assert np.array_equal(both.shapes[place].corners(), alone.shapes[own].corners())
        assert both.measures.rms_deviation[place] == alone.measures.rms_deviation[own]
        assert both.local.rms_deviation[place] == alone.local.rms_deviation[own]
    assert set(alone.measures.seam_gap.tolist()) <= set(both.measures.seam_gap.tolist())


def test_what_is_told_of_all_is_made_of_what_is_told_of_each(both: FitResult) -> None:
    alone, other = both.parts[1], both.parts[0]
    assert [len(part) for part in both.parts] == [3, 3]
    assert both.tolerance_met == (alone.tolerance_met and other.tolerance_met)
    assert both.iterations == alone.iterations + other.iterations
    assert len(both.seam_prices) == len(both.reference.seams)
    assert sum(both.seam_prices) == pytest.approx(sum(alone.seam_prices), rel=0.05, abs=1e-6)


def test_a_fit_goes_on_from_one_of_several_components_and_is_judged_anew(both: FitResult) -> None:
    again = fit(both.reference, FitSettings(step=4.0), after=both)
    assert again.tolerance_met
    assert again.measures.overall_rms <= both.measures.overall_rms * (1.0 + 1e-6)
    judged = judged_by(both, FitSettings(step=0.5))
    assert not judged.tolerance_met
    assert judged.two_stage.overall_rms == pytest.approx(both.two_stage.overall_rms)


def test_seams_say_what_hangs_together_and_rules_tie_all() -> None:
    reference = together(strip(), OTHER, ORDER)
    assert [one.tolist() for one in components(reference, FitSettings())] == [[0, 2, 5], [1, 3, 4]]
    ruled = FitSettings(rules=rules_of({"equal": [{"panels": ["N 1", "far N 1"], "radius": True}]}))
    assert [one.tolist() for one in components(reference, ruled)] == [[0, 1, 2, 3, 4, 5]]
    loose = replace(reference, seams=reference.seams[:1])
    assert sorted(map(len, components(loose, FitSettings()))) == [2, 4]
    assert [one.tolist() for one in components(replace(reference, seams=()), FitSettings())] == [[0, 1, 2, 3, 4, 5]]
    part = part_of(reference, np.array([0, 2, 5]))
    assert [panel.name for panel in part.panels] == ["far N 2", "far N 3", "far N 1"]
    assert sorted(seam.panels for seam in part.seams) == [(0, 1), (2, 0)]


def test_a_blend_of_one_panel_is_known_to_its_component_alone_and_of_none_to_nobody() -> None:
    reference = together(strip(), OTHER, ORDER)
    with pytest.raises(SettingsError, match="N 9"):
        fit(reference, FitSettings(method="local", blend=blends_of("N 9=40-60%")))
    result = fit(reference, FitSettings(method="local", blend=blends_of("N 1=40-60%")))
    assert [len(part.settings.blend) for part in result.parts] == [0, 1]
