"""What can be told from a file's text before the CAD kernel sees it.

The kernel reads half a file, or a number that is none, without a word and goes on with what is left; so these are
looked for here.
"""

from __future__ import annotations

import math
import re
import stat
from pathlib import Path

from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings, file_named
from cadpanel.sizes import refuse_huge

READABLE = "cadpanel reads STEP files (AP203, AP214 or AP242), IGES, .brep and Rhino .3dm"
# The first and last part of a file in which its beginning and end are looked for.
MARGIN_BYTES = 4096
START = b"ISO-10303-21"
END = b"END-ISO-10303-21"
RHINO_START = re.compile(rb"\s*3D Geometry File Format")

# First bytes of what people hand over by mistake, and what to call it.
OTHER_FORMATS = (
    (re.compile(rb"\s*solid\b"), "an STL file"),
    (re.compile(rb"AC10\d\d"), "a DWG drawing"),
    (re.compile(rb"\s*0\r?\nSECTION"), "a DXF drawing"),
    (re.compile(rb"PK\x03\x04"), "a ZIP archive"),
    (re.compile(rb"\x1f\x8b"), "a gzip archive"),
)
QUOTED = re.compile(rb"'[^']*'")
# Also what may be too large for a number: with a power of ten of three digits or more, leading zeros aside, or with as
# many digits before the point. Some, as 1.E400, keep the kernel busy for minutes.
NOT_A_NUMBER = re.compile(
    rb"[(,]\s*([-+]?(?:nan|inf|infinity|\d+\.#\w+|\d+\.?\d*E\+?0*[1-9]\d\d+|\d{100,}\.?\d*))\s*(?=[,)])", re.IGNORECASE
)
LARGEST = 1e100
"""What is larger is no length, in whatever unit."""
# What each of them holds, found in a fraction of the time; names may hold it too. Digits in a row are all made noughts,
# as a text is found ten times faster than a pattern.
TRACES = (b"nan", b"inf", b".#")
LARGE_POWER = re.compile(rb"e\+?0*[1-9]\d\d")
NOUGHTS = bytes.maketrans(b"123456789", b"0" * 9)
MANY_DIGITS = b"0" * 100
INSTANCE = re.compile(rb"#(\d+)\s*=")


def contents(path: Path, most: int = -1) -> bytes:
    """The bytes of a file, or its first ones.

    Raises:
        ReferenceFileError: there is no such file, it is a folder or pipe, cannot be read, or is empty.
    """
    refuse_huge(path, ReferenceFileError)
    try:
        kind = path.stat().st_mode
        if stat.S_ISDIR(kind):
            raise ReferenceFileError(f"'{path}' is a folder: give the file of the reference in it.")
        if not stat.S_ISREG(kind):  # reading a pipe might never end
            raise ReferenceFileError(
                f"'{path}' is a pipe or a device: save what comes out of it to a file, and give that."
            )
        with path.open("rb") as file:
            text = file.read(most)
    except FileNotFoundError:
        raise ReferenceFileError(f"'{path}' does not exist: check the name and the folder.") from None
    except OSError as error:
        raise ReferenceFileError(
            f"'{path}' cannot be read ({error.strerror}): check its name and permissions."
        ) from error
    if not text.strip():
        raise ReferenceFileError(f"'{path.name}' is empty: export the reference again.")
    return text


def require_files(reference: str | Path, settings: ReferenceSettings) -> None:
    """Refuse files that are not there, before anybody waits for the kernel to be loaded.

    Args:
        reference: the file.
        settings: with the file that is read beside it.

    Raises:
        ReferenceFileError: as `contents` says.
        SettingsError: the name is none.
    """
    path = file_named(reference, "reference")
    for file in (path, settings.beside(path)):
        if file is not None:
            contents(file, MARGIN_BYTES)


def refuse_format(path: Path, head: bytes) -> ReferenceFileError:
    """What to say of a file in a format that is not read, by its first bytes."""
    called = next((name for signature, name in OTHER_FORMATS if signature.match(head)), "of no format that it knows")
    return ReferenceFileError(f"'{path.name}' is {called}: {READABLE}; export the reference as STEP.")


def check_step_text(path: Path, text: bytes) -> None:
    """Refuse a STEP file that breaks off, or holds numbers that are none.

    Raises:
        ReferenceFileError: the first of these that is found, naming the file.
    """
    if END not in text[-MARGIN_BYTES:]:
        raise ReferenceFileError(
            f"'{path.name}' breaks off before its end ({END.decode()} is missing): copy or export it again."
        )
    _check_numbers(path.name, text)


def _check_numbers(name: str, text: bytes) -> None:
    """Refuse NaN and infinity, which the kernel would replace by numbers of its own."""
    lower = text.lower()
    large = LARGE_POWER.search(lower) or MANY_DIGITS in lower.translate(NOUGHTS)
    if not (large or any(trace in lower for trace in TRACES)):
        return
    if _first_fault(text) is None:
        return
    # Names may hold anything, so look again with every quoted text emptied.
    bare = QUOTED.sub(b"''", text)
    found = _first_fault(bare)
    if found is None:
        return
    instances = INSTANCE.findall(bare[: found.start()])
    where = f" at #{instances[-1].decode()}" if instances else ""
    raise ReferenceFileError(
        f"'{name}' holds a coordinate that is not a number ({found.group(1).decode():.40}{where}): "
        "repair that face and export the reference again."
    )


def _first_fault(text: bytes) -> re.Match[bytes] | None:
    """The first number in a text that is none, or beyond all bounds: zero to any power is one."""
    return next((found for found in NOT_A_NUMBER.finditer(text) if not abs(_value(found.group(1))) <= LARGEST), None)


def _value(word: bytes) -> float:
    try:
        return float(word)
    except ValueError:  # as Windows writes what is none, 1.#QNAN
        return math.nan
