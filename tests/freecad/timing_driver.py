"""Runs inside FreeCAD: opens one file as a user does, and tells how long that took and how many objects it gave."""

import os
import time
from typing import Any


def answer() -> dict[str, Any]:
    """Seconds by the clock and of the processor, with FreeCAD's preferences as they are."""
    import FreeCAD

    path = os.environ["CADPANEL_FILE"]
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
    return {
        "seconds": time.perf_counter() - began,
        "processor": time.process_time() - busy,
        "objects": len(FreeCAD.ActiveDocument.Objects),
    }
