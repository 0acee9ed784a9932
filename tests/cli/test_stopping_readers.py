"""Ctrl-C in a terminal, which tells all processes of it: it ends a program that reads, and what reads for it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from cadpanel.brep.isolation.beside import POSSIBLE
from tests.brep.isolation.running import ends
from tests.thorough import thorough
from tests.waiting import until

# The program, whose second interpreter runs another module.
PROGRAM = """
import sys
sys.path.insert(0, {folder!r})
from cadpanel.brep.isolation import client
from cadpanel.brep.isolation.interpreter import interpreter
client.interpreter = lambda _: interpreter("reader")
from cadpanel.cli.main import main
sys.exit(main())
"""
# Its reader, which tells who it is and reads for ever in one long multiplication, in which Python has no turn.
ENDLESS = """
import os
from pathlib import Path
from cadpanel.brep import server
from cadpanel.brep.isolation.beside import beside

def endless(request, go_on):
    def work(channel):
        channel.say(os.getpid())
        pow(3, 10**9)

    with beside(work) as channel:
        told = Path({told!r})
        told.with_suffix(".new").write_text(f"{{os.getpid()}} {{channel.hear()}}")
        told.with_suffix(".new").rename(told)
        pow(3, 10**9)

server.WORKS.update(panels=endless, survey=endless)
main = server.main
"""
# A reader that a terminal tells of Ctrl-C while it works.
WORKS_ON = """
import os, signal
from cadpanel.brep import server

cut = server.panels

def cut_through(request, go_on):
    found = cut(request, go_on)
    os.kill(os.getpid(), signal.SIGINT)
    return found

server.WORKS.update(panels=cut_through)
main = server.main
"""


@thorough
@pytest.mark.skipif(not POSSIBLE, reason="this system copies no processes")
@pytest.mark.parametrize(
    "command", [["fit", "{file}", "--out", "{out}"], ["inspect", "{file}"]], ids=["fit", "inspect"]
)
def test_an_interrupt_of_a_whole_terminal_while_a_file_is_read_ends_everything(
    lip_step: Path, tmp_path: Path, command: list[str]
) -> None:
    told, out = tmp_path / "told.txt", tmp_path / "out"
    (tmp_path / "reader.py").write_text(ENDLESS.format(told=str(told)))
    words = [word.format(file=lip_step, out=out) for word in command]
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM.format(folder=str(tmp_path)), *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        start_new_session=True,
    ) as process:
        try:
            until(told.exists)
            readers = [int(number) for number in told.read_text().split()]
            os.killpg(process.pid, signal.SIGINT)
            _, err = process.communicate(timeout=30)
        finally:
            process.kill()
    assert process.returncode == 130, err
    assert err.splitlines()[-1] == "Interrupted."
    assert len(readers) == 2
    assert all(ends(reader) for reader in readers)
    assert not out.exists()
    assert not list(tmp_path.glob(".cadpanel-*"))


@thorough
def test_an_interrupt_that_a_reader_hears_too_leaves_it_reading(lip_step: Path, tmp_path: Path) -> None:
    """As where the first one only ends a search early, and the program goes on reading."""
    (tmp_path / "reader.py").write_text(WORKS_ON)
    answer = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(folder=str(tmp_path)), "fit", str(lip_step), "--out", tmp_path / "out"],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert answer.returncode == 0, answer.stderr
