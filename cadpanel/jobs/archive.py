"""A delivery as bytes, so that it can go from a worker to a run, and into a folder of results and out again."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

from cadpanel.delivery.manifest import changed_files, write_manifest
from cadpanel.errors import DeliveryError

_QUICKLY = 1
_MOST_WORDS = 60_000
"""Bytes of the words at the end of an archive; more it cannot hold."""


def packed(folder: Path, missed: str | None) -> bytes:
    """A delivery with its manifest, and what its tolerance or its stock lacks."""
    write_manifest(folder)
    stream = io.BytesIO()
    with zipfile.ZipFile(
        stream,
        "w",
        zipfile.ZIP_DEFLATED,
        compresslevel=_QUICKLY,
        strict_timestamps=False,  # a clock that is not set says 1970, which it does not know
    ) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                archive.write(path, path.relative_to(folder).as_posix())
        archive.comment = (missed or "").encode()[:_MOST_WORDS]
    return stream.getvalue()


def unpacked(archive: bytes, folder: Path) -> str | None:
    """Put it into a folder that is there; what its tolerance or its stock lacks.

    Raises:
        DeliveryError: the bytes are damaged, by the archive's sums or by the manifest's.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(archive)) as files:
            files.extractall(folder)
            said = files.comment.decode(errors="replace")
    except (zipfile.BadZipFile, EOFError, ValueError, NotImplementedError) as error:
        raise DeliveryError(f"a kept result is damaged: {error}.") from error
    changed = changed_files(folder)
    if changed:
        raise DeliveryError(f"a kept result is damaged: '{changed[0]}' is not as it was written.")
    return said or None
