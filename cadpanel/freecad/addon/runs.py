"""cadpanel run as a program of its own, in the Python that the add-on was installed from: progress, end, cancel."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Sequence

INTERPRETER = "interpreter.json"
"""Beside this file: which Python has cadpanel, as `cadpanel freecad install` wrote it."""
# What FreeCAD sets for its own Python and libraries, which another one must not find.
_NOT_OURS = ("PYTHON", "LD_LIBRARY_PATH", "LD_PRELOAD", "QT_", "CONDA", "APPDIR", "APPIMAGE")


class CadpanelMissing(Exception):
    """The Python that has cadpanel is not there any more; one sentence says what to do."""


def interpreter() -> str:
    """The Python that has cadpanel.

    Raises:
        CadpanelMissing: nobody knows it, or it is gone.
    """
    path = Path(__file__).with_name(INTERPRETER)
    try:
        found = str(json.loads(path.read_text(encoding="utf-8"))["python"])
    except (OSError, ValueError, KeyError) as error:
        raise CadpanelMissing(f"'{path}' does not say where cadpanel is: run 'cadpanel freecad install'.") from error
    if not Path(found).is_file():
        raise CadpanelMissing(f"'{found}', which had cadpanel, is gone: run 'cadpanel freecad install' again.")
    return found


class Run:
    """A running cadpanel. Whoever started it looks at it from time to time; nothing waits."""

    def __init__(self, arguments: Sequence[str]) -> None:
        """Start it with the words that follow `cadpanel` on a command line.

        Raises:
            CadpanelMissing: it is not there.
        """
        self._said = tempfile.TemporaryFile()  # noqa: SIM115 - it lives as long as the program
        self._read = 0
        self._rest = b""
        self._sentences: list[str] = []
        self.step: dict[str, Any] = {}
        self.steps: list[str] = []
        """Names of the steps so far, each once, in their order: whoever looks rarely does not see every `step`."""
        # A console of its own would flash up on Windows.
        flags = getattr(subprocess, "CREATE_NO_WINDOW", 0) if sys.platform == "win32" else 0
        self._process = subprocess.Popen(
            [interpreter(), "-m", "cadpanel.cli.main", *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=self._said,
            env={name: value for name, value in os.environ.items() if not name.startswith(_NOT_OURS)},
            creationflags=flags,
        )

    def look(self) -> int | None:
        """Read what it has said since; its exit code, None while it runs."""
        code = self._process.poll()
        self._said.seek(self._read)
        new = self._said.read()
        self._read += len(new)
        lines = (self._rest + new).split(b"\n")
        self._rest = b"" if code is not None else lines.pop()
        for line in lines:
            self._hear(line.decode("utf-8", errors="replace").strip())
        return code

    @property
    def sentence(self) -> str:
        """What it said besides its steps: why it refused, or what is not held."""
        return " ".join(self._sentences)

    @property
    def share(self) -> float | None:
        """How much of the step is done, 0 to 1; None where nobody can tell."""
        of = self.step.get("of") or 0
        return self.step["done"] / of if of > 1 else None

    def cancel(self) -> None:
        """End it; it leaves nothing behind."""
        if self._process.poll() is None:
            self._process.terminate()
            self._process.wait()

    def _hear(self, line: str) -> None:
        if line.startswith('{"step"'):
            self.step = json.loads(line)
            if self.step["step"] not in self.steps:
                self.steps.append(self.step["step"])
        elif line:
            self._sentences.append(line)
