"""Kills at random moments of a replacement: the old delivery or the new one is there, whole, and nobody works on.

Every other time a whole delivery is made, with its second interpreter; in between, folders are exchanged as fast as
that goes, as the exchange itself takes but a moment.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import cadpanel as cp
from cadpanel.brep.isolation import client
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.manifest import changed_files
from tests.attack.made import plain_delivery, strip_result

GONE_WITHIN = 2.0
"""Seconds within which nothing may run any more that a killed process has started."""
WHOLE = 4.0
"""Seconds within which a whole delivery is made, about."""


class Killed(NamedTuple):
    """What one kill left.

    Attributes:
        end: "whole", or in capitals what is not.
        gone: seconds until nothing ran any more.
        litter: names beside the delivery, which the next run has to clear.
        left: names that were left after the next run.
    """

    end: str
    gone: float
    litter: int
    left: list[str]


class Killer:
    """Replaces a delivery, and kills what does."""

    def __init__(self, made: Path) -> None:
        """Make what is replaced, and load everything."""
        self._result = strip_result(made)
        self._whole = plain_delivery(made)
        client.stop_reader()  # every process starts its own

    def kill(self, seed: int, *, whole: bool) -> Killed:
        """Kill one replacement at a moment that the seed chooses."""
        chance = random.Random(seed)
        with tempfile.TemporaryDirectory(prefix="kill-") as name:
            parent = Path(name) / "parent"
            target, temporary = parent / "out", Path(name) / "tmp"
            parent.mkdir()
            temporary.mkdir()
            shutil.copytree(self._whole, target)
            process = self._replacing(target, temporary, whole=whole)
            end = "whole"
            until = time.monotonic() + (chance.random() * WHOLE if whole else 0.02 + 0.3 * chance.random())
            while time.monotonic() < until:
                if not target.is_dir():
                    end = "MISSING"
                time.sleep(0.0005)
            os.kill(process, signal.SIGKILL)
            began = time.monotonic()
            os.waitpid(process, 0)
            while _of_session(process) and time.monotonic() - began < 10.0:
                time.sleep(0.01)
            gone = time.monotonic() - began
            if end == "whole":
                end = _state(target)
            litter = len(list(parent.iterdir())) - 1
            with delivery_folder(target, overwrite=True) as folder:
                shutil.copytree(self._whole, folder, dirs_exist_ok=True)
            left = sorted(one.name for one in parent.iterdir() if one != target)
            left += sorted(one.name for one in temporary.iterdir())
            return Killed(end, gone, litter, left)

    def _replacing(self, target: Path, temporary: Path, *, whole: bool) -> int:
        """A process in a session of its own that replaces the target."""
        process = os.fork()
        if process:
            return process
        try:
            os.setsid()
            tempfile.tempdir = str(temporary)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            while True:
                if whole:
                    cp.deliver(self._result, target, outputs="step", overwrite=True)
                else:
                    with delivery_folder(target, overwrite=True) as folder:
                        shutil.copytree(self._whole, folder, dirs_exist_ok=True)
        finally:
            sys.stderr.flush()
            os._exit(1)


def _state(target: Path) -> str:
    if not target.is_dir():
        return "MISSING"
    changed = changed_files(target)
    return f"NOT WHOLE: {changed}" if changed else "whole"


def _of_session(session: int) -> list[int]:
    """The processes of a session that still run."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdecimal():
            continue
        try:
            state, _, _, own = (entry / "stat").read_text().rpartition(")")[2].split()[:4]
        except OSError:
            continue  # it has ended meanwhile
        if int(own) == session and state not in "ZX":
            found.append(int(entry.name))
    return found
