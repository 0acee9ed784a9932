"""What in a folder is ours to replace, and what is not."""

from pathlib import Path

import pytest

from cadpanel.delivery.manifest import MANIFEST, write_manifest
from cadpanel.delivery.own_files import changed_since, is_ours, strangers


@pytest.fixture
def place(tmp_path: Path) -> Path:
    (tmp_path / "report.json").write_text('{"schema": "cadpanel.report/1"}')
    (tmp_path / "panels.step").write_text("solids")
    write_manifest(tmp_path)
    return tmp_path


def test_a_delivery_is_ours_whole(place: Path) -> None:
    assert is_ours(place)
    assert strangers(place) == set()
    assert changed_since(place) == ()


def test_links_and_folders_under_our_names_are_not(place: Path) -> None:
    (place / "skins.step").symlink_to("panels.step")
    (place / ".DS_Store").mkdir()
    (place / "flat").write_text("a file")
    assert strangers(place) == {"skins.step", ".DS_Store", "flat"}


APPLE_DOUBLE = bytes.fromhex("00051607 00020000") + b"Mac OS X        "


def test_what_file_managers_leave_is_no_strangers(place: Path) -> None:
    (place / "flat").mkdir()
    for folder in (place, place / "flat"):
        for name in (".DS_Store", "Thumbs.db", "desktop.ini"):
            (folder / name).write_bytes(b"litter")
        for name in ("._panels.step", "._.DS_Store"):
            (folder / name).write_bytes(APPLE_DOUBLE)
    assert strangers(place) == set()
    assert changed_since(place) == ()


def test_what_is_only_called_as_litter_is_somebodys(place: Path) -> None:
    (place / "._notes").write_text("a day's work")
    (place / "._work").mkdir()
    (place / "._link").symlink_to(place / "report.json")
    assert strangers(place) == {"._notes", "._work", "._link"}


def test_a_folder_with_nothing_but_litter_is_empty(tmp_path: Path) -> None:
    (tmp_path / ".DS_Store").write_bytes(b"litter")
    (tmp_path / "._.DS_Store").write_bytes(APPLE_DOUBLE)
    assert is_ours(tmp_path)
    (tmp_path / "._notes").write_text("a day's work")
    assert not is_ours(tmp_path)


def test_what_somebody_changed_is_named_and_what_somebody_took_is_not_missed(place: Path) -> None:
    (place / "panels.step").unlink()
    assert changed_since(place) == ()
    (place / "report.json").write_text('{"schema": "cadpanel.report/1", "mine": 1}')
    assert changed_since(place) == ("report.json",)
    (place / MANIFEST).write_text("{}")
    assert changed_since(place) == (MANIFEST,)


def test_where_no_manifest_is_nothing_is_known_to_be_changed(place: Path) -> None:
    (place / MANIFEST).unlink()
    assert changed_since(place) == ()


def test_an_empty_folder_is_anybodys(tmp_path: Path) -> None:
    assert is_ours(tmp_path)
    (tmp_path / "photo.jpg").write_text("")
    assert not is_ours(tmp_path)
