from __future__ import annotations

import signal
import subprocess
import sys
import threading

import pytest

from cadpanel.jobs.engine.deaf import dask_setup, deaf

IS_DEAF = "import signal; print(signal.getsignal(signal.SIGINT) is signal.SIG_IGN)"


def _is_deaf() -> bool:
    return signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def _a_child_is_deaf() -> bool:
    answer = subprocess.run([sys.executable, "-c", IS_DEAF], capture_output=True, text=True, timeout=60, check=True)
    return answer.stdout == "True\n"


@pytest.mark.usefixtures("heeding")
def test_what_begins_in_the_block_is_deaf_and_nothing_else() -> None:
    assert not _a_child_is_deaf()
    with deaf():
        assert _is_deaf()
        assert _a_child_is_deaf()
    assert not _is_deaf()


@pytest.mark.usefixtures("heeding")
def test_a_thread_that_may_not_say_how_signals_are_heeded_changes_nothing() -> None:
    found: list[bool] = []

    def look() -> None:
        with deaf():
            found.append(_is_deaf())

    thread = threading.Thread(target=look)
    thread.start()
    thread.join()
    assert found == [False]


@pytest.mark.usefixtures("heeding")
def test_a_worker_is_deaf_from_its_start() -> None:
    dask_setup(None)
    assert _is_deaf()
