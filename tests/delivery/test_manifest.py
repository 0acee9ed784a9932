"""manifest.json says of every other file what it was when it was written."""

import hashlib
import json

import pytest

from cadpanel.delivery.manifest import MANIFEST, changed_files, read_manifest, unlisted_files, write_manifest
from cadpanel.errors import DeliveryError


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "flat").mkdir()
    (tmp_path / "panels.step").write_bytes(b"solids")
    (tmp_path / "flat" / "all.dxf").write_bytes(b"lines")
    (tmp_path / "Größe, 3.csv").write_bytes(b"")
    write_manifest(tmp_path)
    return tmp_path


def test_every_other_file_is_there_with_its_size_and_hash(folder):
    files = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["files"]
    assert sorted(files) == ["Größe, 3.csv", "flat/all.dxf", "panels.step"]
    assert files["panels.step"] == {"size": 6, "sha256": hashlib.sha256(b"solids").hexdigest()}


def test_the_same_files_give_the_same_bytes_and_the_manifest_does_not_count_itself(folder):
    first = (folder / MANIFEST).read_bytes()
    write_manifest(folder)
    assert (folder / MANIFEST).read_bytes() == first
    assert changed_files(folder) == ()


def test_a_file_that_was_changed_or_taken_away_is_named_and_one_that_came_is_nobodys(folder):
    (folder / "panels.step").write_bytes(b"SOLIDS")
    (folder / "flat" / "all.dxf").unlink()
    (folder / "notes.txt").write_bytes(b"mine")
    assert changed_files(folder) == ("flat/all.dxf", "panels.step")
    assert unlisted_files(folder) == ("notes.txt",)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is not a cadpanel manifest"),
        ('{"schema": "cadpanel.report/1", "files": {}}', '"cadpanel.manifest/1" is expected'),
        ('{"schema": "cadpanel.manifest/1", "files": {"a": {"size": 1, "sha256": "0"}}}', "files.a.sha256"),
    ],
)
def test_what_is_no_manifest_is_refused(folder, text, says):
    (folder / MANIFEST).write_text(text)
    with pytest.raises(DeliveryError, match=says):
        read_manifest(folder)
