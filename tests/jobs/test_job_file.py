from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.errors import SettingsError
from cadpanel.jobs.job_file import JobFile


def job(folder: Path, text: str) -> JobFile:
    path = folder / "job.toml"
    path.write_text(text, encoding="utf-8-sig")
    return JobFile(path)


def test_what_is_refused_is_one_sentence_with_its_line(tmp_path: Path) -> None:
    file = job(tmp_path, "\n[defaults]\nseed = 1\n[regions.A]\n")
    with pytest.raises(SettingsError, match=r"job\.toml', line 3: it is odd\.$"):
        file.refuse(("defaults", "seed"), "it is odd. ")
    with pytest.raises(SettingsError, match="line 4: there is no variable 'b'"):
        file.filled(("regions", "A"), "${b}", {}, {})
    assert file.filled(("regions", "A"), ["${b}"], {"b": 2}, {}) == [2]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "at least one region"),
        ("[regions]", "line 1: a job has at least one region"),
        ("[regions.A]\n[regoins.B]", "line 2: a job has no 'regoins'"),
        ("seed = 1\n[regions.A]", "line 1: a job has no 'seed'; settings stand in"),
        ("[variables]\na = 1\nb = {}\n[regions.A]", "line 3: 'variables.b': input should be"),
        ("out = 1\n[regions.A]", "line 1: 'out': input should be"),
    ],
)
def test_what_is_no_job_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        job(tmp_path, text)
