"""panels.FCStd: a document that FreeCAD opens, with a tree, numbers and colours, seams and flat patterns."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

DOCUMENT = "panels.FCStd"


class FreecadDocument(Output):
    """The panels as FreeCAD shows them."""

    name = "freecad"
    files = (DOCUMENT,)
    tells_joints = True

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.document.archive import archive_bytes
        from cadpanel.delivery.document.shapes import shape_files

        try:
            (folder / DOCUMENT).write_bytes(archive_bytes(delivery, shape_files(delivery, delivery.panels)))
        except OSError as error:
            raise DeliveryError(f"'{folder / DOCUMENT}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Numbers and looks are those of the report, shapes have its volumes, areas and corners."""
        from cadpanel.delivery.document.proof import prove_document

        return prove_document(folder / DOCUMENT, contents)
