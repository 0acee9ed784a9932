"""Everything that can be said of a part in a STEP file."""

from __future__ import annotations

from cadpanel.brep.step.properties import ATTRIBUTES, Material, PartData, Validation

ALL_ATTRIBUTES = {name: "a text" if measure == "text" else 2.5 for name, measure in ATTRIBUTES.items()}
SAID = PartData(
    number="roof/A-01",
    description="plane-cone-plane, 3 mm",
    validation=Validation(area=1.5, volume=2.5, centroid=(1.0, 2.0, 3.0)),
    material=Material(name="AlMg3", density=2660.0),
    attributes=ALL_ATTRIBUTES,
)
