from __future__ import annotations

import json
from pathlib import Path

import pytest

from cadpanel.errors import SettingsError
from cadpanel.jobs.read import read_job

GOOD = """
[variables]
thick = 2
name = "lip"

[defaults]
reference = "${name}.step"
thickness = "${thick}"
outputs = ["step"]

[regions.NW]
drift_along = 4
rules = "rules.toml"

[regions.E]
divide = 4
thickness = 5
skin_side = "${side}"
[regions.E.matrix]
gap_tolerance = [1, 3.5]
side = ["outer", "inner"]
"""
SIDES = 'side = ["outer", "inner"]\n'


@pytest.fixture
def folder(tmp_path: Path, strip: Path) -> Path:
    (tmp_path / "lip.step").write_bytes((strip / "lip.step").read_bytes())
    (tmp_path / "rules.toml").write_text('[[lock]]\npanels = "N-01"\ncorners = [0, 1]\n', encoding="utf-8")
    return tmp_path


def written(folder: Path, text: str) -> Path:
    path = folder / "job.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_defaults_hold_for_all_regions_that_do_not_say_otherwise(folder: Path) -> None:
    job = read_job(written(folder, GOOD.replace(SIDES, "").replace('"${side}"', '"inner"')))
    assert [region.name for region in job.regions] == ["NW", "E-gap_tolerance=1", "E-gap_tolerance=3.5"]
    first, second, third = job.regions
    assert (first.sheet.thickness, second.sheet.thickness) == (2.0, 5.0)
    assert first.settings.drift_along == 0.04
    assert (second.settings.gap_tolerance, third.settings.gap_tolerance) == (1.0, 3.5)
    assert first.reference == folder / "lip.step"
    assert first.given["rules"] == {"lock": [{"panels": ["N-01"], "corners": [0, 1]}]}
    assert job.out is None


def test_a_matrix_may_be_of_variables_and_a_region_knows_its_name(folder: Path) -> None:
    text = GOOD.replace("[variables]", 'out = "../${name}"\n[variables]').replace("[regions.NW]", "[regions.lip]")
    job = read_job(
        written(
            folder,
            text.replace('"${name}.step"', '"${region}.step"', 1).replace(
                "[regions.E]",
                """
[regions.E]
reference = "lip.step"
""",
            ),
        )
    )
    assert [one.sheet.skin_side for one in job.regions] == ["outer", "outer", "inner", "outer", "inner"]
    assert job.out == folder.parent / "lip"


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("drift_along = 4", "drift_allong = 4", "line 12: there is no setting 'drift_allong' .*perhaps 'drift_along'"),
        (
            "drift_along = 4",
            "drift_along = 400",
            "line 12: region 'NW': drift_along must be between 0.01",
        ),
        (
            "drift_along = 4",
            'drift_along = "4"',
            "line 12: 'drift_along' of region 'NW': input should be",
        ),
        ("thick = 2", "thick = 2e9", "line 8: region 'NW': the sheet thickness must be between"),
        ("divide = 4", "divide = 4\ngrid = [2, 2]", "line 17: .*divide and grid are ways to cut the same"),
        ("divide = 4", "divide = 0", "line 16: .*whole number from 1"),
        ("divide = 4", 'divide = "auto"', "line 16: .*max_deviation"),
        ("[defaults]", "[default]", "line 6: a job has no 'default'; perhaps 'defaults' is meant"),
        (
            "[variables]",
            "seed = 1\n[variables]",
            "line 2: a job has no 'seed'; settings stand in .defaults. or",
        ),
        ("${thick}", "${thik}", "line 8: there is no variable 'thik'; perhaps 'thick' is meant"),
        ("${name}.step", "${name}.stp", r"line 7: '.*lip\.stp' does not exist"),
        ('"rules.toml"', '"rule.toml"', r"line 13: .*rule\.toml' cannot be read"),
        ('["step"]', '["stp"]', "line 9: there is no output 'stp'"),
        ("[1, 3.5]", "1", "line 20: region 'E': 'gap_tolerance' in a matrix is a list"),
        (
            "[regions.NW]",
            '[regions.".nw"]',
            r"line 11: the region '\.nw' cannot have a folder of its name: call it '_nw'",
        ),
        ("[variables]", "[variables", "is no TOML: .*line 2"),
    ],
)
def test_what_is_wrong_is_refused_with_its_line(folder: Path, right: str, wrong: str, said: str) -> None:
    assert right in GOOD
    with pytest.raises(SettingsError, match=said) as refused:
        read_job(written(folder, GOOD.replace(right, wrong, 1)))
    assert str(refused.value).count("\n") == 0


def test_a_job_without_regions_or_a_file_is_refused(folder: Path) -> None:
    with pytest.raises(SettingsError, match=r"at least one region"):
        read_job(written(folder, "[regions]"))
    with pytest.raises(SettingsError, match="line 1: region 'A' has no reference"):
        read_job(written(folder, "[regions.A]"))
    with pytest.raises(SettingsError, match="cannot be read"):
        read_job(folder / "none.toml")


def test_what_is_given_is_plain(folder: Path) -> None:
    """It goes into a file again, and into the key of the result."""
    assert json.loads(json.dumps([dict(one.given) for one in read_job(written(folder, GOOD)).regions]))


def test_a_sum_may_be_told_in_capitals(folder: Path) -> None:
    text = GOOD.replace("drift_along = 4", f'sha256 = "{"aB" * 32}"')
    assert read_job(written(folder, text)).regions[0].sha256 == "ab" * 32


LOCKED = 'A = {reference = "lip.step", method = "concurrent", rules = {lock = [{panels = "N-01", delivery = "old"}]}'


def test_earlier_deliveries_are_found_from_where_the_program_runs_or_as_the_job_names_them(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for place in ("old", "jobs/older"):
        (folder / place).mkdir(parents=True)
        (folder / place / "report.json").write_text("{}", encoding="utf-8")
    monkeypatch.chdir(folder)
    path = written(folder, f"[regions]\n{LOCKED}}}")
    assert read_job(path).regions[0].deliveries == {"old": folder / "old"}
    named = written(folder, f'[regions]\n{LOCKED}, deliveries = {{old = "jobs/older"}}}}')
    monkeypatch.chdir("jobs")
    assert read_job(named).regions[0].deliveries == {"old": folder / "jobs" / "older"}
    with pytest.raises(SettingsError, match=r"line 2: region 'A' locks panels to 'old'.*'deliveries'.*no report"):
        read_job(written(folder, f"[regions]\n{LOCKED}}}"))


@pytest.mark.parametrize(
    ("named", "said"),
    [
        ('old = "lip"', r"line 2: region 'A' locks panels to 'old': there is no report\.json in '.*lip'"),
        ('older = "lip"', "line 2: no .*lock.* is about the delivery 'older'; perhaps 'old'"),
        ("old = 1", "line 2: 'deliveries' of region 'A': input should be"),
    ],
)
def test_a_delivery_that_is_named_must_be_there_and_be_asked_for(folder: Path, named: str, said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        read_job(written(folder, f"[regions]\n{LOCKED}, deliveries = {{{named}}}}}"))
