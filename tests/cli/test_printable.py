"""Names are data: nothing that is printed steers a terminal, and no reader that goes away ends a run in a traceback."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cadpanel.cli import main as program
from cadpanel.cli.printable import complain, printable
from cadpanel.cli.tables import console
from tests.cli.conftest import Run

STEERING = "\x1b]0;owned\x07 \x9b31m \x7f \u202e"


def test_what_steers_a_terminal_is_shown_by_its_number_and_all_else_stays() -> None:
    assert printable(STEERING) == r"\x1b]0;owned\x07 \x9b31m \x7f \u202e"
    for text in ("Größe 3 mm, 日本 😀", "two\nlines\tand a tab", "'quotes' <b> \\"):
        assert printable(text) == text


def test_neither_tables_nor_complaints_steer_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    console().print(f"Panel {STEERING}")
    complain(f"Panel {STEERING}\n")
    for said in capsys.readouterr():
        assert r"\x1b]0;owned" in said
        assert not {*"\x1b\x07\x9b\x7f\u202e"} & {*said}


def test_a_file_under_such_a_name_is_refused_in_plain_signs(run: Run, tmp_path: Path) -> None:
    answer = run("inspect", tmp_path / "\x1b[31mred.step")
    assert answer.code == 2
    assert r"\x1b[31mred.step" in answer.err
    assert "\x1b" not in answer.err


@pytest.mark.parametrize("encoding", ["ascii", "latin-1"])
def test_a_terminal_without_the_signs_gets_their_numbers(encoding: str) -> None:
    text = "from cadpanel.cli.printable import *; forgive_encodings(); PrintableConsole(80).print('größe 日本')"
    environment = os.environ | {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
    answer = subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, check=False)
    assert (answer.returncode, answer.stderr) == (0, b"")
    assert b"\\u65e5\\u672c" in answer.stdout


def test_a_reader_that_has_gone_away_is_no_failure() -> None:
    text = "import sys; from cadpanel.cli.main import main\nsys.stdin.readline(); sys.exit(main(['features']))"
    with subprocess.Popen(
        [sys.executable, "-c", text], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.close()
        said = _finish(process)
    assert (process.returncode, said) == (0, b"")


def _finish(process: subprocess.Popen[bytes]) -> bytes:
    assert process.stdin is not None
    assert process.stderr is not None
    process.stdin.write(b"go\n")
    process.stdin.close()
    said = process.stderr.read()
    process.wait(timeout=60)
    return said


def test_what_nobody_foresaw_is_one_sentence_and_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_arguments: object, **_options: object) -> None:
        raise ZeroDivisionError("nobody\nthought of it")

    monkeypatch.setattr(program, "app", fail)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert program.main(["features"]) == 3
    said = capsys.readouterr().err
    (file,) = tmp_path.glob("cadpanel-error-*.txt")
    assert said.count("\n") == 1
    assert "(ZeroDivisionError: nobody thought of it): the details are in '" in said
    assert str(file) in said
    assert "Traceback" in file.read_text(encoding="utf-8")


@pytest.mark.skipif(os.name == "nt", reason="a shell of POSIX closes them")
def test_a_program_whose_streams_are_closed_does_its_work(lip_step: Path, tmp_path: Path) -> None:
    words = f'exec "{sys.executable}" -m cadpanel.cli.main inspect "{lip_step}" <&- >&- 2>&-'
    assert subprocess.run(["sh", "-c", words], cwd=tmp_path, timeout=60, check=False).returncode == 0
    assert list(tmp_path.iterdir()) == []
