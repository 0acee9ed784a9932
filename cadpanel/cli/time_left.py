"""How long what is made of like parts will go on, by the parts that are done."""

from __future__ import annotations

import time
from collections.abc import Callable

Clock = Callable[[], float]
"""Seconds since some moment."""
_SOONEST = 1.0
"""Nothing is said in the first second, s, nor of the last one: both are over before it is read."""
_MINUTE, _HOUR = 60.0, 3600.0
_ROUNDED = 5.0
"""Seconds from 10 up are told in steps of so many: nobody knows them better."""


class TimeLeft:
    """Says how long it will go on, from the moment when it was made."""

    def __init__(self, clock: Clock = time.monotonic) -> None:
        """Begin now."""
        self._clock, self._began = clock, clock()

    def said(self, done: int, of: int) -> str:
        """As in "about 40 s left"; empty where nobody can tell."""
        spent = self._clock() - self._began
        if spent < _SOONEST or not 0 < done < of:
            return ""
        left = spent * (of - done) / done
        return f"about {_told(left)} left" if left >= _SOONEST else ""


def _told(seconds: float) -> str:
    if seconds < 2.0 * _ROUNDED:
        return f"{seconds:.0f} s"
    if seconds < _MINUTE:
        return f"{_ROUNDED * round(seconds / _ROUNDED):.0f} s"
    return f"{seconds / _MINUTE:.0f} min" if seconds < _HOUR else f"{seconds / _HOUR:.1f} h"


def listed(*parts: str) -> str:
    """Those that say something, with commas."""
    return ", ".join(part for part in parts if part)
