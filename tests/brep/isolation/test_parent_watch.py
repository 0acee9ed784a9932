"""An interpreter that works ends with the one that asked it, whatever it is busy with."""

import os
import subprocess
import sys
import time

import pytest

from cadpanel.brep.isolation.parent_watch import WATCHES, ends_with_whoever_asked

pytestmark = pytest.mark.skipif(not WATCHES, reason="this system does not tell when a pipe is closed")

# One long multiplication, in which Python has no turn.
BUSY = """
import sys
from cadpanel.brep.isolation.parent_watch import ends_with_whoever_asked
sys.stdin.buffer.read(1)
with ends_with_whoever_asked(0):
    sys.stdout.write("at work"); sys.stdout.flush()
    pow(3, 10**9)
"""
WITHIN = 2.0  # s


def busy():
    return subprocess.Popen([sys.executable, "-c", BUSY], stdin=subprocess.PIPE, stdout=subprocess.PIPE)


def test_it_ends_when_nobody_is_left_to_answer():
    process = busy()
    process.stdin.write(b"x")
    process.stdin.flush()
    assert process.stdout.read(7) == b"at work"
    began = time.monotonic()
    process.stdin.close()
    process.wait(timeout=60.0)
    assert time.monotonic() - began <= WITHIN


def test_it_does_not_begin_where_nobody_is_left():
    process = busy()
    process.stdin.write(b"x")
    process.stdin.close()
    assert process.wait(timeout=60.0) != 0


def test_it_goes_on_while_somebody_waits_and_reads_what_comes_afterwards():
    reading, writing = os.pipe()
    with ends_with_whoever_asked(reading):
        time.sleep(0.05)
    os.write(writing, b"next")
    assert os.read(reading, 4) == b"next"
    os.close(reading)
    os.close(writing)
