from __future__ import annotations

import pytest

from cadpanel.jobs.lines import line_of

TEXT = '''# divide is told below
title = """
divide = 7
"""
list = [
  1,
]
[defaults]
reference = "a.step"
[regions.A]
divide = 4
"st\\u0061tions" = [
  1, # divide
  2,
]
matrix.gap_tolerance = [1]
[regions."B C"]
inner = {divide = 3, faces = ["divide"]}
'''


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("title",), 2),
        (("list",), 5),
        (("defaults", "reference"), 9),
        (("regions", "A", "divide"), 11),
        (("regions", "A", "stations"), 12),
        (("regions", "A", "matrix", "gap_tolerance"), 16),
        (("regions", "B C"), 17),
        (("regions", "B C", "inner", "divide"), 18),
    ],
)
def test_a_key_stands_on_the_line_that_it_is_written_on(path: tuple[str, ...], line: int) -> None:
    assert line_of(TEXT, path) == line


def test_only_ends_of_lines_end_one() -> None:
    """Python knows more of them than TOML and editors."""
    assert line_of('a = "\u2028\x85"\nb = 1\r\nc = 2\n', ("c",)) == 3


def test_what_is_not_there_is_missing_in_the_table_around_it() -> None:
    assert line_of(TEXT, ("regions", "A", "reference")) == line_of(TEXT, ("regions", "A")) == 10
    assert line_of(TEXT, ("variables", "a")) == 1
