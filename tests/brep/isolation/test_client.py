"""The second interpreter: what happens in it stays there, and whoever asks hears one sentence, in time."""

import os
import pickle
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep.isolation import client, requests, time_limit
from cadpanel.brep.isolation.interpreter import interpreter
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.survey import survey
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.drawn import curve
from tests.model_files import strip_faces, write_shape
from tests.reference_shapes import Lip
from tests.thorough import thorough

pytestmark = pytest.mark.usefixtures("forked_readers")

PIPE = 65_536  # bytes that a pipe holds


@pytest.fixture
def model(tmp_path):
    return write_shape(tmp_path / "model.brep", strip_faces(Lip())[0])


@pytest.fixture
def lines(tmp_path):
    return write_shape(tmp_path / "lines.brep", curve(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])))


@pytest.fixture
def other_server(monkeypatch):
    """Run other text instead of the second interpreter."""

    def run(text):
        client.stop_reader()
        monkeypatch.setattr(client, "interpreter", lambda _: [sys.executable, "-c", text])

    yield run
    client.stop_reader()
    monkeypatch.undo()


@pytest.fixture
def own_process(monkeypatch):
    """Start the second interpreter as the program does."""
    client.stop_reader()
    monkeypatch.setattr(client, "interpreter", interpreter)
    yield
    client.stop_reader()


def test_crash_of_the_reader_is_one_sentence_and_the_next_file_is_read(model, monkeypatch):
    process = client.READER.start()
    process.kill()
    process.wait()
    monkeypatch.setattr(client.READER, "_started", lambda: process)
    with pytest.raises(
        ReferenceFileError, match=r"'model.brep' makes the CAD kernel crash: it is damaged; repair"
    ) as told:
        survey(model)
    assert isinstance(told.value.__cause__, client.Died)
    monkeypatch.undo()
    assert survey(model).faces


def test_who_asks_while_an_error_is_seen_to_keeps_the_reader(model):
    survey(model)
    process = client.READER.start().pid
    try:
        raise ValueError
    except ValueError:
        survey(model)
    assert client.READER.start().pid == process


@pytest.mark.parametrize("broken_off_by", [KeyboardInterrupt, SystemExit, MemoryError])
def test_a_reader_whose_answer_nobody_waits_for_is_ended(model, monkeypatch, broken_off_by):
    def breaks_off(_):
        raise broken_off_by

    process = client.READER.start()
    monkeypatch.setattr(client.READER, "_frame", breaks_off)
    with pytest.raises(broken_off_by):
        survey(model)
    assert process.poll() is not None
    monkeypatch.undo()


def test_threads_that_start_it_at_once_start_one(monkeypatch):
    one, begun, started = client.Interpreter(), client.Interpreter._begun, []

    def slowly(interpreter):
        time.sleep(0.1)
        started.append(begun(interpreter))
        return started[-1]

    monkeypatch.setattr(client.Interpreter, "_begun", slowly)
    with ThreadPoolExecutor(max_workers=3) as threads:
        found = list(threads.map(lambda _: one.start(), range(3)))
    one.stop()
    assert found == started * 3


def test_reader_that_does_not_end_is_stopped(model, monkeypatch):
    monkeypatch.setattr(requests, "SECONDS_TO_READ", 0.2)
    monkeypatch.setattr(client, "framed", lambda _: b"")
    with pytest.raises(ReferenceFileError, match=r"keeps the CAD kernel busy for more than 0 s: it is damaged or"):
        survey(model)
    monkeypatch.undo()
    assert survey(model).faces


def test_reader_that_ends_with_an_exception_is_quoted(model, other_server):
    other_server("raise MemoryError('no room')")
    with pytest.raises(ReferenceFileError, match=r"'model.brep' makes reading fail \(MemoryError: no room\): it is"):
        survey(model)


SLOW = """
import sys, time
out = sys.stdout.buffer
for _ in range({stages}):
    out.write(bytes(8)); out.flush()
time.sleep(60)
"""


@pytest.mark.parametrize(
    ("stages", "sentence"),
    [
        (0, r"'model.brep' keeps the CAD kernel busy for more than 1 s: it is damaged or far too large"),
        (1, r"'lines.brep' keeps the CAD kernel busy for more than 1 s: it is damaged or far too large"),
        (2, r"'model.brep' keeps the CAD kernel busy for more than 1 s: repair it where it was modelled"),
    ],
)
def test_each_file_and_the_work_have_a_time_of_their_own(model, lines, other_server, monkeypatch, stages, sentence):
    monkeypatch.setattr(requests, "SECONDS_TO_READ", 1.0)
    monkeypatch.setattr(requests, "SECONDS_TO_WORK", 1.0)
    other_server(SLOW.format(stages=stages))
    with pytest.raises(ReferenceFileError, match=sentence):
        read_raw_panels(model, ReferenceSettings(unit="mm", network=lines))


