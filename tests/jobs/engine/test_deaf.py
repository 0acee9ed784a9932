from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import pytest

from cadpanel.jobs.engine.deaf import begin_deaf, dask_setup

SURVIVES = "import signal; signal.raise_signal(signal.SIGINT); print('still here')"
masks = pytest.mark.skipif(sys.platform == "win32", reason="a system without masks of signals")


def begun_deaf(begin: Callable[[], Any]) -> Future[Any]:
    begun = Future[Any]()
    begin_deaf(begun, begin)
    return begun


def survives() -> bool:
    """Whether a process that begins here goes on after Ctrl-C."""
    answer = subprocess.run([sys.executable, "-c", SURVIVES], capture_output=True, text=True, timeout=60, check=False)
    return answer.stdout == "still here\n"


@masks
@pytest.mark.usefixtures("heeding")
def test_processes_that_begin_so_are_deaf_and_those_that_begin_here_are_not() -> None:
    assert begun_deaf(survives).result(60)
    assert not survives()


@masks
@pytest.mark.usefixtures("heeding")
def test_threads_that_begin_so_are_deaf_and_whoever_waits_hears() -> None:
    def mask() -> set[int]:
        found: list[set[int]] = []
        thread = threading.Thread(target=lambda: found.append(set(signal.pthread_sigmask(signal.SIG_BLOCK, ()))))
        thread.start()
        thread.join()
        return found[0]

    assert signal.SIGINT in begun_deaf(mask).result(60)
    assert signal.SIGINT not in mask()
    goes_on = threading.Event()
    begun = begun_deaf(lambda: goes_on.wait(60))
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    goes_on.set()
    assert begun.result(60)


@masks
def test_helpers_of_the_language_lift_no_mask() -> None:
    """What watches over shared memory begins with the first process, and would lift it in the thread that does that."""
    ask = "import multiprocessing.resource_tracker as it, signal, concurrent.futures\n"
    ask += "from cadpanel.jobs.engine.deaf import begin_deaf\n"
    ask += "def mask(): it.ensure_running(); return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ())\n"
    ask += "begun = concurrent.futures.Future()\nbegin_deaf(begun, mask)\nprint(begun.result())"
    answer = subprocess.run([sys.executable, "-c", ask], capture_output=True, text=True, timeout=60, check=True)
    assert answer.stdout == "True\n"


def test_what_is_not_wanted_any_more_does_not_begin() -> None:
    begun, began = Future[None](), threading.Event()
    assert begun.cancel()
    others = set(threading.enumerate())
    begin_deaf(begun, began.set)
    for thread in set(threading.enumerate()) - others:
        thread.join(60)
    assert not began.is_set()


@pytest.mark.usefixtures("heeding")
def test_what_it_raises_reaches_whoever_waits() -> None:
    with pytest.raises(ZeroDivisionError):
        begun_deaf(lambda: 1 // 0).result(60)


@pytest.mark.usefixtures("heeding")
def test_a_worker_is_deaf_from_its_start() -> None:
    dask_setup(None)
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
