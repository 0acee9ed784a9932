from __future__ import annotations

import sqlite3
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest
from diskcache import Cache

from cadpanel.errors import SettingsError
from cadpanel.jobs import results as kept
from cadpanel.jobs.results import Results, usual_folder

LARGE = bytes(range(256)) * 400
"""So much that it is a file of its own."""


def test_what_is_kept_is_found_by_another_run(tmp_path: Path) -> None:
    with Results(tmp_path / "a" / "cache") as results:
        assert results.get("key") is None
        results.put("key", LARGE)
        results.put("small", b"x")
    with Results(tmp_path / "a" / "cache") as results:
        assert results.get("key") == LARGE
        assert results.get("small") == b"x"


def test_a_damaged_result_is_none_and_is_made_again(tmp_path: Path) -> None:
    with Results(tmp_path) as results:
        results.put("key", LARGE)
        (file,) = tmp_path.rglob("*.val")
        file.write_bytes(file.read_bytes()[:-1] + b"?")
        assert results.get("key") is None
        results.put("key", LARGE)
        assert results.get("key") == LARGE
        (file,) = tmp_path.rglob("*.val")
        file.unlink()
        assert results.get("key") is None


def test_nothing_that_would_run_is_loaded(tmp_path: Path) -> None:
    with Cache(str(tmp_path)) as cache:
        cache.set("key", {"any": "object"})
        assert cache.get("key")
    with Results(tmp_path) as results:
        assert results.get("key") is None
        results.put("key", LARGE)
        assert results.get("key") == LARGE


def test_two_runs_may_keep_the_same_at_once(tmp_path: Path) -> None:
    def run(number: int) -> list[bytes | None]:
        with Results(tmp_path) as results:
            for key in range(8):
                results.put(str(key), LARGE[: 50_000 + key])
            return [results.get(str(key)) for key in range(number % 2, 8, 2)]

    with ThreadPoolExecutor(4) as runs:
        found = list(runs.map(run, range(4)))
    assert found[0] == found[2] == [LARGE[: 50_000 + key] for key in range(0, 8, 2)]
    assert found[1] == found[3]


def test_a_damaged_index_is_refused_with_what_to_do(tmp_path: Path) -> None:
    with Results(tmp_path) as results:
        results.put("key", LARGE)
    for path in tmp_path.glob("cache.db*"):
        path.write_bytes(b"no database " * 400)
    with pytest.raises(SettingsError, match="delete that folder, or name another one by --cache"):
        Results(tmp_path)
    (tmp_path / "file").touch()
    with pytest.raises(SettingsError, match=r"cannot be kept .*: name another folder by --cache"):
        Results(tmp_path / "file" / "cache")


def test_an_index_that_does_not_answer_is_waited_for_only_so_long(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kept, "PATIENCE", 0.01)
    with Results(tmp_path) as results:
        results.put("key", LARGE)
        with closing(sqlite3.connect(tmp_path / "cache.db", isolation_level=None)) as another:
            another.execute("BEGIN IMMEDIATE")
            for ask in (lambda: results.get("key"), lambda: results.put("other", LARGE)):
                with pytest.raises(
                    SettingsError, match=r"does not answer within 0\.01 s\): name another folder by --cache"
                ):
                    ask()
            another.execute("ROLLBACK")
        assert results.get("key") == LARGE


def test_the_usual_folder_is_one_for_what_can_be_made_again() -> None:
    assert usual_folder().is_absolute()
    assert "cadpanel" in usual_folder().parts
