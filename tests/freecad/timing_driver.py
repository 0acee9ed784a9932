"""Runs inside FreeCAD: open one file as a user does, and write how long that took and how many objects it gave."""

import json
import os
import time
import traceback
from pathlib import Path
from typing import Any


def answer() -> None:
    """Open the file that the environment names, with FreeCAD's preferences as they are, and leave at once."""
    import FreeCAD

    path = os.environ["CADPANEL_FILE"]
    try:
        began, busy = time.perf_counter(), time.process_time()
        if path.endswith(".FCStd"):
            FreeCAD.openDocument(path)
        elif FreeCAD.GuiUp:
            import ImportGui

            ImportGui.open(path)
        else:
            import Import

            Import.insert(path, FreeCAD.newDocument("imported").Name, merge=False)
        if FreeCAD.GuiUp:
            import FreeCADGui

            FreeCADGui.updateGui()
        found: dict[str, Any] = {
            "seconds": time.perf_counter() - began,
            "processor": time.process_time() - busy,
            "objects": len(FreeCAD.ActiveDocument.Objects),
        }
    except Exception:  # noqa: BLE001 - FreeCAD would swallow it
        found = {"error": traceback.format_exc()}
    Path(os.environ["CADPANEL_ANSWER_FILE"]).write_text(json.dumps(found), encoding="utf-8")
    os._exit(0)


def main() -> None:
    """Now, or when the window stands."""
    import FreeCAD

    if not FreeCAD.GuiUp:
        answer()
    try:
        from PySide import QtCore
    except ImportError:
        from PySide2 import QtCore
    QtCore.QTimer.singleShot(500, answer)


main()
