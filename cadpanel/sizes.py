"""How large a file may be that is read: judged before it is opened, as a file may claim any size and hold nothing."""

from __future__ import annotations

from pathlib import Path

from cadpanel.errors import CadpanelError

LARGEST = 4_000_000_000
"""Bytes. A delivery of ten thousand panels has files of a tenth of that."""


def refuse_huge(path: Path, refusal: type[CadpanelError]) -> None:
    """Refuse a file that is larger than any that is read; whoever reads it says what is wrong with one that is none.

    Raises:
        CadpanelError: the refusal that was given.
    """
    try:
        size = path.stat().st_size
    except OSError:
        return
    if size > LARGEST:
        raise refusal(
            f"'{path.name}' is a file of {size / 1e9:.1f} GB, and none of more than {LARGEST / 1e9:g} GB is read: "
            "export or write it again."
        )
