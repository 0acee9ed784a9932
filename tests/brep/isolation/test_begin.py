"""An interpreter that still loads its work ends with the one that started it."""

import os
import signal
import subprocess
import sys

import pytest

from cadpanel.brep.isolation.beside import POSSIBLE
from cadpanel.brep.isolation.interpreter import interpreter
from cadpanel.brep.isolation.parent_watch import WATCHES


def started(folder, monkeypatch, text):
    (folder / "work.py").write_text(text)
    monkeypatch.setattr(sys, "path", [str(folder), *sys.path])
    pipe = subprocess.PIPE
    return subprocess.Popen(interpreter("work"), stdin=pipe, stdout=pipe, stderr=pipe, bufsize=0)


def test_what_is_loaded_does_its_work_whatever_was_asked_meanwhile(tmp_path, monkeypatch):
    text = "import time; time.sleep(0.2)\ndef main(): print(input().upper())"
    with started(tmp_path, monkeypatch, text) as process:
        assert process.communicate(b"done\n") == (b"DONE\n", b"")


@pytest.mark.skipif(os.name == "nt", reason="a signal is sent in another way")
@pytest.mark.parametrize("where", ["loads", "works"])
def test_ctrl_c_is_for_whoever_asked(tmp_path, monkeypatch, where):
    interrupted = "os.kill(os.getpid(), signal.SIGINT)"
    loads, works = (interrupted, "pass") if where == "loads" else ("pass", interrupted)
    text = f"import os, signal; {loads}\ndef main(): {works}; print(input().upper())"
    with started(tmp_path, monkeypatch, text) as process:
        assert process.communicate(b"done\n") == (b"DONE\n", b"")


COPIED = """
import os, signal
from cadpanel.brep.isolation.beside import beside

def work(channel):
    os.kill(os.getpid(), signal.SIGINT)
    channel.say("DONE")

def main():
    with beside(work) as channel:
        print(channel.hear())
"""


@pytest.mark.skipif(not POSSIBLE, reason="this system copies no processes")
def test_ctrl_c_is_not_for_a_copy_either(tmp_path, monkeypatch):
    with started(tmp_path, monkeypatch, COPIED) as process:
        assert process.communicate() == (b"DONE\n", b"")


@pytest.mark.skipif(not WATCHES, reason="this system does not tell when a pipe is closed")
def test_loading_ends_when_nobody_is_left_to_answer(tmp_path, monkeypatch):
    text = "import sys; sys.stderr.write('loads'); sys.stderr.flush(); pow(3, 10**9)"
    with started(tmp_path, monkeypatch, text) as process:
        process.stdin.write(b"a first request")
        assert process.stderr.read(5) == b"loads"
        process.stdout.close()  # as the system does with a process that is killed
        assert process.wait(timeout=60.0) == -signal.SIGIO
