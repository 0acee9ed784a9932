"""IFC as ifcopenshell's validator and geometry kernel see it: no fault, every plate with its volume and its numbers."""

from __future__ import annotations

from pathlib import Path

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.validate
import numpy as np
import pytest

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.meshes.ifc import read_ifc
from cadpanel.delivery.outputs.panels_ifc import IFC
from cadpanel.delivery.part_data import part_number
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import DeliveryError
from cadpanel.geometry.triangles import Triangles
from tests.delivered import fitted

SHOP = ShopSettings(outputs="ifc", mesh_chord=2.0, material="Tombak", author="Ö. N.", organization="O")


@pytest.fixture(scope="module")
def delivery(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ReportModel]:
    out = tmp_path_factory.mktemp("ifc") / "out"
    return out, deliver(fitted(), out, shop=SHOP)


def test_the_validator_finds_no_fault(delivery: tuple[Path, ReportModel]) -> None:
    faults = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(ifcopenshell.open(delivery[0] / IFC), faults)
    assert faults.statements == []


def test_plates_hang_in_a_curtain_wall_and_have_shape_material_and_numbers(delivery: tuple[Path, ReportModel]) -> None:
    out, report = delivery
    file = ifcopenshell.open(out / IFC)
    (wall,) = file.by_type("IfcCurtainWall")
    plates = [part for relation in wall.IsDecomposedBy for part in relation.RelatedObjects]
    assert [plate.Name for plate in plates] == [panel.name for panel in report.panels]
    assert file.header.file_name.author == ("Ö. N.",)
    settings = ifcopenshell.geom.settings()
    for plate, panel in zip(plates, report.panels, strict=True):
        shape = ifcopenshell.geom.create_shape(settings, plate).geometry
        points = np.reshape(shape.verts, (-1, 3)) * 1000.0
        corners = np.reshape(shape.faces, (-1, 3))
        volume = Triangles(points=points, normals=points, corners=corners).volume()
        assert volume == pytest.approx(panel.volume, rel=0.05)
        assert plate.Tag == part_number("arrays", panel.name)
        (material,) = [one.RelatingMaterial for one in plate.HasAssociations]
        assert material.Name == "Tombak"
        sets = {one.RelatingPropertyDefinition.Name: one.RelatingPropertyDefinition for one in plate.IsDefinedBy}
        numbers = {one.Name: one[3] for one in sets["Qto_PlateBaseQuantities"].Quantities}
        assert panel.blank is not None
        assert numbers["NetArea"] == pytest.approx(panel.blank.area * 1e-6)
        assert numbers["NetVolume"] == pytest.approx(panel.volume * 1e-9)
        assert numbers["NetWeight"] == panel.mass
    for plate in read_ifc(out / IFC):
        assert plate.properties["Feature"] == "plane-cone-plane"
        assert plate.properties["Material"] == "Tombak"


def test_the_same_delivery_gives_the_same_bytes_and_panels_keep_their_identity(
    delivery: tuple[Path, ReportModel], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    shop = ShopSettings(outputs="ifc", mesh_chord=2.0, only=("N 2",))
    texts = []
    for name in ("one", "two"):
        deliver(fitted(), tmp_path / name, shop=shop)
        texts.append((tmp_path / name / IFC).read_bytes())
    assert texts[0] == texts[1]
    assert b"'2023-11-14T22:13:20+00:00'" in texts[0]
    identities = [
        {plate.Name: plate.GlobalId for plate in ifcopenshell.open(path / IFC).by_type("IfcPlate")}
        for path in (delivery[0], tmp_path / "one")
    ]
    assert identities[1]["N 2"] == identities[0]["N 2"]
    assert len(set(identities[0].values())) == 3


def test_what_is_not_the_reports_is_told(delivery: tuple[Path, ReportModel]) -> None:
    out, report = delivery
    path = out / IFC
    text = path.read_text(encoding="utf-8")
    assert report.certificate.outputs["ifc"]["panels"] == 3
    assert verify(out).holds
    mass = next(line for line in text.splitlines() if "'Mass',$,IFCMASSMEASURE(" in line)
    try:
        path.write_text(text.replace(mass, mass.replace("MEASURE(", "MEASURE(1")), encoding="utf-8")
        failures = verify(out).failures
        path.write_text(text.replace("'N 2'", "'N 7'"), encoding="utf-8")
        renamed = verify(out).failures
        for damage in ("", text[:2000]):
            path.write_text(damage, encoding="utf-8")
            with pytest.raises(DeliveryError, match=r"panels\.ifc' cannot be read: it is no whole IFC file"):
                verify(out)
    finally:
        path.write_text(text, encoding="utf-8")
    assert failures[1:] == ("'panels.ifc': the properties of panel 'N 1' are not those of the report.",)
    assert renamed[1:] == ("'panels.ifc' does not hold the panels of the report, each once and in their order.",)
