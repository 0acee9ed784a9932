"""Colours by a number."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.delivery.document.colors import STOPS, ramp, share


def test_the_ramp_passes_through_its_stops_in_equal_steps() -> None:
    assert [ramp(i / (len(STOPS) - 1)) for i in range(len(STOPS))] == [pytest.approx(stop) for stop in STOPS]
    assert ramp(0.125) == pytest.approx([0.5 * (a + b) for a, b in zip(STOPS[0], STOPS[1], strict=True)])
    assert ramp(-1.0) == pytest.approx(STOPS[0])
    assert ramp(2.0) == pytest.approx(STOPS[-1])


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_more_is_never_darker(first: float, second: float) -> None:
    weights = (0.2126, 0.7152, 0.0722)
    low, high = (
        sum(weight * part for weight, part in zip(weights, ramp(value), strict=True))
        for value in sorted((first, second))
    )
    assert low <= high + 1e-12


def test_equal_numbers_are_all_the_least() -> None:
    assert (share(3.0, 3.0, 3.0), share(2.0, 1.0, 3.0)) == (0.0, 0.5)
