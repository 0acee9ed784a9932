"""Where FreeCAD begins when it has a window: makes the workbench known."""

from __future__ import annotations

import FreeCADGui

from .commands import COMMANDS, ICON, register


class CadpanelWorkbench(FreeCADGui.Workbench):  # type: ignore[misc] # it is known inside FreeCAD only
    """The workbench cadpanel."""

    MenuText = "cadpanel"
    ToolTip = "Deliveries of cadpanel: open, colour, find, check, fit"
    Icon = ICON

    def Initialize(self) -> None:  # noqa: N802 - FreeCAD's name
        """Fill its toolbar and its menu."""
        self.appendToolbar("cadpanel", list(COMMANDS))
        self.appendMenu("cadpanel", list(COMMANDS))

    def GetClassName(self) -> str:  # noqa: N802
        """What kind of workbench it is."""
        return "Gui::PythonWorkbench"


register()
FreeCADGui.addWorkbench(CadpanelWorkbench())
