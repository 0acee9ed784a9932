"""How many cases the tests try: few on every run, many where `CADPANEL_THOROUGH=1` is set, as `.ci/run` does once.

Few are enough to see a rule broken; many are what a rule was promised for. Both are the same on every run.
"""

from __future__ import annotations

import os
from typing import TypeVar

import pytest

Cases = TypeVar("Cases")

THOROUGH = os.environ.get("CADPANEL_THOROUGH", "") not in ("", "0")


def cases(few: Cases, many: Cases) -> Cases:
    """Those to try: `few` as a rule, `many` in a thorough run."""
    return many if THOROUGH else few


thorough = pytest.mark.skipif(not THOROUGH, reason="many seconds: tried where CADPANEL_THOROUGH=1 is set")
