"""Names that may have been meant."""

import pytest

from cadpanel.near import did_you_mean


@pytest.mark.parametrize(
    ("name", "names", "said"),
    [
        ("nw-1", ["NW-01", "SE-07"], "did you mean 'NW-01'?"),
        ("gap", ["gaps", "width", "lap"], "did you mean 'gaps' or 'lap'?"),
        ("roof", ["A", "B", "C", "D", "E"], "there is 'A', 'B', 'C' and 2 more"),
        ("roof", [], "there is none at all"),
    ],
)
def test_names_nearly_like_it_are_told_else_those_that_there_are(name, names, said):
    assert did_you_mean(name, names) == said
