"""How many cases the tests try: few on every run, many where `CADPANEL_THOROUGH=1` is set, as `.ci/run` does once.

Few are enough to see a rule broken; many are what a rule was promised for. Both are the same on every run.
"""

from __future__ import annotations

import os
import random
from collections import defaultdict
from collections.abc import Sequence
from typing import TypeVar

import pytest

Cases = TypeVar("Cases")

THOROUGH = os.environ.get("CADPANEL_THOROUGH", "") not in ("", "0")


def cases(few: Cases, many: Cases) -> Cases:
    """Those to try: `few` as a rule, `many` in a thorough run."""
    return many if THOROUGH else few


thorough = pytest.mark.skipif(not THOROUGH, reason="many seconds: tried where CADPANEL_THOROUGH=1 is set")


def left_for_a_thorough_run(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """The cases of tests marked `each_value_once` that are not tried now.

    Of a test with several parameters as many are tried as it takes for every value of each to occur: a rule that is
    broken for one of them is seen then, and what only a certain pair brings out is left to a thorough run.

    Args:
        items: the tests that were collected. Of a case that was asked for by its name there is one, and it stays.
    """
    if THOROUGH:
        return []
    cases_of: dict[str, list[pytest.Function]] = defaultdict(list)
    for item in items:
        if (
            isinstance(item, pytest.Function)
            and hasattr(item, "callspec")
            and item.get_closest_marker("each_value_once")
        ):
            cases_of[item.nodeid.partition("[")[0]].append(item)
    left: list[pytest.Item] = []
    for name, found in cases_of.items():
        seen: set[tuple[str, str]] = set()
        # In an order of its own for each test: in that of the list, all values would be paired with the first ones.
        for item in random.Random(name).sample(found, len(found)):
            values = {(parameter, repr(value)) for parameter, value in item.callspec.params.items()}
            if values <= seen:
                left.append(item)
            seen |= values
    return left
