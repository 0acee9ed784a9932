"""`cadpanel fit` and `cadpanel run` that are interrupted, killed or lose their terminal: nothing half done is left."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from cadpanel.delivery.manifest import changed_files
from cadpanel.jobs.summary import SUMMARY, read_summary
from tests.jobs.jobs import job, reference
from tests.thorough import cases, thorough
from tests.waiting import until

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


NOTHING: list[str] = []
INTERRUPT = (signal.SIGINT, 130, ["Interrupted."])
KILL, HANG_UP = (signal.SIGTERM, 143, NOTHING), (signal.SIGHUP, 143, NOTHING)


@pytest.mark.parametrize(
    ("fitting", "sent", "code", "said"),
    [(False, *INTERRUPT), (True, *KILL), *cases([], [(False, *KILL), (False, *HANG_UP), (True, *HANG_UP)])],
    ids=[
        *("interrupted while the kernel loads", "killed while it fits"),
        *cases(
            [], ["killed while the kernel loads", "no terminal while the kernel loads", "no terminal while it fits"]
        ),
    ],
)
@thorough
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
    with started(lip_step, tmp_path, told if fitting else None) as process:
        os.kill(process.pid, sent)
        _, err = process.communicate(timeout=60)
    assert process.returncode == code
    lines = [line for line in err.splitlines() if not re.match(r"Fit |.*: at work for \d+ s(, |$)", line)]  # its rounds
    assert lines[-1:] == said
    assert list(tmp_path.iterdir()) == []


INTERRUPTED_IN_AN_EXTENSION = """
import ctypes, sys
from cadpanel.cli import main as program

def app(**_):
    ctypes.pythonapi.PyRun_String.restype = ctypes.py_object
    ctypes.pythonapi.PyRun_String(b"raise KeyboardInterrupt", 257, ctypes.py_object({}), ctypes.py_object({}))

program.app = app
sys.exit(program.main())
"""


@pytest.mark.skipif(sys.implementation.name != "cpython", reason="calls CPython's own library")
def test_an_interrupt_inside_of_an_extension_ends_with_the_same_code(tmp_path: Path) -> None:
    (tmp_path / "it.py").write_text(INTERRUPTED_IN_AN_EXTENSION, encoding="utf-8")
    answer = subprocess.run(
        [sys.executable, "-m", "it"], capture_output=True, text=True, timeout=60, cwd=tmp_path, check=False
    )
    assert (answer.returncode, answer.stderr) == (130, "Interrupted.\n")


@contextmanager
def started(lip_step: Path, tmp_path: Path, told: Path | None) -> Iterator[subprocess.Popen[str]]:
    """The program, which has been fitting for a while if it is to tell that it fits, or else loads the kernel."""
    program = PROGRAM if told is None else [sys.executable, "-c", TELLS_WHEN_IT_FITS.format(told=str(told))]
    with subprocess.Popen(
        [*program, "fit", str(lip_step), "--out", str(tmp_path / "out"), "--restarts", "1000"],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=heed_every_signal,
    ) as process:
        try:
            until(lambda: list(tmp_path.glob(".cadpanel-*")) if told is None else told.exists(), seconds=60.0)
            time.sleep(GETS_GOING)
            assert process.poll() is None
            yield process
        finally:
            process.kill()


def test_the_first_interrupt_while_it_fits_delivers_the_best_so_far(
    lip_step: Path, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    with started(lip_step, tmp_path, tmp_path_factory.mktemp("told") / "it fits") as process:
        time.sleep(1.0)
        os.kill(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 0, err
    assert "Written" in out
    assert (tmp_path / "out" / "report.json").is_file()


@thorough
def test_the_second_interrupt_stops_it_and_more_disturb_nothing(
    lip_step: Path, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    with started(lip_step, tmp_path, tmp_path_factory.mktemp("told") / "it fits") as process:
        for _ in range(4):
            time.sleep(0.02)
            os.kill(process.pid, signal.SIGINT)
        _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert err.splitlines()[-1:] == ["Interrupted."]
    assert list(tmp_path.iterdir()) == []


MANY = "\n".join(f"R{number} = {{thickness = {1 + 0.1 * number:g}}}" for number in range(8))


@contextmanager
def run_of_many(folder: Path, *more: str) -> Iterator[subprocess.Popen[str]]:
    """A job of many regions that runs as in a terminal."""
    reference(folder)
    job(folder, MANY)
    with subprocess.Popen(
        [*PROGRAM, "run", "job.toml", "--out", "out", "--cache", "cache", *more],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heed_every_signal,
        start_new_session=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


@thorough
@pytest.mark.parametrize(("workers", "times"), [(1, 4), (2, 1), (2, 4)])
def test_an_interrupt_of_a_whole_terminal_leaves_the_regions_that_are_done(
    tmp_path: Path, workers: int, times: int
) -> None:
    out = tmp_path / "out"
    with run_of_many(tmp_path, "--workers", str(workers)) as process:
        until(lambda: list(out.glob("R?")))
        for _ in range(times):
            os.killpg(process.pid, signal.SIGINT)  # as a terminal does
            time.sleep(0.02)
        _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert err.splitlines()[-1] == "Interrupted."
    assert "Traceback" not in err
    rows = {row.region: row.state for row in read_summary(out / SUMMARY).rows}
    whole = {path.name for path in out.iterdir() if path.is_dir()}
    assert whole == {name for name, state in rows.items() if state == "made"}
    assert {state for name, state in rows.items() if name not in whole} == {"waiting"}
    assert not [name for name in whole if changed_files(out / name)]


def begun_by(number: int) -> list[int]:
    """The processes that one has begun."""
    return [int(word) for path in Path(f"/proc/{number}/task").glob("*/children") for word in path.read_text().split()]


linux = pytest.mark.skipif(sys.platform != "linux", reason="sees processes from outside as Linux tells of them")


@linux
@thorough
def test_an_interrupt_while_workers_start_is_heeded(tmp_path: Path) -> None:
    with run_of_many(tmp_path, "--workers", "2") as process:
        until(lambda: len(begun_by(process.pid)) > 1)  # one watches over shared memory
        begun = begun_by(process.pid)
        os.killpg(process.pid, signal.SIGINT)
        _, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (130, "Interrupted.\n")
    assert {row.state for row in read_summary(tmp_path / "out" / SUMMARY).rows} == {"waiting"}
    until(lambda: not [number for number in begun if Path(f"/proc/{number}").exists()])


@linux
@thorough
@pytest.mark.parametrize(("sent", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_run_is_ended_while_the_kernel_loads(tmp_path: Path, sent: signal.Signals, code: int) -> None:
    with run_of_many(tmp_path) as process:
        until(lambda: "OCP" in Path(f"/proc/{process.pid}/maps").read_text())
        os.kill(process.pid, sent)
        _, err = process.communicate(timeout=60)
    assert process.returncode == code, err
    assert err.splitlines()[-1:] == (["Interrupted."] if code == 130 else [])
    assert {row.state for row in read_summary(tmp_path / "out" / SUMMARY).rows} == {"waiting"}
