"""What an exception of the CAD kernel says, as a part of one sentence."""

from __future__ import annotations

import re

# Where an object of the kernel lies in memory, which its messages name over lines of their own.
_POINTER = re.compile(r"0x[0-9a-f]+ : ")


def said_by(error: BaseException) -> str:
    """Its words on one line, without places in memory; its kind where it has none."""
    return _POINTER.sub("", " ".join(str(error).split())) or type(error).__name__
