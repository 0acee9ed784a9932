"""A file is written whole or not at all, and what a killed run leaves is told from what belongs to others."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from cadpanel.delivery.whole_file import is_left_of, write_whole


def test_a_file_is_as_it_was_until_the_new_one_is_on_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "summary.json"
    write_whole(path, b"one")
    for kind in (OSError(errno.ENOSPC, "full"), KeyboardInterrupt()):

        def refuse(_handle: int, kind: BaseException = kind) -> None:
            assert path.read_bytes() == b"one"
            raise kind

        monkeypatch.setattr(os, "fsync", refuse)
        with pytest.raises(type(kind)):
            write_whole(path, b"another")
        assert [entry.name for entry in tmp_path.iterdir()] == ["summary.json"]
        assert path.read_bytes() == b"one"
    monkeypatch.undo()
    write_whole(path, b"another")
    assert path.read_bytes() == b"another"


def test_what_a_killed_run_leaves_is_known_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def killed(_self: Path, _target: Path) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", killed)
    monkeypatch.setattr(Path, "unlink", lambda *_, **__: None)
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "job.toml", b"one")
    (left,) = (entry.name for entry in tmp_path.iterdir())
    assert is_left_of(left, frozenset({"job.toml"}))
    assert not is_left_of(left, frozenset({"job"}))
    for name in ("job.toml", ".job.toml", ".job.toml.bak", ".job.toml.BACKUP12", "job.toml.0123abcd"):
        assert not is_left_of(name, frozenset({"job.toml"}))
