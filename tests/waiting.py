"""Waiting for what other processes do."""

from __future__ import annotations

import time
from collections.abc import Callable


def until(found: Callable[[], object], seconds: float = 120.0) -> None:
    """Wait until something is found, and fail where that takes longer than so many seconds."""
    give_up = time.monotonic() + seconds
    while not found():
        assert time.monotonic() < give_up
        time.sleep(0.05)
