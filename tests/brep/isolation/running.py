"""Whether a process runs, and whether it ends."""

from __future__ import annotations

import os
import time
from pathlib import Path

WITHIN = 10.0  # s


def runs(process: int) -> bool:
    """Whether it does; one that has ended and that nobody has seen off does not."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"


def ends(process: int) -> bool:
    """Whether it ends before long."""
    until = time.monotonic() + WITHIN
    while runs(process) and time.monotonic() < until:
        time.sleep(0.01)
    return not runs(process)
