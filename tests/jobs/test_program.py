from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cadpanel.jobs import program as module
from cadpanel.jobs.program import program, program_sum, text_sum


@pytest.fixture
def forgetful() -> Iterator[None]:
    program.cache_clear()
    yield
    program.cache_clear()


def test_the_program_is_told_by_its_text_and_what_it_computes_with() -> None:
    assert len(program()["text"]) == 64
    assert {"numpy", "scipy", "cadquery", "cadquery-ocp"} <= set(program()["packages"])
    assert program()["python"] == f"{sys.version_info.major}.{sys.version_info.minor}"


@pytest.mark.usefixtures("forgetful")
def test_a_package_counts_where_it_is_needed_and_nowhere_else(monkeypatch: pytest.MonkeyPatch) -> None:
    def sums() -> list[str]:
        program.cache_clear()
        return [program_sum(), program_sum(("openpyxl",)), program_sum(("numpy",))]

    versions = {"openpyxl": "1"}
    monkeypatch.setattr(module, "version", lambda name: versions.get(name, "0"))
    before = sums()
    versions["openpyxl"] = "2"
    after = sums()
    assert (before[0], before[2]) == (after[0], after[2])
    assert before[1] != after[1]
    versions["numpy"] = "1"
    assert not set(sums()) & {*before, *after}


@pytest.mark.parametrize("name", ["a.py", "page/main.js", "page/page.css", "page/page.html"])
def test_whatever_file_of_the_program_changes_it_is_another_one(tmp_path: Path, name: str) -> None:
    def write(path: str, text: str) -> None:
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")

    for file in ("a.py", "page/main.js", "page/page.css", "page/page.html"):
        write(file, "1")
    before = text_sum(tmp_path)
    write("__pycache__/a.cpython-311.pyc", "compiled")
    assert text_sum(tmp_path) == before
    write(name, "2")
    assert text_sum(tmp_path) != before
    (tmp_path / name).rename(tmp_path / "b")
    write(name, "1")
    assert text_sum(tmp_path) != before
