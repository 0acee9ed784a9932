"""The program answers in one sentence and with an exit code, never with a traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import pytest
import typer

from cadpanel.cli import main as program
from cadpanel.errors import PanelError


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """Run the program with one command, `work`, that does what it is given."""

    def run(work: Callable[[], None], *arguments: str) -> int:
        app = typer.Typer(pretty_exceptions_enable=False)
        app.callback()(lambda: None)
        app.command("work")(work)
        monkeypatch.setattr(program, "app", app)
        return program.main(["work", *arguments])

    return run


def test_a_command_that_ends_well_exits_with_0(run: Callable[..., int]) -> None:
    assert run(lambda: None) == 0


def test_the_program_says_that_its_process_is_its_own(run: Callable[..., int], monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr(program, "own_process", lambda: said.append("own"))
    run(lambda: said.append("work"))
    assert said == ["own", "work"]


def test_a_refusal_is_one_sentence_and_exits_with_2(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    def work() -> None:
        raise PanelError("N 1", "the apex would fall\ninside the panel.")

    assert run(work) == 2
    assert capsys.readouterr() == ("", "Panel 'N 1': the apex would fall inside the panel.\n")


def test_a_tolerance_that_does_not_hold_exits_with_1(run: Callable[..., int]) -> None:
    def work() -> None:
        raise typer.Exit(1)

    assert run(work) == 1


def test_an_interrupt_exits_with_130(run: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    def work() -> None:
        raise KeyboardInterrupt

    assert run(work) == 130
    assert capsys.readouterr().err == "Interrupted.\n"


def test_a_polite_kill_unwinds_as_an_interrupt_does(run: Callable[..., int]) -> None:
    cleaned_up = []

    def work() -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        finally:
            cleaned_up.append(True)

    before = signal.getsignal(signal.SIGTERM)
    try:
        with pytest.raises(SystemExit) as raised:
            run(work)
    finally:
        signal.signal(signal.SIGTERM, before)
    assert raised.value.code == 143
    assert cleaned_up


def test_a_programming_fault_is_not_hidden(
    run: Callable[..., int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def work() -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert run(work) == 3
    (file,) = tmp_path.iterdir()
    assert "in work\n" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize("arguments", [[], ["--nonsense"], ["nonsense"], ["nonsense", "--out"]])
def test_wrong_usage_is_one_sentence_and_exits_with_2(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main(arguments) == 2
    answer = capsys.readouterr()
    assert answer.out == ""
    assert answer.err.endswith("(see 'cadpanel --help').\n")
    assert answer.err.count("\n") == 1


def test_the_version_is_the_packages(capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main(["--version"]) == 0
    assert capsys.readouterr().out == f"cadpanel {version('cadpanel')}\n"


def test_every_command_has_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main(["--help"]) == 0
    overview = capsys.readouterr().out
    for command in program.COMMANDS:
        assert command.__name__ in overview
        assert command.__doc__
        assert program.main([command.__name__, "--help"]) == 0


def test_the_program_starts_as_a_module() -> None:
    answer = subprocess.run(
        [sys.executable, "-m", "cadpanel.cli.main", "--nonsense"], capture_output=True, text=True, timeout=60
    )
    assert answer.returncode == 2
    assert answer.stderr.count("\n") == 1


@pytest.mark.parametrize("words", [("features",), ("verify", "build"), ("inspect", "/nowhere/model.step")])
def test_a_folder_that_is_gone_is_one_sentence(tmp_path: Path, words: tuple[str, ...]) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    program = f"""
import os, sys
from cadpanel.cli.main import main
os.chdir({str(gone)!r})
os.rmdir({str(gone)!r})
sys.exit(main(sys.argv[1:]))
"""
    answer = subprocess.run([sys.executable, "-c", program, *words], capture_output=True, text=True, timeout=60)
    assert answer.returncode == 2
    assert answer.stderr == "The folder that this was started in no longer exists: change to another one.\n"