def test_one_that_is_killed_while_it_is_being_started_ends_at_once(monkeypatch):
    started, one = subprocess.Popen, client.Interpreter()

    def killed(words, **how):
        one.kill()
        return started(words, **how)

    monkeypatch.setattr(subprocess, "Popen", killed)
    assert one.start().wait(timeout=10.0) != 0
    one.stop()
    with pytest.raises(RuntimeError):
        one.start()


def test_a_file_beside_the_reference_is_a_stage_of_its_own_unless_it_is_the_reference(model, lines):
    def files(work, **how):
        return [stage.file for stage in requests.work_request(work, model, ReferenceSettings(**how)).stages]

    assert files("panels", network=lines) == ["model.brep", "lines.brep", "model.brep"]
    assert files("panels", spine=lines, stations=(1.0,)) == ["model.brep", "lines.brep", "model.brep"]
    assert files("panels", network=model) == ["model.brep", "model.brep"]
    assert files("survey", network=lines) == ["model.brep", "model.brep"]


def test_a_larger_file_has_more_time_and_one_that_is_not_there_is_refused_by_its_reader(tmp_path):
    with (tmp_path / "large.brep").open("wb") as file:
        file.truncate(100_000_000)
    assert requests.seconds_to_read(tmp_path / "large.brep") == pytest.approx(1120.0)
    assert requests.seconds_to_read(tmp_path / "none.brep") == requests.SECONDS_TO_READ
    with pytest.raises(ReferenceFileError, match=r"none.brep' does not exist"):
        survey(tmp_path / "none.brep")


@pytest.mark.usefixtures("own_process")
def test_reader_runs_nothing_that_lies_in_the_current_folder(tmp_path, model, monkeypatch):
    for name in ("random", "copy", "numbers", "token", "numpy", "cadpanel"):
        (tmp_path / f"{name}.py").write_text(f"open('{name} was run', 'w')\nraise SystemExit\n")
    monkeypatch.chdir(tmp_path)
    assert survey(model).faces
    assert not list(tmp_path.glob("* was run"))


@pytest.mark.skipif(not Path("/proc/self/limits").exists(), reason="needs the limits of a process as a file")
@pytest.mark.usefixtures("own_process")
def test_reader_that_nobody_waits_for_ends_itself(model):
    """Its time on the processor is limited by the system, which also counts when the first interpreter is gone."""
    request = requests.work_request("survey", model, ReferenceSettings())
    short = tuple(replace(stage, seconds=100.0) for stage in request.stages)
    client.READER.ask(replace(request, stages=short))
    limits = Path(f"/proc/{client.READER.start().pid}/limits").read_text()
    (line,) = [line for line in limits.splitlines() if line.startswith("Max cpu time")]
    assert 0 < int(line.split()[3]) <= (os.cpu_count() or 1) * 2.0 * 100.0 + 60


def test_the_system_that_counts_no_time_leaves_it_to_a_watchdog():
    """Which ends the interpreter even where the kernel never gives Python a turn, as in one long sum."""
    text = (
        "import sys; sys.modules['resource'] = None\n"
        "from cadpanel.brep.isolation import time_limit as t\n"
        "assert not t.COUNTED_BY_SYSTEM\n"
        "t.limit_time(60.0); t.stop_limit(); t.limit_time(0.5); pow(3, 10**9)\n"
    )
    process = subprocess.run([sys.executable, "-c", text], capture_output=True, timeout=50, check=False)
    assert process.returncode == 1
    assert b"Timeout" in process.stderr
    assert time_limit.COUNTED_BY_SYSTEM or os.name == "nt"


@thorough
def test_frames_longer_than_a_pipe_holds_go_both_ways(model):
    # The name of the file stands in every note.
    path = write_shape(model.with_name(f"{'many' * 50}.brep"), compound_of(strip_faces(Lip()) * 100))
    how = ReferenceSettings(faces=("1-300", *("1",) * 50_000))
    assert len(pickle.dumps(how)) > PIPE
    found = survey(path, how)
    assert len(found.notes) == 298  # each of the other faces lies on one of the first three, and it has no unit
    assert len(pickle.dumps(found)) > PIPE
