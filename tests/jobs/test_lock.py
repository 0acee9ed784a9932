"""One run at a time is at a folder; what a killed one leaves keeps nobody out."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cadpanel.errors import DeliveryError
from cadpanel.jobs import lock
from cadpanel.jobs.lock import LOCK, alone


def refused(out: Path) -> bool:
    try:
        with alone(out):
            return False
    except DeliveryError as error:
        return f"another run writes into '{out}' now: wait until it has ended" in str(error)


def test_a_second_run_is_refused_until_the_first_has_ended_in_whatever_way(tmp_path: Path) -> None:
    out = tmp_path / "a" / "b"
    with alone(out):
        assert refused(out)
        assert refused(out)
        assert not refused(tmp_path / "c")
    assert not refused(out)
    with pytest.raises(KeyboardInterrupt), alone(out):
        raise KeyboardInterrupt
    assert not refused(out)
    assert list(out.iterdir()) == []


def test_the_file_of_a_killed_run_keeps_nobody_out(tmp_path: Path) -> None:
    (tmp_path / LOCK).touch()
    assert not refused(tmp_path)


@pytest.mark.skipif(os.name == "nt", reason="an open file is not deleted there")
def test_a_file_that_is_deleted_before_it_is_locked_locks_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    is_taken, tried = lock._is_taken, list[int]()

    def late(handle: int) -> bool:
        if not tried:
            (tmp_path / LOCK).unlink()  # the run that had it ends
        tried.append(handle)
        return is_taken(handle)

    monkeypatch.setattr(lock, "_is_taken", late)
    with alone(tmp_path):
        assert len(tried) == 2
        assert refused(tmp_path)


def test_where_nothing_can_be_written_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(DeliveryError, match="file' cannot be written"), alone(tmp_path / "file"):
        pass
