"""A copy of the second interpreter does what that one does, by itself, and ends with whoever asked for it."""

from __future__ import annotations

import errno
import fcntl
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from cadpanel.brep.isolation import client, copies
from cadpanel.brep.isolation.copies import COPYABLE, Copy
from cadpanel.brep.isolation.requests import Request, Stage
from cadpanel.errors import ReferenceFileError
from tests.brep.isolation.running import ends, runs

pytestmark = [
    pytest.mark.skipif(not COPYABLE, reason="this system copies no processes"),
    pytest.mark.usefixtures("forked_readers"),
]
HERE = Path(__file__).parent
SELECTABLE = 1024  # handles that fit in what `select` is told

# A process that has a copy made, lets it work for long, and is killed.
KILLED = """
import threading, time
from pathlib import Path
from cadpanel.brep.isolation import client
from cadpanel.brep.isolation.requests import Request, Stage
copied = client.CopiedInterpreter(client.READER)
print(copied.start().pid, flush=True)
here = Path.cwd()
stage = Stage(file="a", doing="reading", seconds=600.0)
request = Request(work="open", folder=here, path=here / "endless", argument=None, stages=(stage,))
threading.Thread(target=copied.ask, args=(request,), daemon=True).start()
time.sleep(600.0)
"""


def closing() -> Request:
    """The least that can be asked for."""
    stage = Stage(file="nothing", doing="closing", seconds=60.0)
    return Request(work="close", folder=HERE, path=HERE, argument=None, stages=(stage,))


@pytest.fixture
def copied():
    one = client.CopiedInterpreter(client.READER)
    yield one
    one.stop()


def copy_of(interpreter: client.Interpreter) -> Copy:
    """Its process, which is a copy."""
    process = interpreter.start()
    assert isinstance(process, Copy)
    return process


def test_a_copy_answers_and_so_does_the_one_that_was_copied(copied):
    process = copy_of(copied).pid
    for _ in range(2):
        assert copied.ask(closing()) is None
        assert client.READER.ask(closing()) is None
    assert copy_of(copied).pid == process


def test_a_copy_that_is_killed_crashes_and_the_next_request_has_another_one(copied):
    first = copy_of(copied)
    os.kill(first.pid, signal.SIGKILL)
    assert first.wait(10.0) < 0
    assert first.poll() is not None
    first.kill()  # nobody
    assert copied.ask(closing()) is None
    assert copy_of(copied).pid != first.pid


def test_a_copy_that_dies_over_a_request_is_one_sentence(copied, monkeypatch):
    first = copy_of(copied)
    os.kill(first.pid, signal.SIGKILL)
    first.wait(10.0)
    monkeypatch.setattr(copied, "_started", lambda: first)
    with pytest.raises(ReferenceFileError, match=r"'nothing' makes the CAD kernel crash"):
        copied.ask(closing())


def test_a_copy_that_is_stopped_ends_and_is_seen_off_by_the_next_request(copied):
    process = copy_of(copied).pid
    assert runs(process)
    copied.stop()
    assert ends(process)
    client.READER.ask(closing())
    assert not Path(f"/proc/{process}").exists()


def test_the_one_that_was_copied_may_end_before(copied):
    process = copy_of(copied).pid
    client.READER.stop()
    assert copied.ask(closing()) is None
    assert copy_of(copied).pid == process


def test_one_that_was_killed_for_good_begins_no_copy(copied):
    copied.kill()
    with pytest.raises(RuntimeError):
        copied.start()


def test_what_cannot_be_copied_begins_as_any_other_does(copied, monkeypatch):
    monkeypatch.setattr(client, "COPYABLE", False)
    assert isinstance(copied.start(), subprocess.Popen)
    assert copied.ask(closing()) is None


def test_where_no_copy_can_be_made_one_is_started(copied, monkeypatch):
    killed = client.Interpreter()
    killed.kill()
    monkeypatch.setattr(copied, "_original", killed)
    assert isinstance(copied.start(), subprocess.Popen)


def no_handle(_):
    raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS))


def test_where_the_system_does_not_tell_of_its_end_one_is_started_without_a_word(copied, monkeypatch):
    unheard: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", unheard.append)
    monkeypatch.setattr(os, "pidfd_open", no_handle)
    assert isinstance(copied.start(), subprocess.Popen)
    assert not copies._tells_of_an_end()
    assert unheard == []


def test_a_copy_is_waited_for_by_any_handle():
    """Also by one beyond those that `select` takes, as a program with many open files has."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (before[1], before[1]))
    try:
        handle = fcntl.fcntl(low := os.pidfd_open(os.getpid()), fcntl.F_DUPFD_CLOEXEC, SELECTABLE)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)
    os.close(low)
    answers, requests = os.pipe()
    one = Copy(os.getpid(), handle, requests, answers)
    assert handle >= SELECTABLE
    assert one.poll() is None
    with pytest.raises(subprocess.TimeoutExpired):
        one.wait(0.01)
    one.stdin.close()
    one.stdout.close()


def test_no_pipe_is_left_open(copied):
    copied.start()
    copied.stop()
    client.READER.ask(closing())
    before = len(list(Path("/proc/self/fd").iterdir()))
    for _ in range(3):
        copied.start()
        copied.stop()
    assert len(list(Path("/proc/self/fd").iterdir())) == before


def test_a_copy_that_works_ends_with_the_process_that_asked(tmp_path):
    os.mkfifo(tmp_path / "endless")  # nobody writes to it
    asking = subprocess.Popen([sys.executable, "-c", KILLED], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert asking.stdout is not None
    process = int(asking.stdout.readline())
    time.sleep(0.5)  # until it works
    assert runs(process)
    asking.kill()
    asking.wait()
    assert ends(process)
