"""Under the help of every command stands an example that is run; a shell completes commands."""

from __future__ import annotations

import pytest

from cadpanel.cli import main as program
from cadpanel.cli.examples import EXAMPLES, epilog


def test_every_command_has_examples_of_itself() -> None:
    assert set(EXAMPLES) == {command.__name__ for command in program.COMMANDS} | {"install"}
    for command, lines in EXAMPLES.items():
        assert lines
        assert all(command in line.split()[:3] for line in lines)
        assert epilog(command).endswith(lines[-1])


def test_the_help_ends_with_the_examples(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert program.main(["verify", "--help"]) == 0
    said = capsys.readouterr().out
    assert said.index("--quiet") < said.index("Example:") < said.index(EXAMPLES["verify"][0])


def test_a_shell_completes_commands(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_CADPANEL_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", "cadpanel fi")
    monkeypatch.setenv("COMP_CWORD", "1")
    with pytest.raises(SystemExit):
        program.main([])
    assert capsys.readouterr().out.split() == ["fit"]
