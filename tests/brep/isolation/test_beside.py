"""A copy of a process works beside it, ends with it, and whatever happens to it is silence."""

import os
import signal
import subprocess
import sys

import pytest

from cadpanel.brep.isolation.beside import POSSIBLE, Lost, beside
from tests.brep.isolation.running import ends, runs

pytestmark = pytest.mark.skipif(not POSSIBLE, reason="this system copies no processes")

# A process that tells of its copy, and waits; the copy works in one long multiplication, in which Python has no turn.
KILLED = """
import os, time
from cadpanel.brep.isolation.beside import beside
def work(channel):
    channel.say(os.getpid())
    pow(3, 10**9)
with beside(work) as channel:
    print(channel.hear(), flush=True)
    time.sleep(600.0)
"""


def echo(channel):
    while True:
        channel.say(("heard", channel.hear()))


def test_what_one_says_the_other_hears_in_order_however_long_it_is():
    with beside(echo) as channel:
        for message in ("a", b"b" * 1_000_000, None):
            channel.say(message)
            assert channel.hear() == ("heard", message)


def test_a_copy_knows_what_was_loaded_and_changes_nothing_here():
    known = [1]

    def work(channel):
        known.append(2)
        channel.say(known)

    with beside(work) as channel:
        assert channel.hear() == [1, 2]
    assert known == [1]


@pytest.mark.parametrize(
    "work",
    [
        lambda _: None,
        lambda _: 1 / 0,
        lambda _: sys.exit(0),
        lambda _: os.kill(os.getpid(), signal.SIGSEGV),
        lambda channel: channel.say(lambda: "cannot be pickled"),
    ],
)
def test_one_that_fails_crashes_or_says_nothing_is_lost(work):
    with beside(work) as channel, pytest.raises(Lost):
        channel.hear()


def test_who_speaks_to_one_that_is_gone_is_told():
    with beside(lambda _: None) as channel, pytest.raises(Lost):
        channel.say(b"x" * 10_000_000)


def test_a_copy_that_is_busy_ends_where_nobody_waits_any_more():
    def work(channel):
        channel.say(os.getpid())
        pow(3, 10**9)

    with beside(work) as channel:
        process = channel.hear()
        assert isinstance(process, int)
        assert runs(process)
    assert ends(process)


def test_a_copy_ends_with_the_process_that_was_killed():
    parent = subprocess.Popen([sys.executable, "-c", KILLED], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    process = int(parent.stdout.readline())
    assert runs(process)
    parent.kill()
    parent.wait()
    assert ends(process)


def test_a_copy_holds_no_pipe_open_that_others_wait_to_be_closed():
    reading, writing = os.pipe()

    def work(channel):
        channel.say("begun")
        channel.hear()

    with beside(work) as channel:
        assert channel.hear() == "begun"
        os.close(writing)
        assert os.read(reading, 1) == b""
    os.close(reading)
