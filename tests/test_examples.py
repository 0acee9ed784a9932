"""Every example and every command and snippet of the README is run as it stands there."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from cadpanel.cli import main as program

ROOT = Path(__file__).parent.parent
REFERENCE = ROOT / "fixtures" / "kai_tak_nw.step"
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))

README = (ROOT / "README.md").read_text(encoding="utf-8")
SNIPPETS = re.findall(r"^```python\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)
# Command lines stand indented; those with words in capitals show a form and not a run.
COMMANDS = [
    line.strip().rpartition("&& ")[2]
    for line in README.splitlines()
    if re.match(r"    (.*&& )?cadpanel [^A-Z]+$", line) or re.match(r"    (.*&& )?cadpanel .*fixtures/", line)
]


@pytest.fixture
def workplace(tmp_path: Path) -> Path:
    """A folder that looks like the repository's root to an example, so that nothing is written into the repository."""
    (tmp_path / "fixtures").symlink_to(ROOT / "fixtures")
    return tmp_path


def run(command: list[str], folder: Path) -> str:
    answer = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    assert answer.returncode == 0, f"{shlex.join(command)}\n{answer.stdout}{answer.stderr}"
    return answer.stdout


def test_there_are_examples_snippets_and_commands() -> None:
    assert len(EXAMPLES) >= 3
    assert SNIPPETS
    assert any(" fit " in command for command in COMMANDS)


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_writes_step(example: Path, workplace: Path) -> None:
    out = workplace / "out"
    said = run([sys.executable, str(example), "fixtures/kai_tak_nw.step", str(out)], workplace)
    assert "NW-01" in said
    assert list(out.glob("*.step"))


SHOW = """
import json, sys
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
for cell in json.load(open(sys.argv[1], encoding="utf-8"))["cells"]:
    if cell["cell_type"] == "code":
        done = shell.run_cell(cell["source"])
        done.raise_error()
        print("shown:", *shell.display_formatter.format(done.result)[0], file=sys.stderr)
"""


@pytest.mark.slow
def test_the_notebook_runs_and_every_cell_shows_something(workplace: Path) -> None:
    notebook = ROOT / "examples" / "look_at_a_fit.ipynb"
    command = [sys.executable, "-c", SHOW, str(notebook)]
    answer = subprocess.run(command, cwd=workplace, capture_output=True, text=True, timeout=300)
    assert answer.returncode == 0, answer.stdout + answer.stderr
    shown = [line.split()[1:] for line in answer.stderr.splitlines() if line.startswith("shown:")]
    assert len(shown) == 6
    assert all({"text/html", "image/png"} & set(kinds) for kinds in shown[1:])


@pytest.mark.slow
def test_the_snippets_of_the_readme_run_one_after_the_other(workplace: Path) -> None:
    (workplace / "snippets.py").write_text("\n".join(SNIPPETS), encoding="utf-8")
    run([sys.executable, "snippets.py"], workplace)


@pytest.mark.slow
def test_the_commands_of_the_readme_run_one_after_the_other(workplace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In this process: that the program starts is held by tests of its own, and the kernel takes long to load."""
    monkeypatch.chdir(workplace)
    for command in COMMANDS:
        words = shlex.split(command)
        assert words[0] == "cadpanel"
        assert program.main(words[1:]) == 0, command
