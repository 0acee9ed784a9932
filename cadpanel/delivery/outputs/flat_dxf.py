"""The flat pattern of every panel as DXF, one drawing a panel, and one with all parts in rows."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

FLAT = "flat"
"""The folder of drawings."""
ENDING = ".dxf"


class FlatDxf(Output):
    """Flat patterns."""

    name = "flats"
    files = ()
    # As cadpanel.delivery.drawing.dxf begins them; that module loads NumPy, and a refusal asks for names only.
    folders = MappingProxyType({FLAT: b"999\r\ncadpanel\r\n"})

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.drawing.dxf import dxf_bytes, frame_of
        from cadpanel.delivery.drawing.redrawn import digest_of, drawings_of

        frame, entities = frame_of(delivery.shop), delivery.shop.dxf_entities
        place = folder / FLAT
        try:
            place.mkdir()
            for name, drawing in drawings_of(delivery).items():
                text = dxf_bytes(drawing, frame, entities)
                delivery.drawn[name] = digest_of(text)
                (place / f"{name}{ENDING}").write_bytes(text)
        except OSError as error:
            raise DeliveryError(f"'{place}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Every drawing is read back: contour, bends, and all of it by ezdxf's own audit."""
        from cadpanel.delivery.drawing.proof import prove_drawings

        return prove_drawings(folder / FLAT, contents)
