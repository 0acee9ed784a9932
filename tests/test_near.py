"""Names that may have been meant."""

import pytest

from cadpanel.near import near_names


@pytest.mark.parametrize(
    ("name", "names", "said"),
    [
        ("nw-1", ["NW-01", "SE-07"], "perhaps 'NW-01' is meant"),
        ("gap", ["gaps", "width", "lap"], "perhaps 'gaps' or 'lap' is meant"),
        ("roof", ["A", "B", "C", "D", "E"], "there is 'A', 'B', 'C' and 2 more"),
        ("roof", [], "there is none at all"),
    ],
)
def test_names_nearly_like_it_are_told_else_those_that_there_are(name, names, said):
    assert near_names(name, names) == said
