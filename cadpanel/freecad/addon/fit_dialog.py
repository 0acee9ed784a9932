"""The window that asks for a fit, shows how far it is, and opens what comes of it."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Callable

import FreeCAD
import FreeCADGui

from .documents import DOCUMENT, DeliveryMissing, folder_of, panels_of, report_of
from .fits import arguments_of, options_of, quoted, reference_near, rules_of, wanted_features, write_faces, write_rules
from .qt import QtCore, QtGui
from .runs import CadpanelMissing, Run

_EVERY_MS = 200
"""So often the program is looked at."""
_HELD, _NOT_HELD = 0, 1


class FitDialog(QtGui.QDialog):  # type: ignore[misc] # Qt is known inside FreeCAD only
    """Asks, runs, shows, opens. `run` is the program while it runs; `ended` its exit code."""

    def __init__(self, document: Any, parent: Any = None) -> None:
        """Ask with what the delivery in a document says; with nothing where it is none."""
        super().__init__(parent)
        self.setWindowTitle("cadpanel: fit")
        self.run: Run | None = None
        self.ended: int | None = None
        self._document = document
        self._beside = tempfile.TemporaryDirectory(prefix="cadpanel-")  # deleted with the window
        self.reference, self.options, self.out = (QtGui.QLineEdit(self) for _ in range(3))
        self.message = QtGui.QLabel(self)
        self.message.setWordWrap(True)
        self.bar = QtGui.QProgressBar(self)
        self.bar.setRange(0, 1)
        self._lay_out()
        self._timer = QtCore.QTimer(self)
        self._timer.timeout.connect(self._look)
        self._fill()

    def choose_selected(self) -> None:
        """Take the faces that are chosen in the document as the reference."""
        chosen = [(one.Object, one.SubElementNames) for one in FreeCADGui.Selection.getSelectionEx()]
        path = str(Path(self._beside.name) / "chosen_faces.brep")
        try:
            count = write_faces(path, chosen)
        except DeliveryMissing as error:
            self.message.setText(str(error))
            return
        self.reference.setText(path)
        self.options.setText("--unit mm --divide 8")
        self.message.setText(f"{count} faces are the skin: say in the options how to cut it into panels.")

    def start(self) -> None:
        """Run cadpanel with what was asked for."""
        rules = None
        if self._rules():
            rules = str(Path(self._beside.name) / "rules.toml")
            write_rules(rules, self._rules())
        try:
            words = arguments_of(self.reference.text(), self.out.text(), self.options.text(), rules)
            self.run, self.ended = Run(words), None
        except (CadpanelMissing, ValueError) as error:
            self.message.setText(str(error))
            return
        self._running(True)
        self._timer.start(_EVERY_MS)

    def cancel(self) -> None:
        """End what runs, or close the window."""
        if self.run is None:
            self.close()
            return
        self._timer.stop()
        self.run.cancel()
        self._end("Cancelled; nothing was written.")

    def reject(self) -> None:
        """Esc and the window's own button end what runs, too."""
        if self.run is not None:
            self.cancel()
        super().reject()

    def _look(self) -> None:
        assert self.run is not None
        code = self.run.look()
        step, share = self.run.step, self.run.share
        if step:
            self.message.setText(" ".join((step["step"], step["detail"])).strip())
        self.bar.setRange(0, 0 if share is None else 1000)
        self.bar.setValue(round(1000 * (share or 0.0)))
        if code is None:
            return
        self._timer.stop()
        self.ended = code
        sentence = self.run.sentence
        self._end(sentence or "All tolerances are held.")
        document = Path(self.out.text()) / DOCUMENT
        if code in (_HELD, _NOT_HELD) and document.is_file():
            FreeCAD.openDocument(str(document))
            FreeCADGui.SendMsgToActiveView("ViewFit")

    def _end(self, sentence: str) -> None:
        self.run = None
        self.bar.setRange(0, 1)
        self._running(False)
        self.message.setText(sentence)

    def _running(self, yes: bool) -> None:
        self._start.setEnabled(not yes)
        for line in (self.reference, self.options, self.out):
            line.setEnabled(not yes)

    def _rules(self) -> dict[str, list[dict[str, Any]]]:
        """Those of the delivery and of its panels; none where the document is no delivery."""
        try:
            return rules_of(self._document, report_of(folder_of(self._document)))
        except DeliveryMissing:
            return {}

    def _fill(self) -> None:
        """What the delivery in the document was made with; a new folder beside it."""
        try:
            panels_of(self._document)
            folder = folder_of(self._document)
            report = report_of(folder)
            self.options.setText(quoted(options_of(report)))
        except DeliveryMissing:
            self.options.setText("--divide 8")
            return
        name = report["reference"]["file"]
        self.reference.setText(reference_near(folder, name) or name)
        number = 2
        while Path(f"{folder}-{number}").exists():
            number += 1
        self.out.setText(f"{folder}-{number}")
        changed = len(wanted_features(self._document))
        self.message.setText(f"{changed} panels want another feature." if changed else "")

    def _lay_out(self) -> None:
        form = QtGui.QFormLayout(self)
        form.addRow(
            "Reference", self._with(self.reference, ("File...", self._browse), ("Chosen faces", self.choose_selected))
        )
        form.addRow("Options", self.options)
        form.addRow("Folder to write", self._with(self.out, ("Folder...", self._browse_out)))
        form.addRow(self.message)
        form.addRow(self.bar)
        self._start = QtGui.QPushButton("Fit", self)
        self._start.clicked.connect(self.start)
        stop = QtGui.QPushButton("Cancel", self)
        stop.clicked.connect(self.cancel)
        form.addRow(self._start, stop)
        self.resize(640, self.sizeHint().height())

    def _with(self, line: Any, *buttons: tuple[str, Callable[[], None]]) -> Any:
        row = QtGui.QHBoxLayout()
        row.addWidget(line)
        for text, work in buttons:
            button = QtGui.QPushButton(text, self)
            button.clicked.connect(work)
            row.addWidget(button)
        return row

    def _browse(self) -> None:
        kinds = "Models (*.step *.stp *.iges *.igs *.brep *.brp *.3dm);;All files (*)"
        path = QtGui.QFileDialog.getOpenFileName(self, "Reference", self.reference.text(), kinds)[0]
        if path:
            self.reference.setText(path)

    def _browse_out(self) -> None:
        folder = QtGui.QFileDialog.getExistingDirectory(self, "Where to write", str(Path(self.out.text()).parent))
        if folder:
            self.out.setText(str(Path(folder) / "panels"))
