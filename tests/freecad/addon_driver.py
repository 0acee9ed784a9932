"""Runs inside FreeCAD's window, with the add-on in its folder of add-ons: every command once, as a user does.

What users choose in a window of the system is given; all else goes through the commands themselves.
"""

import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

SECONDS = 90.0


def wait(done: Callable[[], bool]) -> None:
    """Let FreeCAD work until something is done."""
    from freecad.cadpanel_workbench.qt import QtGui

    began = time.perf_counter()
    while not done():
        if time.perf_counter() - began > SECONDS:
            raise TimeoutError("nothing came of it")
        QtGui.QApplication.processEvents()
        time.sleep(0.05)


def colors(document: Any) -> "list[tuple[float, ...]]":
    """Those of the panels."""
    return [one.ViewObject.ShapeColor[:3] for one in document.Objects if "WantedFeature" in one.PropertiesList]


def commands(folder: str) -> "dict[str, Any]":
    """Open, colour, flat patterns, find, check."""
    import FreeCADGui
    from freecad.cadpanel_workbench import checks, documents
    from freecad.cadpanel_workbench import colors as coloring
    from freecad.cadpanel_workbench import commands as own

    found: dict[str, Any] = {"workbench": "CadpanelWorkbench" in FreeCADGui.listWorkbenches()}
    FreeCADGui.activateWorkbench("CadpanelWorkbench")
    known = FreeCADGui.listCommands()
    found["unknown"] = [name for name in own.COMMANDS if name not in known]
    document = own.open_delivery(folder)
    found["panels"] = [panel.PanelName for panel in documents.panels_of(document)]
    found["delivered"] = colors(document)
    found["legends"] = {way: coloring.color_by(document, way) for way in own._WAYS}
    FreeCADGui.runCommand("Cadpanel_ColorBy_deviation")
    found["by deviation"] = colors(document)
    FreeCADGui.runCommand("Cadpanel_ColorBy_feature")
    found["by feature"] = colors(document)
    shown = []
    for _ in range(2):
        FreeCADGui.runCommand("Cadpanel_FlatPatterns")
        shown.append(sorted(one.Label for one in document.Objects if one.TypeId == "Part::Feature" and one.Visibility))
    found["shown"] = shown
    found["found"] = own.find(document, "n*2")
    found["chosen"] = [one.Label for one in FreeCADGui.Selection.getSelection()]
    found["faults"] = [checks.check(document)]
    first, second = documents.panels_of(document)[:2]
    first.Placement.Base.x = 7.0
    second.Shape = second.Shape.copy().scale(1.5)
    document.removeObject(documents.panels_of(document)[2].Name)
    found["faults"].append(checks.check(document))
    return found


def chosen_faces() -> "dict[str, Any]":
    """Choose a skin that was moved, and one face of another one, as the reference of a fit."""
    import FreeCAD
    import FreeCADGui
    from freecad.cadpanel_workbench.fit_dialog import FitDialog

    document = FreeCAD.ActiveDocument
    FreeCADGui.Selection.clearSelection()
    dialog = FitDialog(document)
    dialog.choose_selected()
    found: dict[str, Any] = {"nothing": dialog.message.text()}
    first, second = document.getObject("Skin1"), document.getObject("Skin2")
    first.Placement.Base.z = 500.0
    FreeCADGui.Selection.addSelection(first)
    FreeCADGui.Selection.addSelection(second, "Face2")
    dialog.choose_selected()
    shutil.copy(dialog.reference.text(), os.environ["CADPANEL_FACES"])
    found |= {"message": dialog.message.text(), "options": dialog.options.text()}
    found["areas"] = [face.Area for face in (*first.Shape.Faces, second.Shape.Faces[1])]
    found["heights"] = [first.Shape.BoundBox.ZMin, second.Shape.Faces[1].BoundBox.ZMin]
    return found


def refit(folder: str) -> "dict[str, Any]":
    """Fit once and cancel, fit again, and look at what was opened; then a fit that is refused."""
    import FreeCAD
    from freecad.cadpanel_workbench import documents
    from freecad.cadpanel_workbench.fit_dialog import FitDialog

    document = FreeCAD.openDocument(documents.document_in(folder))
    documents.panels_of(document)[1].WantedFeature = "plane-cylinder-plane"
    dialog = FitDialog(document)
    found: dict[str, Any] = {
        "asked": dialog.message.text(),
        "reference": dialog.reference.text(),
        "options": dialog.options.text(),
        "out": dialog.out.text(),
    }
    out = dialog.out.text()
    messages: list[str] = []
    dialog.start()
    wait(lambda: bool(dialog.run.step))
    dialog.cancel()
    found["cancelled"] = [dialog.message.text(), Path(out).exists()]
    dialog.start()
    run = dialog.run

    def ended() -> bool:
        messages.append(dialog.message.text())
        return dialog.ended is not None

    wait(ended)
    found |= {"steps": run.steps, "messages": messages, "code": dialog.ended, "message": dialog.message.text()}
    opened = FreeCAD.ActiveDocument
    found["opened"] = [opened.FileName, [panel.PanelName for panel in documents.panels_of(opened)]]
    found["features"] = [panel.Feature for panel in documents.panels_of(opened)]
    dialog.start()  # the folder is taken now
    wait(lambda: dialog.run is None)
    found["refused"] = [dialog.ended, dialog.message.text()]
    return found


def answer() -> "dict[str, Any]":
    """All of it."""
    import FreeCAD

    folder = os.environ["CADPANEL_DELIVERY"]
    found = commands(folder)
    found["faces"] = chosen_faces()
    FreeCAD.closeDocument(FreeCAD.ActiveDocument.Name)
    found["fit"] = refit(folder)
    return found
