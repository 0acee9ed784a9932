"""Every example, and every command and snippet of every page, is run as it stands there."""

from __future__ import annotations

import re
import runpy
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from cadpanel.cli import main as program
from cadpanel.cli.examples import EXAMPLES as HELP
from cadpanel.fitting.settings import FitSettings
from examples.options import with_options
from tests.thorough import cases, thorough

ROOT = Path(__file__).parent.parent
REFERENCE = ROOT / "fixtures" / "kai_tak_nw.step"
# What draws and writes the pages is run by their commands, and held to what stands there.
FOR_PAGES = {"shapes", "pictures", "options"}
EXAMPLES = sorted(file for file in (ROOT / "examples").glob("*.py") if file.stem not in FOR_PAGES)
# `diff` finds what it is asked to find.
DIFFERS = {"diff": 1}

PAGES = [ROOT / "README.md", *(ROOT / "examples" / f"{name}.md" for name in ("tutorial", "gallery", "how-to"))]
PAGES += sorted(set((ROOT / "examples").glob("*.md")) - set(PAGES))
TEXTS = {page: page.read_text(encoding="utf-8") for page in PAGES}


def snippets(kind: str) -> list[str]:
    """The blocks of a kind on all pages."""
    return [
        block
        for text in TEXTS.values()
        for block in re.findall(rf"^```{kind}\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    ]


def commands(pages: list[Path] = PAGES) -> list[str]:
    """Every command line once: they stand indented, and those with words in capitals show a form and not a run.

    What draws the surfaces comes first, as the pages say.
    """
    lines = [line.strip() for page in pages for line in TEXTS[page].splitlines() if line.startswith("    ")]
    found = [line for line in lines if re.match(r"(cadpanel [^A-Z]+$|cadpanel .*fixtures/|python examples/)", line)]
    return sorted(dict.fromkeys(found), key=lambda line: not line.startswith("python examples/shapes.py"))


@pytest.fixture
def workplace(tmp_path: Path) -> Path:
    """A folder that looks like the repository's root to an example, so that nothing is written into the repository."""
    for folder in ("fixtures", "examples"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    return tmp_path


def run(command: list[str], folder: Path) -> str:
    answer = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    assert answer.returncode == 0, f"{shlex.join(command)}\n{answer.stdout}{answer.stderr}"
    return answer.stdout


def test_there_are_examples_snippets_and_commands() -> None:
    assert len(EXAMPLES) >= 3
    assert len(snippets("python")) >= 2
    assert any(" fit " in command for command in commands())


def test_every_example_of_the_help_stands_on_a_page_and_is_run() -> None:
    assert {line for lines in HELP.values() for line in lines} <= set(commands())


def test_the_tables_of_options_are_those_that_the_commands_make() -> None:
    page = ROOT / "examples" / "reference.md"
    assert TEXTS[page] == with_options(TEXTS[page]), "python examples/options.py writes them anew"


def test_links_and_pictures_of_the_pages_are_there_and_pictures_are_small() -> None:
    for page, text in TEXTS.items():
        for link in re.findall(r"\]\(([^)#]+)|src=\"([^\"]+)", text):
            file = page.parent / "".join(link)
            assert file.is_file(), f"{page.name}: {file}"
            assert file.suffix != ".png" or file.stat().st_size < 100_000, file


def test_the_readme_is_one_screen_with_a_picture_and_three_recipes() -> None:
    text = TEXTS[ROOT / "README.md"]
    assert len(text.splitlines()) <= 60
    assert text.index(".png") < text.index("pip install")
    assert len(re.findall(r"^    cadpanel fit ", text, flags=re.MULTILINE)) == 3


def test_the_rules_on_the_pages_are_rules() -> None:
    asked: list[Any] = [tomllib.loads(block) for block in snippets("toml") if "[regions" not in block]
    told = [FitSettings(rules=rules).rules for rules in asked]
    assert told
    assert all(told)


def test_the_job_on_the_pages_is_the_one_that_is_run() -> None:
    (job,) = [block for block in snippets("toml") if "[regions" in block]
    assert job in (ROOT / "examples" / "building.toml").read_text(encoding="utf-8")


@thorough
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_writes_step(example: Path, workplace: Path) -> None:
    out = workplace / "out"
    said = run([sys.executable, str(example), "fixtures/kai_tak_nw.step", str(out)], workplace)
    assert re.search("NW-0[1-8]", said)
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


@thorough
def test_the_notebook_runs_and_every_cell_shows_something(workplace: Path) -> None:
    notebook = ROOT / "examples" / "look_at_a_fit.ipynb"
    command = [sys.executable, "-c", SHOW, str(notebook)]
    answer = subprocess.run(command, cwd=workplace, capture_output=True, text=True, timeout=300)
    assert answer.returncode == 0, answer.stdout + answer.stderr
    shown = [line.split()[1:] for line in answer.stderr.splitlines() if line.startswith("shown:")]
    assert len(shown) == 6
    assert all({"text/html", "image/png"} & set(kinds) for kinds in shown[1:])


@thorough
def test_the_snippets_of_the_pages_run_one_after_the_other(workplace: Path) -> None:
    (workplace / "snippets.py").write_text("\n".join(snippets("python")), encoding="utf-8")
    run([sys.executable, "snippets.py"], workplace)


@thorough
@pytest.mark.parametrize("pages", cases([PAGES[:1]], [PAGES]), ids=cases(["the README"], ["all"]))
def test_the_commands_of_the_pages_run_one_after_the_other(
    pages: list[Path], workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In this process: that the program starts is held by tests of its own, and the kernel takes long to load."""
    monkeypatch.chdir(workplace)
    monkeypatch.setenv("XDG_CACHE_HOME", str(workplace / "cache"))
    for command in dict.fromkeys([*commands()[:1], *commands(pages)]):  # what draws the surfaces comes first
        words = shlex.split(command)
        if words[0] == "cadpanel":
            assert program.main(words[1:]) == DIFFERS.get(words[1], 0), command
            continue
        monkeypatch.setattr(sys, "argv", words[1:])
        runpy.run_path(str(ROOT / words[1]), run_name="__main__")
    for name in ("edge", "flare", "roof") if pages == PAGES else ():
        assert (workplace / "build" / "pictures" / f"{name}.png").is_file()
