"""The mutation command finds what tests leave open, and only that; its list of changes that change nothing is true."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.mutation.equivalents import LIST, read_equivalents
from tests.mutation.mutants import mutants_of
from tests.thorough import thorough

ROOT = Path(__file__).resolve().parents[2]

SOURCE = '''"""Words with + and - are left alone."""
BOUND = 3


def ramp(x: float | None = None, most: float = 2.5) -> float:
    """Not < more."""
    if x is None or x < 0.0 and not x > 5:
        return -min(1.5, most) * (
            2 + BOUND
        )
    most -= 1
    return f"{x}" + "a" if most >= 0 else max(x, 4) / 2
'''


def test_each_sign_comparison_word_and_bound_is_changed_once_where_it_stands():
    found = [(mutant.line, mutant.old, mutant.new) for mutant in mutants_of("a.py", SOURCE)]
    assert found == [
        *[(7, "or", "and"), (7, "<", "<="), (7, "0.0", "0.25"), (7, "and", "or"), (7, ">", ">="), (7, "5", "6")],
        *[(8, "-", ""), (8, "1.5", "1.875"), (8, "*", "/"), (9, "+", "-"), (11, "-", "+")],
        *[(12, ">=", ">"), (12, "0", "1"), (12, "4", "5"), (12, "/", "*")],
    ]


def test_a_change_touches_its_place_alone_and_knows_its_function():
    for mutant in mutants_of("a.py", SOURCE):
        before, after = SOURCE.splitlines(), mutant.applied(SOURCE).splitlines()
        changed = [number for number, (old, new) in enumerate(zip(before, after, strict=True), start=1) if old != new]
        assert changed == [mutant.line]
        assert mutant.lines(SOURCE) == (before[mutant.line - 1].strip(), after[mutant.line - 1].strip())
        assert mutant.function == (5, 12)


def test_a_place_behind_letters_beyond_ascii_is_met():
    (mutant,) = mutants_of("a.py", 'x = len("äöü°") - 1\n')
    assert mutant.applied('x = len("äöü°") - 1\n') == 'x = len("äöü°") + 1\n'


def test_every_change_that_is_listed_as_changing_nothing_can_still_be_made_and_has_a_reason():
    found = read_equivalents(ROOT)
    assert [one for one in found if not one.applies(ROOT)] == []
    assert [one for one in found if len(one.reason) < 20] == []
    assert len({(one.path, one.before, one.after) for one in found}) == len(found)


TEST = """from cadpanel.slope import rise


def test_rise():
    assert rise(3.0, 2.0) == 6.0
"""


@pytest.fixture
def checkout(tmp_path):
    """A checkout of one small module."""
    for path, text in {
        "cadpanel/__init__.py": "",
        "cadpanel/slope.py": "def rise(run, grade):\n    return run * grade if run > 1 else -run\n",
        "tests/test_slope.py": TEST,
        "pyproject.toml": '[tool.pytest.ini_options]\npythonpath = ["."]\n',
    }.items():
        file = tmp_path / path
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
    (tmp_path / "tests" / "__init__.py").touch()
    shutil.copytree(
        Path(__file__).parent, tmp_path / "tests" / "mutation", ignore=shutil.ignore_patterns("test_*", "*.txt")
    )
    return tmp_path


def run(checkout, *words):
    return subprocess.run(
        [sys.executable, "-m", "tests.mutation", "--root", str(checkout), "--modules", "slope", *words],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
    )


@thorough
def test_weak_tests_leave_survivors_and_strong_ones_none(checkout):
    weak = run(checkout)
    assert weak.returncode == 1, weak.stderr
    assert "cadpanel/slope.py:2" in weak.stdout
    assert "return run * grade if run > 1 else run" in weak.stdout
    assert "4 changes in" in weak.stdout
    assert "1 killed" in weak.stdout
    more = "    assert (rise(1.0, 2.0), rise(2.0, 2.0), rise(0.5, 9.0)) == (-1.0, 4.0, -0.5)\n"
    (checkout / "tests" / "test_slope.py").write_text(TEST + more)
    strong = run(checkout)
    assert strong.returncode == 0, strong.stdout + strong.stderr
    assert "0 survived" in strong.stdout
    assert (checkout / "cadpanel" / "slope.py").read_text().count("*") == 1


KINDS = """from functools import cache

STEEP = 2 * 1.5


class Slope:
    def __init__(self, run):
        self.run = run

    @property
    def half(self):
        def part(of):
            return of / 2

        return part(self.run)


@cache
def doubled(run):
    return run * 2
"""

TEST_OF_KINDS = """import pytest
from cadpanel.slope import STEEP, Slope, doubled


@pytest.mark.parametrize("number", range(3))
def test_kinds(number):
    assert (STEEP, Slope(3.0).half, doubled(4.0))[number] == (3.0, 1.5, 8.0)[number]
"""


@thorough
def test_changes_are_noticed_in_methods_inner_and_kept_functions_and_outside_of_all(checkout):
    (checkout / "cadpanel" / "slope.py").write_text(KINDS)
    for left_out, survivor in ((None, None), (0, "STEEP"), (1, "return of"), (2, "return run")):
        chosen = TEST_OF_KINDS.replace("range(3)", str([number for number in range(3) if number != left_out]))
        (checkout / "tests" / "test_slope.py").write_text(chosen)
        answer = run(checkout)
        assert f"{'0' if survivor is None else '1'} survived" in answer.stdout, answer.stdout + answer.stderr
        assert survivor is None or survivor in answer.stdout


def test_tests_that_fail_as_they_are_are_told(checkout):
    (checkout / "tests" / "test_slope.py").write_text(TEST.replace("6.0", "7.0"))
    answer = run(checkout)
    assert answer.returncode == 2
    assert "The tests do not pass as they are" in answer.stdout


@thorough
def test_a_listed_change_is_not_tried_and_one_that_cannot_be_made_is_told(checkout):
    line = "return run * grade if run > 1 else -run"
    entry = f"cadpanel/slope.py\n{line}\n{line.replace('> 1', '>= 1')}\nnobody asks for a run of exactly one\n"
    (checkout / LIST).write_text(entry)
    assert "3 changes in" in run(checkout).stdout
    (checkout / LIST).write_text(entry.replace("run * grade", "run + grade"))
    answer = run(checkout)
    assert answer.returncode == 2
    assert "No such changes" in answer.stdout
