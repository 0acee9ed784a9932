"""The commands of the workbench, as FreeCAD's menus and buttons know them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui

from .checks import check
from .colors import BY, FEATURE, color_by
from .documents import DeliveryMissing, document_in, named, show_flats
from .fit_dialog import FitDialog
from .qt import QtGui

HERE = Path(__file__).parent
ICON = str(HERE / "cadpanel.svg")
_WAYS = (*BY, FEATURE)


def say(text: str, *, fault: bool = False) -> None:
    """Show a sentence, in a box where something is wrong, and in the report view."""
    console = FreeCAD.Console
    (console.PrintWarning if fault else console.PrintMessage)(f"cadpanel: {text}\n")
    FreeCADGui.getMainWindow().statusBar().showMessage(text)


class Command:
    """A command that needs a delivery, if not said otherwise; what it lacks is said in one sentence."""

    text, tip, icon = "", "", "cadpanel"
    needs_document = True

    def GetResources(self) -> dict[str, str]:  # noqa: N802 - FreeCAD's name
        """What FreeCAD shows of it."""
        return {"MenuText": self.text, "ToolTip": self.tip, "Pixmap": str(HERE / f"{self.icon}.svg")}

    def IsActive(self) -> bool:  # noqa: N802
        """Whether it can be chosen."""
        return not self.needs_document or FreeCAD.ActiveDocument is not None

    def Activated(self, _index: int = 0) -> None:  # noqa: N802
        """Do it."""
        try:
            self.work(FreeCAD.ActiveDocument)
        except DeliveryMissing as error:
            say(str(error), fault=True)
            QtGui.QMessageBox.warning(FreeCADGui.getMainWindow(), "cadpanel", str(error))

    def work(self, document: Any) -> None:
        """What it does.

        Raises:
            DeliveryMissing: there is no delivery.
        """
        raise NotImplementedError


class OpenDelivery(Command):
    """Opens the document in the folder of a delivery."""

    icon = "open"
    text, tip = "Open delivery...", "Open the folder that cadpanel wrote"
    needs_document = False

    def work(self, _document: Any) -> None:
        """See `Command.work`."""
        folder = QtGui.QFileDialog.getExistingDirectory(FreeCADGui.getMainWindow(), self.tip)
        if folder:
            open_delivery(folder)


def open_delivery(folder: str) -> Any:
    """Open the document of the delivery in a folder.

    Raises:
        DeliveryMissing: there is none.
    """
    document = FreeCAD.openDocument(document_in(folder))
    FreeCADGui.SendMsgToActiveView("ViewFit")
    return document


class ColorBy(Command):
    """Colours panels; one entry a way."""

    icon = "color"
    text, tip = "Colour by", "Colour panels by a number or by their feature"

    def GetCommands(self) -> list[str]:  # noqa: N802
        """The entries under its button."""
        return [f"Cadpanel_ColorBy_{what}" for what in _WAYS]

    def GetDefaultCommand(self) -> int:  # noqa: N802
        """The entry that the button shows at first."""
        return 0


class ColorByOne(Command):
    """Colours panels by one of their numbers."""

    icon = "color"

    def __init__(self, what: str) -> None:
        """By what."""
        self._what = what
        self.text, self.tip = f"Colour by {what}", f"Colour panels by {what}: dark for little, light for much"

    def work(self, document: Any) -> None:
        """See `Command.work`."""
        say(color_by(document, self._what))


class FlatPatterns(Command):
    """Shows flat patterns instead of panels, or panels again."""

    icon = "flat"
    text, tip = "Flat patterns", "Show the flat patterns instead of the panels, or the panels again"

    def work(self, document: Any) -> None:
        """See `Command.work`."""
        flat = show_flats(document)
        view = FreeCADGui.activeDocument().activeView()
        (view.viewTop if flat else view.viewIsometric)()
        view.fitAll()


class FindPanel(Command):
    """Chooses panels by name, and shows them."""

    icon = "find"
    text, tip = "Find panel...", "Choose panels by their name, with * for anything"

    def work(self, document: Any) -> None:
        """See `Command.work`."""
        pattern, asked = QtGui.QInputDialog.getText(FreeCADGui.getMainWindow(), "cadpanel", self.tip)
        if asked:
            find(document, pattern)


def find(document: Any, pattern: str) -> list[str]:
    """Choose the panels of a name and show them; their names.

    Raises:
        DeliveryMissing: there is none of that name.
    """
    found = named(document, pattern)
    if not found:
        raise DeliveryMissing(f"There is no panel '{pattern}' in this document: * stands for anything.")
    FreeCADGui.Selection.clearSelection()
    for panel in found:
        FreeCADGui.Selection.addSelection(panel)
    FreeCADGui.SendMsgToActiveView("ViewSelection")
    return [panel.PanelName for panel in found]


class CheckDelivery(Command):
    """Holds the document against its delivery."""

    icon = "check"
    text, tip = "Check against delivery", "What was moved, changed, lost or added since the delivery was written"

    def work(self, document: Any) -> None:
        """See `Command.work`."""
        faults = check(document)
        text = "\n".join(faults) or "All panels are as they were delivered."
        say(text, fault=bool(faults))
        QtGui.QMessageBox.information(FreeCADGui.getMainWindow(), "cadpanel", text)


class Fit(Command):
    """Asks for a fit and runs it."""

    icon = "fit"
    text, tip = "Fit...", "Fit panels to a reference, or the panels of this delivery again with other features"
    needs_document = False
    dialog: Any | None = None

    def work(self, document: Any) -> None:
        """See `Command.work`."""
        Fit.dialog = FitDialog(document, FreeCADGui.getMainWindow())
        Fit.dialog.show()


COMMANDS: dict[str, Command] = {
    "Cadpanel_OpenDelivery": OpenDelivery(),
    "Cadpanel_Fit": Fit(),
    "Cadpanel_ColorBy": ColorBy(),
    "Cadpanel_FlatPatterns": FlatPatterns(),
    "Cadpanel_FindPanel": FindPanel(),
    "Cadpanel_CheckDelivery": CheckDelivery(),
}
"""What the workbench shows, in this order."""


def register() -> None:
    """Make them known to FreeCAD."""
    for what in _WAYS:
        FreeCADGui.addCommand(f"Cadpanel_ColorBy_{what}", ColorByOne(what))
    for name, command in COMMANDS.items():
        FreeCADGui.addCommand(name, command)
