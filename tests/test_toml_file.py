"""TOML as people save it is read, and what is none is refused in one sentence that names the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.errors import SettingsError
from cadpanel.toml_file import read_toml


@pytest.mark.parametrize("before", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_editors_may_mark_a_file_and_end_its_lines_as_they_like(tmp_path: Path, before: bytes, ends: str) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(before + f"a = 1{ends}b = 'ü'{ends}".encode())
    assert read_toml(path, "the job") == ("a = 1\nb = 'ü'\n", {"a": 1, "b": "ü"})


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"a = \n", r"is no TOML: .*line 1"),
        ("a = 1".encode("utf-16"), "is no text in UTF-8"),
        (b"a = " + b"[" * 3000 + b"]" * 3000, "brackets in brackets"),
        (b"a = " + b"{b = " * 3000 + b"1" + b"}" * 3000, "brackets in brackets"),
    ],
)
def test_what_is_no_toml_is_refused(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(content)
    with pytest.raises(SettingsError, match=rf"the job '.*a\.toml' .*{said}"):
        read_toml(path, "the job")


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    for place in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(SettingsError, match=f"the job '{place}' cannot be read"):
            read_toml(place, "the job")
    with pytest.raises(SettingsError, match="no file is"):
        read_toml(Path("a\0b"), "the job")
