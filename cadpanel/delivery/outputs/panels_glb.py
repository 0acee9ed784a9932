"""panels.glb: every panel as a coloured mesh under its name, for viewers, browsers and renderers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

GLB = "panels.glb"
SAME_COLOUR = 1e-6
"""By which a part of a colour in 0 to 1 may differ."""


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

        from cadpanel.delivery.meshes.colours import colours_of
        from cadpanel.delivery.meshes.glb import linear, read_glb
        from cadpanel.delivery.meshes.proof import prove_meshes

        found = read_glb(folder / GLB)
        proof = prove_meshes(GLB, found, contents, np.zeros(3))
        wanted = [linear(colour) for colour in colours_of(contents.records, contents.shop.mesh_colours)]
        if proof.failures or np.allclose([mesh.paint for mesh in found], wanted, rtol=0.0, atol=SAME_COLOUR):
            return proof
        fault = f"'{GLB}': its colours do not tell what the report says that they tell, {contents.shop.mesh_colours}."
        return replace(proof, failures=(fault,))
