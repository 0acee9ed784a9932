"""All formats that are read, and which one a file is of."""

from __future__ import annotations

from pathlib import Path

from cadpanel.brep.files.brep import BREP
from cadpanel.brep.files.format import Format
from cadpanel.brep.files.iges import IGES
from cadpanel.brep.files.rhino import RHINO
from cadpanel.brep.files.step import STEP
from cadpanel.brep.files.text_check import MARGIN_BYTES, contents, refuse_format

FORMATS: tuple[Format, ...] = (STEP, IGES, BREP, RHINO)


def format_of(path: Path) -> Format:
    """The format that a file's first bytes speak for, whatever its name ends in.

    Raises:
        ReferenceFileError: there is no such file, it is empty, or of a format that is not read.
    """
    head = contents(path, MARGIN_BYTES)
    for form in FORMATS:
        if form.recognises(head):
            return form
    raise refuse_format(path, head)


def checked_format_of(path: Path) -> Format:
    """The same, once the file's text shows no damage.

    Raises:
        ReferenceFileError: as above, or the text does.
    """
    form = format_of(path)
    form.check(path, contents(path))
    return form
