"""panels.glb: every panel as a coloured mesh under its name, for viewers, browsers and renderers."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

GLB = "panels.glb"


class PanelsGlb(Output):
    """The solids as meshes."""

    name = "glb"
    files = (GLB,)

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.meshes.glb import glb_bytes
        from cadpanel.delivery.meshes.panels import meshed_panels

        said = {"origin": list(delivery.origin), "length": "mm"}
        try:
            (folder / GLB).write_bytes(glb_bytes(meshed_panels(delivery, delivery.panels), delivery.title, said))
        except OSError as error:
            raise DeliveryError(f"'{folder / GLB}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Read back, its meshes must be the panels, closed, with their volumes and corners."""
        import numpy as np

        from cadpanel.delivery.meshes.glb import read_glb
        from cadpanel.delivery.meshes.proof import prove_meshes

        return prove_meshes(GLB, read_glb(folder / GLB), contents, np.zeros(3))
