"""Rules that contradict each other, or a limit, are refused before anything is fitted."""

import pytest

from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.book import rules_of
from cadpanel.fitting.rules.contradictions import refuse_contradictions
from cadpanel.fitting.rules.rule import Fitted, Outcome, Place, Posed
from cadpanel.fitting.settings import FitSettings
from tests.ruled import ruled, strip


class Wanting(Posed):
    """A rule that wants points in places."""

    def __init__(self, *places: Place) -> None:
        self._places = places

    def places(self) -> list[Place]:
        return list(self._places)

    def outcome(self, fitted: Fitted) -> Outcome:
        raise NotImplementedError


def wanting(rule: str, z: float, within: float, point: int = 3) -> Wanting:
    return Wanting(Place(rule, 1, point, (0.0, 0.0, z), (float("inf"), 5.0, within)))


@pytest.mark.parametrize(("z", "point", "refused"), [(2.999, 3, False), (3.001, 3, True), (3.001, 4, False)])
def test_a_point_cannot_be_in_two_places_farther_apart_than_rules_leave(z: float, point: int, refused: bool) -> None:
    rules = [wanting("one", 0.0, 1.0), wanting("other", z, 2.0, point)]
    if not refused:
        refuse_contradictions(rules, ["A", "B"])
        return
    said = r"rules 'one' and 'other' contradict each other: .* panel 'B' in places 3.001 mm apart, and leave 3 mm"
    with pytest.raises(SettingsError, match=said):
        refuse_contradictions(rules, ["A", "B"])


def test_a_panel_that_is_made_cannot_be_locked_to_the_drawing_too() -> None:
    """All its points stand where a corner of it is drawn, so that another corner is far from there."""
    corner = tuple(strip().panels[1].corners[0, 0].tolist())
    made = rules_of({"lock": [{"panels": "N 2"}, {"panels": "N 2", "delivery": "earlier", "made": [[corner] * 8]}]})
    with pytest.raises(SettingsError, match="'N 2 in the drawn place' and 'N 2 as in earlier'"):
        ruled(made)  # type: ignore[arg-type] # rules are taken, too


def test_tools_that_are_all_tighter_than_the_least_radius_are_refused() -> None:
    with pytest.raises(SettingsError, match="makes a radius of 28 mm, where 30 mm is the least"):
        FitSettings(rules={"shop": {"radii": [20, 25], "add": 3}}, min_radius=30.0)  # type: ignore[arg-type]
    FitSettings(rules={"shop": {"radii": [20, 27], "add": 3}}, min_radius=30.0)  # type: ignore[arg-type]
