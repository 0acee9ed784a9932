from __future__ import annotations

import mmap
import sys
from pathlib import Path

import numpy as np
import pytest

from cadpanel.memory import give_back

STATUS = Path("/proc/self/statm")


@pytest.mark.skipif(not STATUS.exists(), reason="needs the memory of a process as a file")
def test_what_nothing_uses_goes_back_to_the_system() -> None:
    def held() -> int:
        return int(STATUS.read_text().split()[1]) * mmap.PAGESIZE

    before = held()
    kept = [np.ones(2000) for _ in range(20_000)]  # 320 MB, each too small for pages of its own
    between = kept[::100]
    most = held()
    assert most - before > 200e6
    del kept
    give_back()
    assert len(between) == 200
    assert most - held() > 0.7 * (most - before)


def test_a_system_whose_library_cannot_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    give_back()
