"""A file is judged by its size before it is read: one of 100 GB that holds nothing takes no time and no memory."""

import os
import shutil

import pytest

import cadpanel as cp
from cadpanel.delivery.own_files import REPORT
from cadpanel.errors import CadpanelError
from cadpanel.sizes import LARGEST, refuse_huge


def huge(path):
    with path.open("wb") as file:
        file.truncate(100_000_000_000)
    return path


def test_one_byte_more_than_the_largest_is_refused(tmp_path):
    path = tmp_path / "x.step"
    for size, refused in ((LARGEST, False), (LARGEST + 1, True)):
        path.write_bytes(b"")
        os.truncate(path, size)
        if not refused:
            refuse_huge(path, CadpanelError)
            continue
        with pytest.raises(CadpanelError, match=r"'x\.step' is a file of 4\.0 GB, and none of more than 4 GB is read"):
            refuse_huge(path, CadpanelError)
    refuse_huge(tmp_path / "none", CadpanelError)


@pytest.mark.parametrize("name", ["a.step", "a.igs", "a.brep", "a.3dm", "a.txt"])
def test_a_sparse_reference_is_refused(tmp_path, name):
    with pytest.raises(CadpanelError, match=r"is a file of 100\.0 GB"):
        cp.read(huge(tmp_path / name))


@pytest.mark.parametrize("name", [REPORT, "manifest.json"])
def test_a_sparse_file_of_a_delivery_is_refused(tmp_path, name):
    for one in (REPORT, "manifest.json"):
        (tmp_path / one).write_text('{"schema": "cadpanel.report/1"}')
    huge(tmp_path / name)
    with pytest.raises(CadpanelError, match=r"is a file of 100\.0 GB"):
        cp.verify(tmp_path)
    shutil.rmtree(tmp_path)


def test_sparse_rules_are_refused(tmp_path):
    with pytest.raises(CadpanelError, match=r"is a file of 100\.0 GB"):
        cp.FitSettings(rules=huge(tmp_path / "rules.toml"))
