"""`cadpanel fit` that is interrupted, killed or loses its terminal: it leaves nothing behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

PROGRAM = [sys.executable, "-m", "cadpanel.cli.main"]
# The program, which makes a file once the reference is read: what follows is the fit.
TELLS_WHEN_IT_FITS = """
import sys
from pathlib import Path
from cadpanel.brep.isolation.client import Interpreter

ask = Interpreter.ask


def told(self, request):
    answer = ask(self, request)
    Path({told!r}).touch()
    return answer


Interpreter.ask = told
from cadpanel.cli.main import main

sys.exit(main())
"""
GETS_GOING = 0.5  # s


def heed_every_signal() -> None:
    """As in a terminal: jobs in the background of a shell, and whatever nohup starts, are told to ignore some."""
    for one in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(one, signal.SIG_DFL)


@pytest.mark.parametrize("fitting", [False, True], ids=["while the kernel loads", "while it fits"])
@pytest.mark.parametrize(
    ("sent", "code", "said"),
    [(signal.SIGINT, 130, ["Interrupted."]), (signal.SIGTERM, 143, []), (signal.SIGHUP, 143, [])],
    ids=["interrupt", "kill", "closed terminal"],
)
def test_whoever_stops_it_finds_nothing_left(
    lip_step: Path,
    tmp_path: Path,
    tmp_path_factory: pytest.TempPathFactory,
    fitting: bool,
    sent: signal.Signals,
    code: int,
    said: list[str],
) -> None:
    told = tmp_path_factory.mktemp("told") / "it fits"
    program = [sys.executable, "-c", TELLS_WHEN_IT_FITS.format(told=str(told))] if fitting else PROGRAM
    with subprocess.Popen(
        [*program, "fit", str(lip_step), "--out", str(tmp_path / "out"), "--restarts", "1000"],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=heed_every_signal,
    ) as process:
        try:
            give_up = time.monotonic() + 60.0
            while not (told.exists() if fitting else list(tmp_path.glob(".cadpanel-*"))):
                assert time.monotonic() < give_up
                time.sleep(0.05)
            time.sleep(GETS_GOING)
            assert process.poll() is None
            os.kill(process.pid, sent)
            _, err = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == code
    assert err.splitlines()[-1:] == said
    assert list(tmp_path.iterdir()) == []
