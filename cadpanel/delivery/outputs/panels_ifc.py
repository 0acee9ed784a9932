"""panels.ifc: the panels as plates of a curtain wall, for building models; it needs ifcopenshell."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

IFC = "panels.ifc"


class PanelsIfc(Output):
    """The solids as IFC4."""

    name = "ifc"
    files = (IFC,)
    unasked = False
    needs = ("ifcopenshell",)

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.meshes.ifc import IfcHeader, IfcPanel, ifc_text
        from cadpanel.delivery.meshes.panels import meshed_panels
        from cadpanel.delivery.part_data import solid_data
        from cadpanel.delivery.source_date import source_date

        shop = delivery.shop
        meshes = meshed_panels(delivery, delivery.panels)
        panels = [
            IfcPanel(mesh=mesh, data=data, blank_area=part.size.area)
            for mesh, data, part in zip(meshes, solid_data(delivery), delivery.parts, strict=True)
            if data is not None
        ]
        header = IfcHeader(
            title=delivery.title,
            date=source_date(),
            author=shop.author,
            organization=shop.organization,
            placed=delivery.placed,
            origin=delivery.origin,
        )
        try:
            (folder / IFC).write_text(ifc_text(panels, header), encoding="utf-8", newline="\n")
        except OSError as error:
            raise DeliveryError(f"'{folder / IFC}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Read back, its plates must be the panels, closed, with their volumes, corners and properties."""
        import numpy as np

        from cadpanel.delivery.meshes.ifc import property_name, read_ifc
        from cadpanel.delivery.meshes.proof import prove_meshes
        from cadpanel.delivery.part_data import solid_data

        found = read_ifc(folder / IFC)
        proof = prove_meshes(IFC, found, contents, np.array(contents.placed))
        if len(found) != len(contents.records):
            return proof
        wanted = [{} if data is None else data.attributes for data in solid_data(contents)]
        wrong = tuple(
            f"'{IFC}': the properties of panel '{plate.name}' are not those of the report."
            for plate, attributes in zip(found, wanted, strict=True)
            if plate.properties != {property_name(name): value for name, value in attributes.items()}
        )
        return Proof(numbers=proof.numbers, failures=(*proof.failures, *wrong))
