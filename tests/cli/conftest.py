"""What the tests of the commands share: a small reference file, one delivery of it, and a way to run a command."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from cadpanel.cli import main as program
from fixtures.make_fixtures import Fixture, write
from tests.delivered import LIP


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    code: int
    out: str
    err: str

    def is_one_sentence(self) -> bool:
        """One line on stderr that begins and ends as a sentence does, and nothing on stdout."""
        return self.out == "" and self.err.count("\n") == 1 and self.err.endswith(".\n") and "Traceback" not in self.err


Run = Callable[..., Answer]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run the program in this process, as if its output went to a file."""
    monkeypatch.delenv("COLUMNS", raising=False)
    # What is written depends on the run alone, and not on how busy the machine is.
    monkeypatch.setattr("cadpanel.cli.steps.SILENCE", 3600.0)

    def run(*words: object) -> Answer:
        capsys.readouterr()
        code = program.main([str(word) for word in words])
        said = capsys.readouterr()
        return Answer(code=code, out=said.out, err=said.err)

    return run


@pytest.fixture(scope="session")
def lip_step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A strip of three panels."""
    path = tmp_path_factory.mktemp("reference") / "lip.step"
    write(Fixture(file=path.name, prefix="N", table=(), lip=LIP), path)
    return path


@pytest.fixture(scope="session")
def delivered(lip_step: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A delivery of the strip, for reading only."""
    out = tmp_path_factory.mktemp("delivered") / "lip"
    assert program.main(["fit", str(lip_step), "--out", str(out), "--quiet"]) == 0
    return out


@pytest.fixture
def delivery(delivered: Path, tmp_path: Path) -> Path:
    """A copy of the delivery, to be tampered with."""
    return Path(shutil.copytree(delivered, tmp_path / "delivery"))
