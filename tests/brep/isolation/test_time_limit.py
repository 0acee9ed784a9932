"""The time that an interpreter may work is counted anew by each call, as far as the system lets it go."""

import subprocess
import sys

import pytest

from cadpanel.brep.isolation.time_limit import COUNTED_BY_SYSTEM

LIMITED = """
import resource
from cadpanel.brep.isolation.time_limit import limit_time
resource.setrlimit(resource.RLIMIT_CPU, ({hard}, {hard}))
for seconds in (10.0, 1000.0, 1e9):
    limit_time(seconds)
    print(*resource.getrlimit(resource.RLIMIT_CPU))
"""
HARD = 1_000_000  # s


@pytest.mark.skipif(not COUNTED_BY_SYSTEM, reason="this system counts no time")
def test_a_later_limit_takes_the_place_of_a_shorter_one_up_to_what_the_system_lets_it_have():
    """As `ulimit -t` says."""
    text = LIMITED.format(hard=HARD)
    answer = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=60, check=True)
    (first, _), (second, _), last = [[int(word) for word in line.split()] for line in answer.stdout.splitlines()]
    assert 10 <= first < second < HARD
    assert last == [HARD, HARD]
