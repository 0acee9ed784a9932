"""Hidden folders beside a delivery: what is being written, and what was left there by a run that was killed.

Their names say who writes: ".cadpanel-HOST-PID-TOKEN.part". A folder whose writer runs no more on this machine is
stale: the next run clears it, or puts it back where it is an old delivery that stood aside when its writer was killed.
Of other machines nobody can be asked, so a folder of theirs is stale when nothing was done to it for long.
"""

from __future__ import annotations

import hashlib
import os
import re
import secrets
import shutil
import socket
import time
from contextlib import suppress
from pathlib import Path

_NAME = re.compile(r"\.cadpanel-(?P<host>[0-9a-f]{8})-(?P<pid>\d+)-[0-9a-f]{8}(?P<what>\.part|\.old-.+)")
_DAY = 86_400.0
_STALE_SECONDS = {".part": 7 * _DAY, ".old": _DAY}
"""After which a folder counts as left behind where nobody can be asked whether its writer runs.

No fit takes a week, and no delivery stands aside for longer than two renames take.
"""


def work_folder(place: Path) -> Path:
    """A new name beside a place."""
    return place.with_name(f".cadpanel-{_host()}-{os.getpid()}-{secrets.token_hex(4)}.part")


def aside_of(work: Path, place: Path) -> Path:
    """Where what stands in a place goes until the work has taken it, so that it can be put back."""
    return work.with_name(f"{work.stem}.old-{place.name}")


def keep_from_clearing(delivery: Path) -> None:
    """Let a delivery that is about to stand aside count as just made.

    It may be older than what counts as left behind, and another machine would clear it, or put it back, at once.
    """
    with suppress(OSError):  # a colleague's folder keeps its time, and may still be replaced
        os.utime(delivery)


def clear_left_behind(parent: Path) -> None:
    """Remove what killed runs have left in a folder; a delivery that stood aside returns to where nothing is now."""
    try:
        entries = list(parent.iterdir())
    except OSError:
        return  # whoever writes there says why not
    for entry in entries:
        found = _NAME.fullmatch(entry.name)
        if found is None or not entry.is_dir() or _is_at_work(entry, found):
            continue
        place = parent / found["what"].removeprefix(".old-")
        if found["what"] != ".part" and not os.path.lexists(place):
            with suppress(OSError):
                entry.rename(place)
                continue
        shutil.rmtree(entry, ignore_errors=True)


def _is_at_work(folder: Path, name: re.Match[str]) -> bool:
    """Whether the process that made a folder may still be at it."""
    pid = int(name["pid"])
    if name["host"] != _host() or os.name == "nt":  # Windows would end a process that is asked
        with suppress(OSError):
            return time.time() - folder.stat().st_mtime < _STALE_SECONDS[name["what"].partition("-")[0]]
        return False
    if pid == os.getpid():
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True  # someone else's
    return True


def _host() -> str:
    """This machine in eight digits: a disk may be shared with others."""
    return hashlib.sha256(socket.gethostname().encode()).hexdigest()[:8]
