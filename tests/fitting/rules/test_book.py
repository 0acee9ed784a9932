"""Files of rules: what they may hold, how what they may not is refused, and that they are read back as written."""

from pathlib import Path

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.book import rules_of
from cadpanel.fitting.rules.catalogue import RULES
from cadpanel.fitting.settings import FitSettings
from tests.ruled import ruled

EVERY = """
[[feature]]
panels = "N 1"
feature = "plane-cylinder-plane"
[[seam]]
between = ["N 1", "N 2"]
step = 1
gap = 2.5
[[level]]
within = 1.5
[[lock]]
panels = ["N 2"]
corners = [0, 3]
within = 0.5
[[mirror]]
panel = "N 1"
of = "N 4"
point = [0, 0, 0]
normal = [1, 0, 0]
[[equal]]
panels = ["N 1", "N *"]
radius = true
half_angle = true
[kinds]
most = 2
[shop]
radii = [350, 300, 350]
add = 3
"""


def test_every_rule_of_the_catalogue_is_read_and_read_back(tmp_path: Path) -> None:
    (tmp_path / "rules.toml").write_text(EVERY, encoding="utf-8")
    rules = rules_of(tmp_path / "rules.toml")
    assert rules is not None
    assert {type(rule) for rule in rules.rules} == set(RULES)
    assert rules_of(rules.plain()) == rules
    assert rules.plain()["shop"] == {"radii": (300.0, 350.0), "add": 3}
    assert rules.plain()["equal"][0]["half_angle"] is True


@pytest.mark.parametrize(
    ("rules", "said"),
    [
        ({"equals": []}, r"there is no rule \[equals\]; there is \[equal\]"),
        ({"shop": {"radius": [300]}}, r"\[shop\] has no 'radius'; it has 'radii'"),
        ({"shop": {}}, r"\[shop\] lacks something: it can have 'radii', 'add'"),
        ({"shop": {"radii": [0]}}, "at least 0.1 mm, not 0 mm"),
        ({"shop": [{"radii": [300]}]}, r"begins with \[shop\] on a line"),
        ({"equal": {"panels": "N 1"}}, r"begins with \[\[equal\]\] on a line"),
        ({"equal": [{"panels": "*"}]}, "radius = true"),
        ({"equal": [{"panels": "*", "radius": 1}]}, "are true or false"),
        ({"equal": [{"panels": 3, "radius": True}]}, "names like 'NW-03'"),
        ({"kinds": {"most": 0}}, "at least 1"),
        ({"kinds": {"most": True}}, "are a number"),
        ({"kinds": {"most": 2, "of": "moulds"}}, "of 'bends' or of 'radii', not of 'moulds'"),
        ({"seam": [{"between": ["A"], "step": 1}]}, "between two panels"),
        ({"seam": [{"between": ["A", "B"]}]}, "gap, width, step or shift, or its joint"),
        ({"seam": [{"between": ["A", "B"], "step": -1}]}, "at least 0.001 mm"),
        ({"lock": [{"panels": "A", "delivery": "old", "corners": [1]}]}, "leave its corners out"),
        ({"mirror": [{"panel": "A", "of": "A"}]}, "two panels"),
        ({"mirror": [{"panel": "A", "of": "B", "point": [0, 0, 0]}]}, "a point and a normal"),
        ({"feature": [{"panels": "A", "feature": "auto"}]}, "one of the catalogue"),
        ({"feature": [{"panels": "A", "feature": "cylindre"}]}, "there is no feature 'cylindre'"),
        (7, "the name of a TOML file"),
        ("nowhere.toml", "cannot be read: No such file"),
    ],
)
def test_what_is_no_rule_is_refused_in_one_sentence(rules: object, said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        rules_of(rules)


def test_a_file_that_is_no_toml_is_told_with_its_line(tmp_path: Path) -> None:
    (tmp_path / "rules.toml").write_text("[shop]\nradii = 300,", encoding="utf-8")
    with pytest.raises(SettingsError, match=r"rules.toml' is no TOML: .*line 2"):
        rules_of(tmp_path / "rules.toml")


@pytest.mark.parametrize(
    ("rules", "said"),
    [
        ({"equal": [{"panels": "N-1", "radius": True}]}, "names the panel 'N-1', which is not there; .* 'N 1'"),
        ({"equal": [{"panels": "N 1", "radius": True}]}, "two panels at least, and there is only 'N 1'"),
        ({"feature": [{"panels": "M *", "feature": "cone"}]}, "names the panel 'M \\*', which is not there"),
        ({"seam": [{"between": ["N 1", "N 3"], "step": 1}]}, "do not meet; on seams of 'N 1' there are 'N 1', 'N 2'"),
        ({"lock": [{"panels": "N 1", "corners": [4]}]}, "corner 4 of panel 'N 1', which has corners 0 to 3"),
        ({"mirror": [{"panel": "N *", "of": "N 2"}]}, "without \\*"),
        ({"mirror": [{"panel": "N 1", "of": "N 2", "point": [0, 0, 0], "normal": [0, 0, 1]}]}, "no mirror images"),
    ],
)
def test_a_rule_that_names_what_is_not_there_is_refused_with_what_is(rules: dict[str, object], said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        ruled(rules)


def test_a_rule_about_bends_wants_panels_that_bend_alike() -> None:
    flat = {"feature": [{"panels": "N 2", "feature": "plane-cone-cone-plane"}]}
    with pytest.raises(SettingsError, match="'N 1' has 1, 'N 2' has 2"):
        ruled({**flat, "equal": [{"panels": "*", "radius": True}]})


def test_the_whole_gap_of_one_seam_limits_no_other_one_by_default() -> None:
    rules = rules_of({"seam": [{"between": ["A", "B"], "gap": 0.5}, {"between": ["B", "C"], "step": 4.0}]})
    assert rules is not None
    found = rules.gaps(FitSettings(shift=12.0).gaps, ["A", "B", "C"], np.array([[0, 1], [1, 2]]))
    assert found["gap"] == pytest.approx([0.5, 26.0])


@pytest.mark.parametrize(
    "how", [{"method": "two_stage"}, {"method": "local"}, {"feature": "auto", "max_deviation": 9.0}]
)
def test_rules_want_a_fit_that_can_hold_them(how: dict[str, object]) -> None:
    with pytest.raises(SettingsError, match="leave out"):
        FitSettings(rules={"shop": {"radii": [300]}}, **how)  # type: ignore[arg-type]
