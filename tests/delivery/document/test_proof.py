"""A document is what the report says, and whatever is changed in it shows."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.gp import gp_Pnt
from OCP.Poly import Poly_Polygon3D, Poly_Triangle
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

from cadpanel.arrays import Array
from cadpanel.brep.building.drawn import flat_face
from cadpanel.brep.kernel.kept import kept_binary, kept_shape
from cadpanel.brep.kernel.shapes import edges_of, faces_of
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.document.archive import archive_bytes
from cadpanel.delivery.document.proof import edge_row, prove_document
from cadpanel.delivery.document.shapes import laid_out, shape_files
from cadpanel.delivery.document.tree import drawn_seams, flat_file, panel_file, seam_file, skin_file, tree
from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.records.from_fit import panel_records, seam_records, with_flat_parts
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError
from tests.delivered import fitted

Files = dict[str, bytes]


@pytest.fixture(scope="module")
def delivery() -> Delivery:
    return told_of(ShopSettings())


def told_of(shop: ShopSettings) -> Delivery:
    """The strip as a shop has it made."""
    result, sheet = fitted(), SheetSettings()
    built = build_panels(result.shapes, sheet, result.reference.seams, shop=shop)
    parts = flat_parts([panel.shape for panel in built.panels], sheet, shop)
    records = with_flat_parts(panel_records(result, built), built.panels, parts, shop.density)
    return Delivery(
        panels=built.panels,
        title="strip",
        sheet=sheet,
        shop=shop,
        records=records,
        seams=seam_records(result.reference, result.measures, built.joints),
        parts=parts,
    )


@pytest.fixture(scope="module")
def written(delivery: Delivery) -> bytes:
    return archive_bytes(delivery, shape_files(delivery, delivery.panels))


def changed(written: bytes, folder: Path, change: Callable[[Files], None]) -> Path:
    """The document with some of its files changed."""
    path = folder / "panels.FCStd"
    path.write_bytes(written)
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    change(files)
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


def test_the_same_delivery_gives_the_same_bytes_and_proves_itself(
    delivery: Delivery, written: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert archive_bytes(delivery, shape_files(delivery, delivery.panels)) == written
    (tmp_path / "panels.FCStd").write_bytes(written)
    proof = prove_document(tmp_path / "panels.FCStd", delivery)
    assert proof.failures == ()
    assert proof.numbers["panels"] == 3
    assert proof.numbers["volume_error"] < 1e-11
    assert proof.numbers["corner_error"] < 1e-9
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    (tmp_path / "dated.FCStd").write_bytes(archive_bytes(delivery, shape_files(delivery, delivery.panels)))
    with zipfile.ZipFile(tmp_path / "dated.FCStd") as archive:
        assert {one.date_time for one in archive.infolist()} == {(2023, 11, 14, 22, 13, 20)}


def swapped(first: str, second: str) -> Callable[[Files], None]:
    def change(files: Files) -> None:
        files[first], files[second] = files[second], files[first]

    return change


def replaced(file: str, data: bytes) -> Callable[[Files], None]:
    return lambda files: files.update({file: data})


def without(file: str) -> Callable[[Files], None]:
    def change(files: Files) -> None:
        del files[file]

    return change


def edited(file: str, old: bytes, new: bytes) -> Callable[[Files], None]:
    def change(files: Files) -> None:
        assert old in files[file]
        files[file] = files[file].replace(old, new, 1)

    return change


def kept_again(file: str, change: Callable[[TopoDS_Shape], None] | None = None) -> Callable[[Files], None]:
    """A shape read, changed and written, without triangles where nothing is changed."""

    def of_files(files: Files) -> None:
        shape = kept_shape(files[file])
        if change is not None:
            change(shape)
        files[file] = kept_binary(shape, triangles=change is not None)

    return of_files


def turned_over(shape: TopoDS_Shape) -> None:
    mesh = BRep_Tool.Triangulation_s(faces_of(shape)[0], TopLoc_Location())
    first, second, third = mesh.Triangle(1).Get()
    mesh.SetTriangle(1, Poly_Triangle(second, first, third))


def meshed(shape: TopoDS_Shape) -> None:
    BRepMesh_IncrementalMesh(shape, 10.0)


def drawn_elsewhere(shape: TopoDS_Shape) -> None:
    ends = TColgp_Array1OfPnt(1, 2)
    ends.SetValue(1, gp_Pnt(0.0, 0.0, 0.0))
    ends.SetValue(2, gp_Pnt(1.0, 0.0, 0.0))
    BRep_Builder().UpdateEdge(edges_of(shape)[0], Poly_Polygon3D(ends), TopLoc_Location())


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (edited("Document.xml", b'value="N 2"', b'value="N 9"'), "its numbers are not those of the report."),
        (edited("GuiDocument.xml", b'expanded="1"', b'expanded="0"'), "its colours are not those"),
        (swapped(panel_file(0), panel_file(1)), "panel 'N 1': the volume of its solid is off by"),
        (swapped(panel_file(0), panel_file(1)), "panel 'N 2': a corner of its solid is"),
        (swapped(skin_file(0), skin_file(2)), "panel 'N 3': the area of its skin is off by"),
        (swapped(skin_file(1), panel_file(1)), "panel 'N 2': it is 0 solids instead of one."),
        (swapped(flat_file(1), flat_file(2)), "panel 'N 2': its flat pattern is not that of the report."),
        (swapped(seam_file(0), seam_file(1)), "the seam of 'N 1' and 'N 2' is not drawn where the two panels end."),
        (swapped(seam_file(0), skin_file(1)), "the seam of 'N 1' and 'N 2' is not drawn from corner to corner."),
        (kept_again(panel_file(1)), "panel 'N 2': its solid has no triangles, by which FreeCAD shows it."),
        (kept_again(panel_file(1), turned_over), "panel 'N 2': triangles of its solid are turned over."),
        (kept_again(skin_file(1), meshed), "panel 'N 2': its skin has triangles, which belong to solids."),
        (kept_again(flat_file(1), meshed), "panel 'N 2': its flat pattern is not that of the report."),
        (
            kept_again(seam_file(0), drawn_elsewhere),
            "the seam of 'N 1' and 'N 2' is not drawn where the two panels end.",
        ),
        (without(flat_file(0)), "panel 'N 1' has lost its solid, its skin or its flat"),
        (replaced("last.txt", b""), "its shapes do not stand between numbers and looks"),
    ],
)
def test_whatever_is_changed_shows(
    delivery: Delivery, written: bytes, tmp_path: Path, change: Callable[[Files], None], told: str
) -> None:
    failures = prove_document(changed(written, tmp_path, change), delivery).failures
    assert any(told in failure for failure in failures), failures
    assert all(failure.startswith("'panels.FCStd': ") for failure in failures)


def test_what_cannot_be_read_is_refused(delivery: Delivery, written: bytes, tmp_path: Path) -> None:
    with pytest.raises(DeliveryError, match=r"the shape 'panel1\.bin' in it is damaged"):
        prove_document(changed(written, tmp_path, replaced(panel_file(0), b"no shape")), delivery)
    (tmp_path / "cut.FCStd").write_bytes(written[:1000])
    with pytest.raises(DeliveryError, match="it is damaged"):
        prove_document(tmp_path / "cut.FCStd", delivery)
    with pytest.raises(DeliveryError, match="No such file"):
        prove_document(tmp_path / "none.FCStd", delivery)


def test_edges_of_records_are_those_of_panels(delivery: Delivery) -> None:
    for panel, record in zip(delivery.panels, delivery.records, strict=True):
        for edge in ("end 0", "end 1", "side 0", "side 1"):
            assert edge_row(record, edge) == pytest.approx(panel.shape.edge(edge).corners)


def test_a_seam_along_an_edge_that_there_is_not_is_told(delivery: Delivery, written: bytes, tmp_path: Path) -> None:
    (tmp_path / "panels.FCStd").write_bytes(written)
    strange = delivery.seams[0].model_copy(update={"edges": ("edge 7", "end 0")})
    failures = prove_document(
        tmp_path / "panels.FCStd", replace(delivery, seams=(strange, *delivery.seams[1:]))
    ).failures
    assert any("is not where the report says it: panel 'N 1' has no edge 7." in failure for failure in failures)


def test_only_panels_that_are_delivered_stand_in_the_tree_with_the_seams_that_they_have(delivery: Delivery) -> None:
    one = replace(delivery, panels=delivery.panels[:1], records=delivery.records[:1], parts=delivery.parts[:1])
    labels = [thing.label for thing in tree(one)]
    assert labels == [
        *("Panels", "plane-cone-plane", "N 1", "Seams", "N 1 | N 2"),
        *("Skins", "N 1 skin", "Flat patterns", "N 1 flat", "Schedule"),
    ]
    assert [seam.panels for seam in drawn_seams(one)] == [("N 1", "N 2")]
    assert len(list(shape_files(one, one.panels))) == 4


def test_strips_and_features_are_groups(delivery: Delivery) -> None:
    names = ("A-1", "A-2", "B-1")
    kinds = ("cone", "cylinder", "cone")
    records = tuple(
        record.model_copy(update={"name": name, "feature": kind})
        for record, name, kind in zip(delivery.records, names, kinds, strict=True)
    )
    found = {thing.label: thing for thing in tree(replace(delivery, records=records, seams=()))}
    groups = {thing.name: thing.label for thing in found.values()}
    assert groups[found["A-2"].parent or ""] == "A cylinder"
    assert groups[found["B-1"].parent or ""] == "B cone"
    assert groups[found["A cylinder"].parent or ""] == "Strip A"
    assert groups[found["Strip A"].parent or ""] == "Panels"


def test_flat_patterns_do_not_lie_on_each_other(delivery: Contents) -> None:
    boxes = [(contour[:, :2].min(axis=0), contour[:, :2].max(axis=0)) for contour, *_ in laid_out(delivery)]
    for i, (low, high) in enumerate(boxes):
        assert all((high < others_low).any() or (low > others_high).any() for others_low, others_high in boxes[:i])
    assert kept_binary(flat_face(*laid_out(delivery)[0])).startswith(b"\nOpen CASCADE Topology V3")


def test_holes_are_in_flat_patterns_and_each_of_them_is_missed(tmp_path: Path) -> None:
    drilled = told_of(ShopSettings(fixings=(6.5, 450.0, 40.0)))
    written = archive_bytes(drilled, shape_files(drilled, drilled.panels))
    assert prove_document(changed(written, tmp_path, lambda _: None), drilled).failures == ()
    contour, lines, holes = laid_out(drilled)[1]
    assert len(holes) > 10
    for other in (holes[1:], holes + [[0.001, 0.0, 0.0]] * (holes[:, :1] == holes[0, 0])):

        def change(files: Files, other: Array = other) -> None:
            files[flat_file(1)] = kept_binary(flat_face(contour, lines, other))

        failures = prove_document(changed(written, tmp_path, change), drilled).failures
        assert failures == ("'panels.FCStd': panel 'N 2': the holes in its flat pattern are not those of the report.",)
