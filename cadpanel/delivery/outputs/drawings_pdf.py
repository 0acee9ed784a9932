"""drawings.pdf: an overview and a page a panel; it needs reportlab, matplotlib's fonts, and pypdf to read it back."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

DRAWINGS = "drawings.pdf"


class DrawingsPdf(Output):
    """Flat patterns with dimensions, folded views and tables of bends, on paper."""

    name = "pdf"
    files = (DRAWINGS,)
    unasked = False
    needs = ("reportlab", "pypdf", "matplotlib")

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.pages.document import pdf_bytes
        from cadpanel.delivery.source_date import source_date

        try:
            (folder / DRAWINGS).write_bytes(pdf_bytes(delivery, delivery.panels, source_date()))
        except OSError as error:
            raise DeliveryError(f"'{folder / DRAWINGS}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Read back, every panel must have its page with its name and its numbers."""
        from cadpanel.delivery.pages.proof import prove_pages

        return prove_pages(folder / DRAWINGS, contents)
