"""How a second interpreter is started: with this one's own modules, whatever lies in the folder that it stands in."""

from __future__ import annotations

import sys
from pathlib import Path

from cadpanel.brep.isolation.begin import begin


def interpreter(module: str) -> list[str]:
    """The command that runs the function `main` of a module of this package.

    A plain interpreter, not multiprocessing: that would run the caller's own script again to get started. And not `-m`,
    which puts the current folder first: a file `random.py` there would be run.
    """
    paths = [str(Path(path).absolute()) for path in sys.path if path]
    text = f"import sys; sys.path[:] = {paths!r}; from {begin.__module__} import begin; begin({module!r})"
    return [sys.executable, "-P", "-c", text]
