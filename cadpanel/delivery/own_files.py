"""What in a folder cadpanel has written: that alone may be replaced."""

from __future__ import annotations

import os
import re
from pathlib import Path

from cadpanel.delivery.manifest import MANIFEST, changed_files
from cadpanel.delivery.outputs.catalogue import OUTPUTS
from cadpanel.errors import DeliveryError

REPORT = "report.json"
COMPARISON = "compare.json"
STUDY, STUDY_TABLE = "study.json", "study.csv"
JOB = "job.toml"
"""The job that a delivery was made by, where one did."""
STUDY_PLOTS = ("study.png", "study.svg")
LOFT, LOFT_STEP, LOFT_DXF, LOFT_PNG, LOFT_DOCUMENT = LOFT_FILES = (
    *("loft.json", "loft.step", "loft.dxf", "loft.png", "loft.FCStd"),
)

MARKS_OF_A_DELIVERY = (REPORT, COMPARISON, STUDY, LOFT)
"""A folder that holds one of these, and it speaks of a schema of ours, was written by cadpanel."""
OWN_FILES = frozenset(
    {
        *(REPORT, COMPARISON, STUDY, STUDY_TABLE, MANIFEST, JOB),
        *STUDY_PLOTS,
        *LOFT_FILES,
        *(name for output in OUTPUTS for name in output.files),
    }
)
"""All that cadpanel writes; whatever else stands in a delivery is someone's work and is never deleted."""
OWN_FOLDERS = {folder: mark for output in OUTPUTS for folder, mark in output.folders.items()}
"""Folders that cadpanel writes, and how every file in one of them begins."""
LITTER = frozenset({".DS_Store", "Thumbs.db", "desktop.ini"})
"""What file managers leave in a folder that people look into; it goes with the delivery."""
_APPLE_DOUBLE = b"\x00\x05\x16\x07"
"""How the files begin that macOS puts beside others on shared disks and sticks: ._panels.step beside panels.step."""

_OWN_SCHEMA = re.compile(rb'"schema"\s*:\s*"cadpanel\.')
_MARK_BYTES = 4096


def strangers(place: Path) -> set[str]:
    """What stands in a delivery and is not as cadpanel wrote it: other files, folders under our names, changed files.

    Raises:
        OSError: something cannot be read.
    """
    found = {entry.name for entry in place.iterdir() if not _is_known(entry)}
    for folder, mark in OWN_FOLDERS.items():
        if not (place / folder).is_dir():
            continue
        for entry in (place / folder).iterdir():
            if not _is_plain(entry) or not (_is_litter(entry) or _begins(entry, mark)):
                found.add(f"{folder}/{entry.name}")
    return found


def changed_since(place: Path) -> tuple[str, ...]:
    """The files of a delivery that somebody has changed since they were written, as far as its manifest can be read.

    Raises:
        OSError: a file cannot be read.
    """
    if not (place / MANIFEST).is_file():
        return ()
    try:
        return tuple(name for name in changed_files(place) if os.path.lexists(place / name))
    except DeliveryError:
        return (MANIFEST,)


def is_ours(place: Path) -> bool:
    """Whether a folder is empty, but for litter, or holds a file that begins as ours do.

    Raises:
        OSError: something cannot be read.
    """
    holds_nothing = all(_is_litter(entry) for entry in place.iterdir())
    return holds_nothing or any(_is_mark(place / mark) for mark in MARKS_OF_A_DELIVERY)


def _is_litter(entry: Path) -> bool:
    """Whether nobody wrote a file: a file manager left it.

    Raises:
        OSError: it cannot be read.
    """
    beside_another = entry.name.startswith("._") and _is_plain(entry) and _begins(entry, _APPLE_DOUBLE)
    return entry.name in LITTER or beside_another


def _is_known(entry: Path) -> bool:
    if entry.name in OWN_FOLDERS:
        return entry.is_dir() and not entry.is_symlink()
    return _is_plain(entry) and (entry.name in OWN_FILES or _is_litter(entry))


def _is_plain(entry: Path) -> bool:
    """Whether it is a file, and no folder or link under the name of one."""
    return entry.is_file() and not entry.is_symlink()


def _begins(path: Path, mark: bytes) -> bool:
    with path.open("rb") as file:
        return file.read(len(mark)) == mark


def _is_mark(path: Path) -> bool:
    """Whether a file begins as our report or comparison does; other programs have files of these names too."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return _OWN_SCHEMA.search(file.read(_MARK_BYTES)) is not None
