"""The folder of a job: what a killed run leaves is no stranger there, and a damaged job in it is no licence."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.errors import DeliveryError
from cadpanel.jobs.folder import begin_folder, refuse_no_folder_of_a_job, refuse_or_find
from tests.jobs.jobs import job, parts


def test_what_a_killed_run_leaves_keeps_no_run_out_and_is_cleared(strip: Path, tmp_path: Path) -> None:
    for name in (".job.toml.0123abcd", ".building.step.x_9abcde", ".summary.json.00000000", ".cadpanel-lock"):
        (tmp_path / name).touch()
    refuse_no_folder_of_a_job(tmp_path)
    begin_folder(parts(job(strip, "A = {}")), tmp_path)
    assert {entry.name for entry in tmp_path.iterdir()} == {"job.toml", ".cadpanel-lock"}
    (tmp_path / ".job.toml.mine").touch()
    (tmp_path / "job.toml").unlink()
    with pytest.raises(DeliveryError, match=r"holds files but no job\.toml"):
        refuse_no_folder_of_a_job(tmp_path)


def test_a_job_there_that_is_none_any_more_is_replaced_only_if_asked_for(strip: Path, tmp_path: Path) -> None:
    asked = parts(job(strip, "A = {}"))
    begin_folder(asked, tmp_path)
    assert refuse_or_find(asked, tmp_path, overwrite=False, fresh=False) == frozenset()
    whole = (tmp_path / "job.toml").read_bytes()
    for damaged in (whole + b"\n[", whole.replace(b"regions.A", b"region.A"), whole + b"\xff"):
        (tmp_path / "job.toml").write_bytes(damaged)
        with pytest.raises(DeliveryError, match=r"job\.toml' was changed since cadpanel wrote it.*with --overwrite"):
            refuse_or_find(asked, tmp_path, overwrite=False, fresh=False)
        assert refuse_or_find(asked, tmp_path, overwrite=True, fresh=False) == frozenset()
