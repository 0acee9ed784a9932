"""glTF as another program reads it: names, places, sizes; and what is damaged or false is told."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from OCP.gp import gp_Pnt
from OCP.Message import Message_ProgressRange
from OCP.RWGltf import RWGltf_CafReader
from OCP.RWMesh import RWMesh_CoordinateSystem_Zup
from OCP.TCollection import TCollection_AsciiString

from cadpanel.brep.files.xcaf import new_document, products_of
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.meshes.colours import LEAST, MOST, by_deviation, by_feature
from cadpanel.delivery.meshes.glb import MeshedPanel, glb_bytes, read_glb
from cadpanel.delivery.outputs.panels_glb import GLB
from cadpanel.delivery.records.report import ReportModel
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import DeliveryError, SettingsError
from cadpanel.geometry.triangles import Triangles
from tests.delivered import fitted

TETRAHEDRON = Triangles(
    points=np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) * 1000.0 + 8.0e8,
    normals=np.eye(4)[:, :3],
    corners=np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)


@pytest.fixture(scope="module")
def delivery(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ReportModel]:
    out = tmp_path_factory.mktemp("glb") / "out"
    return out, deliver(fitted(), out, shop=ShopSettings(outputs="glb", mesh_chord=0.5, mesh_colours="deviation"))


def test_the_kernels_reader_finds_every_panel_by_name_where_it_is(delivery: tuple[Path, ReportModel]) -> None:
    out, report = delivery
    silence_kernel()
    reader, document = RWGltf_CafReader(), new_document()
    reader.SetDocument(document)
    reader.SetSystemLengthUnit(0.001)
    reader.SetSystemCoordinateSystem(RWMesh_CoordinateSystem_Zup)
    assert reader.Perform(TCollection_AsciiString(str(out / GLB)), Message_ProgressRange())
    found = dict(products_of(document))
    assert list(found) == [panel.name for panel in report.panels]
    for panel in report.panels:
        points = []
        for face in faces_of(found[panel.name]):
            mesh = face.TShape().ActiveTriangulation()
            at = face.Location().Transformation()
            points += [gp_Pnt(*mesh.Node(i + 1).Coord()).Transformed(at).Coord() for i in range(mesh.NbNodes())]
        corners = np.reshape(panel.corners, (-1, 3))
        apart = np.linalg.norm(np.array(points)[:, None] - corners, axis=-1).min(axis=0)
        assert apart.max() < 2e-3  # single precision of metres


def test_a_panel_far_away_keeps_its_digits(tmp_path: Path) -> None:
    panel = MeshedPanel(name="Süd", mesh=TETRAHEDRON, colour=(0.5, 0.5, 0.5), said={"feature": "cone"})
    (tmp_path / "a.glb").write_bytes(glb_bytes([panel], "t", {"origin": [0.0, 0.0, 0.0]}))
    (found,) = read_glb(tmp_path / "a.glb")
    assert found.name == "Süd"
    assert np.abs(found.points - TETRAHEDRON.points).max() < 1e-4
    assert np.array_equal(found.corners, TETRAHEDRON.corners)
    assert glb_bytes([panel], "t", {}) == glb_bytes([panel], "t", {})


def test_what_is_not_the_reports_is_told(delivery: tuple[Path, ReportModel], tmp_path: Path) -> None:
    out, report = delivery
    data = (out / GLB).read_bytes()
    assert report.certificate.outputs["glb"]["panels"] == 3
    assert verify(out).holds
    meshes = read_glb(out / GLB)
    panels = [
        MeshedPanel(
            name=mesh.name,
            mesh=Triangles(points=mesh.points, normals=np.ones_like(mesh.points), corners=mesh.corners),
            colour=MOST,
        )
        for mesh in meshes
    ]
    shifted = replace(panels[0], mesh=replace(panels[0].mesh, points=panels[0].mesh.points + 1.0))
    holed = replace(panels[1], mesh=replace(panels[1].mesh, corners=panels[1].mesh.corners[1:]))
    thick = replace(panels[2], mesh=replace(panels[2].mesh, points=panels[2].mesh.points * 1.2))
    try:
        (out / GLB).write_bytes(glb_bytes([shifted, holed, thick], "t", {}))
        failures = verify(out).failures
        (out / GLB).write_bytes(glb_bytes(panels[:2], "t", {}))
        missing = verify(out).failures
        (out / GLB).write_bytes(glb_bytes(panels, "t", {}))
        painted = verify(out).failures
        first = data.index(b"BIN\0") + 4
        no_number = data[:first] + b"\x01\x00\x80\x7f" + data[first + 4 :]
        for damage in (b"", b"glTF", data[:700], data[:-4000], no_number):
            (out / GLB).write_bytes(damage)
            with pytest.raises(DeliveryError, match=r"panels\.glb' cannot be read: it is no whole glTF file"):
                verify(out)
    finally:
        (out / GLB).write_bytes(data)
    assert any("'N 1' has a corner 1.73 mm away" in failure for failure in failures)
    assert "'panels.glb': the mesh of panel 'N 2' is not closed." in failures
    assert any("'N 3' encloses" in failure for failure in failures)
    assert missing[1:] == ("'panels.glb' does not hold the panels of the report, each once and in their order.",)
    assert painted[1:] == (f"'{GLB}': its colours do not tell what the report says that they tell, deviation.",)
    with pytest.raises(DeliveryError, match="cannot be read: No such file"):
        read_glb(tmp_path / "none.glb")


def test_colours_tell_features_or_deviations(delivery: tuple[Path, ReportModel]) -> None:
    panels = list(delivery[1].panels)
    assert len(set(by_feature(panels))) == 1
    assert len(set(by_feature([panels[0], panels[1].model_copy(update={"feature": "cone"})]))) == 2
    worst = max(range(3), key=lambda place: panels[place].max_deviation)
    assert by_deviation(panels)[worst] == pytest.approx(MOST)
    exact = [panel.model_copy(update={"max_deviation": 0.0}) for panel in panels]
    assert by_deviation(exact) == [pytest.approx(LEAST)] * 3
    with pytest.raises(SettingsError, match="colours of meshes tell feature or deviation"):
        ShopSettings(mesh_colours="gap")  # type: ignore[arg-type]
