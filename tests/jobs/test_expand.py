"""What regions take over, and matrices: what is no matrix is refused where it stands."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.errors import SettingsError
from cadpanel.jobs.expand import MOST_COMBINATIONS, Given, expanded, out_of, variables_of
from cadpanel.jobs.job_file import JobFile


def given(folder: Path, text: str) -> list[Given]:
    path = folder / "job.toml"
    path.write_text(text, encoding="utf-8")
    file = JobFile(path)
    variables = variables_of(file)
    out_of(file, variables)
    return expanded(file, variables)


def values(folder: Path, text: str) -> dict[str, dict[str, object]]:
    return {one.name: dict(one.values) for one in given(folder, text)}


def test_a_matrix_is_over_settings_references_and_variables_that_are_used(tmp_path: Path) -> None:
    text = 'A.rules.lock = [{panels = "${who}"}]\nA.matrix.seed = [1, 2]\nA.matrix.reference = ["a", "b"]\n'
    found = values(tmp_path, f'[regions]\n{text}A.matrix.who = ["N"]\n')
    assert found["A-seed=2-reference=a-who=N"] == {
        "rules": {"lock": [{"panels": "N"}]},
        "seed": 2,
        "reference": "a",
    }
    assert len(found) == 4


def test_variables_may_be_made_of_those_above_them(tmp_path: Path) -> None:
    text = '[variables]\na = "x"\nb = "${a}y"\nc = "${b}z"\n[regions.A]\nreference = "${c}"\n'
    assert values(tmp_path, text) == {"A": {"reference": "xyz"}}


def test_a_region_knows_its_name_in_its_matrix_too(tmp_path: Path) -> None:
    found = values(tmp_path, '[regions.A.matrix]\nreference = ["${region}.step"]\n')
    assert found == {"A-reference=A.step": {"reference": "A.step"}}


def test_what_a_matrix_makes_gives_way_to_what_is_named_by_hand(tmp_path: Path) -> None:
    text = '[regions]\nA.matrix.seed = [1]\n"A-seed=1" = {seed = 9}\n"a-SEED=1" = {seed = 8}\n'
    with pytest.raises(SettingsError, match="line 4: the region 'a-SEED=1' is called as another one"):
        values(tmp_path, text)
    found = values(tmp_path, text[: text.index('"a-')])
    assert found == {"A-seed=1-2": {"seed": 1}, "A-seed=1": {"seed": 9}}


def test_an_accent_may_be_written_both_ways(tmp_path: Path) -> None:
    assert list(values(tmp_path, '[regions."e\u0301"]\n')) == ["\u00e9"]
    with pytest.raises(SettingsError, match="line 2: the region '\u00e9' is called as another one"):
        values(tmp_path, '[regions."\u00e9"]\n[regions."e\u0301"]\n')


NAMES = "a matrix has settings, and variables that the region uses"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[regions.A.matrix]\ngap_tolerence = [1]", f"line 2: region 'A': {NAMES}; .* perhaps 'gap_tolerance'"),
        ("[regions.A]\nmaterial = '${side}'\nmatrix.sied = [1]", f"line 3: region 'A': {NAMES}; .* perhaps 'side'"),
        ("[regions.A]\nmaterial = '$${side}'\nmatrix.side = [1]", f"line 3: region 'A': {NAMES}"),
        (
            "[defaults.matrix]\nside = [1]\n[regions.A]\nmaterial = '${side}'\n[regions.B]",
            f"line 2: region 'B': {NAMES}",
        ),
        ("[regions.A]\n[regions.A.matrix]\nsha256 = ['0']", "line 3: region 'A': a matrix has no 'sha256'"),
        ("[regions.A.matrix]\nmatrix = [1]", f"line 2: region 'A': {NAMES}"),
        ("[regions.A.matrix]\nseed = [1]\ndivide = [2, 3, 2]", "line 3: region 'A': 'divide' in a matrix has 2 twice"),
        ("[regions.A.matrix]\nonly = ['*', '*']", r"line 2: region 'A': 'only' in a matrix has '\*' twice"),
        ("[regions.A.matrix]\nseed = []", "line 2: region 'A': 'seed' in a matrix is a list"),
        ("[regions.A]\nmatrix = [1]", "line 2: a matrix is a table of lists"),
        ("[regions.A.matrix]\nseed = [1]\ndivide = ['${seed}']", "line 1: 'seed' is of this matrix itself"),
        ("[variables]\nb = 1\na = '${c}'\nc = 1\n[regions.A]", "line 3: .* those above it alone, and 'c' is none"),
        ("[variables]\na = 'x${a}'\n[regions.A]", "line 2: .* those above it alone, and 'a' is none"),
        ("[variables]\na = '${region}'\n[regions.A]", "line 2: 'region' is the name of a region"),
        ("out = '${region}'\n[regions.A]", "line 1: 'region' is the name of a region"),
        ('out = "a\\u0000"\n[regions.A]', "line 1: 'out' must be the name of a folder"),
        ("[regions.'Job.TOML']", "line 1: the region 'Job.TOML' is called as a file"),
        ("[regions.A]\n[regions.'b/c'.matrix]\nseed = [1]", "line 2: the region 'b/c' cannot have a folder"),
    ],
)
def test_what_is_wrong_is_refused_where_it_stands(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        given(tmp_path, text)


def test_1_and_true_and_their_like_are_not_the_same_value(tmp_path: Path) -> None:
    found = values(tmp_path, '[regions.A.matrix]\nseed = [1, true, 1.0, "1"]\n')
    assert [*found] == ["A-seed=1", "A-seed=True", "A-seed=1.0", "A-seed=1-2"]


def test_a_slip_of_the_pen_does_not_make_millions_of_regions(tmp_path: Path) -> None:
    count = round(MOST_COMBINATIONS**0.5) + 1
    text = f"seed = {list(range(count))}\nthickness = {list(range(count))}"
    with pytest.raises(SettingsError, match=f"line 1: the matrix of region 'A' has {count**2} combinations"):
        given(tmp_path, f"[regions.A.matrix]\n{text}")
