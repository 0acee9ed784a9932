"""Memory that a process has let go of, given back to the system: a C library keeps what was in small pieces."""

from __future__ import annotations

import ctypes
import sys


def give_back() -> None:
    """Give back what nothing uses, where the C library can; it takes 10 ms, and as long again to get it anew."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform.startswith("linux") else None
    if trim is not None:
        trim(0)
