"""The panels of a delivery as meshes, with their colours and what is told of them."""

from __future__ import annotations

from collections.abc import Sequence

from cadpanel.brep.building.meshing import triangles_of
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.meshes.colours import colours_of
from cadpanel.delivery.meshes.glb import MeshedPanel
from cadpanel.delivery.sheets import PanelSheet


def meshed_panels(contents: Contents, sheets: Sequence[PanelSheet]) -> list[MeshedPanel]:
    """One mesh a panel, of its sheet as it was built, within the chord that the settings say."""
    records, shop = contents.records, contents.shop
    colours = colours_of(records, shop.mesh_colours)
    return [
        MeshedPanel(
            name=record.name,
            mesh=triangles_of(built.solid, shop.mesh_chord),
            colour=colour,
            said={
                "feature": record.feature,
                "thickness": contents.sheet.thickness,
                "max_deviation": record.max_deviation,
                "rms_deviation": record.rms_deviation,
            },
        )
        for record, built, colour in zip(records, sheets, colours, strict=True)
    ]
