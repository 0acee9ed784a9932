"""The command line where a system lacks what only POSIX has, as Windows does: no limits, no signals of a terminal."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.thorough import thorough

PACKAGE = Path(__file__).parents[2] / "cadpanel"
POSIX_ONLY = ("resource", "fcntl", "pwd", "grp", "termios", "tty", "pty", "syslog", "crypt", "nis", "readline")
# Without SIGKILL, which only Windows' own subprocess does without.
POSIX_SIGNALS = (
    "SIGHUP",
    "SIGQUIT",
    "SIGALRM",
    "SIGUSR1",
    "SIGUSR2",
    "SIGPIPE",
    "SIGCHLD",
)  # subprocess itself needs SIGKILL here
# Every interpreter that is started finds this first, the second one as well.
HIDING = f"""
import os, signal, sys
for name in {POSIX_ONLY!r}:
    sys.modules[name] = None
for name in {POSIX_SIGNALS!r}:
    if hasattr(signal, name):
        delattr(signal, name)
for name in ("fork", "forkpty", "getuid", "geteuid", "setsid", "killpg", "getpgid", "sched_getaffinity", "mkfifo"):
    if hasattr(os, name):
        delattr(os, name)
"""


@pytest.fixture
def elsewhere(tmp_path: Path) -> dict[str, str]:
    """An environment in which they are hidden."""
    folder = tmp_path / "hiding"
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(HIDING, encoding="utf-8")
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), str(PACKAGE.parent)])}


def run(environment: dict[str, str], *words: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "cadpanel.cli.main", *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment)


def test_what_is_hidden_is_hidden_indeed(elsewhere: dict[str, str]) -> None:
    asked = (
        "import signal, sys, os\ntry:\n    import resource\nexcept ImportError:\n    print(hasattr(signal, 'SIGHUP'))"
    )
    answer = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, env=elsewhere, timeout=60)
    assert answer.stdout.strip() == "False"


@thorough
def test_a_run_is_delivered_and_verified_without_what_posix_alone_has(
    elsewhere: dict[str, str], lip_step: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    answer = run(elsewhere, "fit", lip_step, "--out", out, "--quiet")
    assert (answer.returncode, answer.stderr) == (0, "")
    assert json.loads((out / "report.json").read_text(encoding="utf-8"))["certificate"]["valid"]
    answer = run(elsewhere, "verify", out, "--quiet")
    assert (answer.returncode, answer.stderr) == (0, "")


@thorough
def test_bad_files_are_one_sentence_there_too(elsewhere: dict[str, str], tmp_path: Path) -> None:
    broken = tmp_path / "broken.step"
    broken.write_text("ISO-10303-21;\nHEADER;\n", encoding="utf-8")
    answer = run(elsewhere, "inspect", broken)
    assert answer.returncode == 2
    assert answer.stderr.count("\n") == 1
    assert "broken.step" in answer.stderr


def test_no_module_of_posix_alone_is_imported_without_a_fallback() -> None:
    """Only inside a `try` that goes on without it: such an import is indented."""
    plain = re.compile(rf"^(?:import|from) (?:{'|'.join(POSIX_ONLY)})\b", re.MULTILINE)
    found = [str(path) for path in PACKAGE.rglob("*.py") if plain.search(path.read_text(encoding="utf-8"))]
    assert found == []
    assert plain.search("import os\nimport resource\n")
    assert not plain.search("try:\n    import resource\nexcept ImportError:\n    resource = None\n")
