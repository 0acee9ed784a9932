"""Runs inside FreeCAD: asks a driver of this folder for its answer and writes it as JSON, then leaves at once.

FreeCAD runs scripts before its window stands, swallows what they raise, and waits for commands after them: this file
knows it, so that drivers need not. The environment says which driver, and where the answer goes.
"""

import json
import os
import runpy
import traceback
from pathlib import Path
from typing import Any

MILLISECONDS = 500
"""After FreeCAD begins to wait for users: its window stands then."""


def leave_an_answer() -> None:
    """What the driver's function `answer` returns, or why it could not."""
    try:
        found: dict[str, Any] = runpy.run_path(os.environ["CADPANEL_DRIVER"])["answer"]()
    except Exception:  # noqa: BLE001 - FreeCAD would swallow it; the test shall see it
        found = {"error": traceback.format_exc()}
    Path(os.environ["CADPANEL_ANSWER_FILE"]).write_text(json.dumps(found), encoding="utf-8")
    os._exit(0)


def main() -> None:
    """Now, or when the window stands."""
    import FreeCAD

    if not FreeCAD.GuiUp:
        leave_an_answer()
    try:
        from PySide import QtCore
    except ImportError:
        from PySide2 import QtCore
    QtCore.QTimer.singleShot(MILLISECONDS, leave_an_answer)


main()
