"""So many panels are refused only where some of them must be too short, with a number for which there is room."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.cutting.smallest_panel import require_room
from cadpanel.errors import SettingsError
from cadpanel.reference.assemble import LARGEST_TOLERANCE
from cadpanel.reference.outline_walk import least_edge

lengths = st.lists(st.floats(100.0, 20_000.0), min_size=1, max_size=4)


@given(lengths=lengths, size=st.floats(0.0, 5000.0), count=st.integers(2, 5000), tolerance=st.floats(0.1, 5.0))
def test_panels_are_refused_from_their_least_length_on_and_the_advice_is_taken(lengths, size, count, tolerance):
    lengths = [length for length in lengths if length > tolerance]
    least = max(tolerance / LARGEST_TOLERANCE, least_edge(size))
    fits = max(lengths) * 1.01 >= least * count
    if fits:
        require_room(lengths, size, count, "face 1", tolerance)
        return
    with pytest.raises(SettingsError, match=f"{count} panels along face 1") as caught:
        require_room(lengths, size, count, "face 1", tolerance)
    said = str(caught.value)
    advised = re.search(r"ask for (\d+) or fewer", said)
    if advised is None:
        assert "do not cut it that way" in said
    else:
        assert 1 < int(advised[1]) < count
        require_room(lengths, size, int(advised[1]), "face 1", tolerance)
    # A smaller tolerance helps where that rules, and only there.
    assert ("smaller seam tolerance" in said) == (tolerance / LARGEST_TOLERANCE > least_edge(size))


def test_one_panel_and_edges_without_length_are_never_refused():
    require_room([0.5], 0.0, 1, "face 1", 1.0)
    require_room([0.5, 1.0], 0.0, 1000, "face 1", 1.0)
    require_room([], 0.0, 1000, "face 1", 1.0)


@pytest.mark.parametrize(("part", "refused"), [(0.98, True), (1.0, False)])
def test_the_longest_edge_counts(part, refused):
    """Panels on it may be longer than on the others: what is certain is the mean panel there."""
    least = 1.0 / LARGEST_TOLERANCE
    wanted = [10.0 * part * least, 3.0 * least]
    if refused:
        with pytest.raises(SettingsError, match="ask for 2 or fewer, or give a smaller seam tolerance"):
            require_room(wanted, 0.0, 10, "the strip", 1.0)
    else:
        require_room(wanted, 0.0, 10, "the strip", 1.0)
