"""Damaged files: whatever is done to one, reading it ends in panels or in one sentence, and leaves nothing behind.

The files are read by the guarded interpreter, which the kernel may crash; this process must not notice.
"""

import random

import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

from cadpanel.brep.cutting.by_mesh import load_mesh
from cadpanel.brep.files.catalogue import FORMATS
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Label
from cadpanel.brep.isolation import requests
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.survey import survey
from cadpanel.errors import CadpanelError, DeliveryError
from cadpanel.reference.settings import ReferenceSettings
from tests.attack.damage import NUMBER, damaged
from tests.certified import Delivery, strip
from tests.drawn import curve
from tests.model_files import Labelled, strip_faces, write_labelled, write_shape
from tests.reference_shapes import Lip, kernel_lip, write_products
from tests.thorough import cases

VARIANTS = cases(8, 60)  # of each of six files, so 360 in all in a thorough run
SECONDS = 3.0  # after which a reader counts as hanging
LONGEST_SENTENCE = 1000
pytestmark = pytest.mark.usefixtures("forked_readers")  # or the kernel would be loaded for every crash


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


@pytest.fixture(scope="module")
def originals(folder):
    faces = strip_faces(Lip(), poles=6)
    labelled: list[Labelled] = [(Label(name=f"face {k}", color="#102030"), face, []) for k, face in enumerate(faces)]
    written = {
        "products.step": write_products(folder / "products.step", [("lip", kernel_lip(Lip()))]),
        "labelled.step": write_labelled(folder / "labelled.step", labelled),
        "faces.iges": write_labelled(folder / "faces.iges", labelled),
        "text.brep": write_shape(folder / "text.brep", compound_of(faces)),
        "binary.bin.brep": write_shape(folder / "binary.bin.brep", BRepPrimAPI_MakeBox(100.0, 200.0, 300.0).Shape()),
    }
    rhino = pytest.importorskip("rhino3dm")
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Millimeters
    file.Objects.AddBrep(rhino.Brep.CreateFromSphere(rhino.Sphere(rhino.Point3d(0.0, 0.0, 0.0), 100.0)))
    written["sphere.3dm"] = folder / "sphere.3dm"
    assert file.Write(str(written["sphere.3dm"]), 8)
    return {name: path.read_bytes() for name, path in written.items()}


@pytest.mark.parametrize(
    "name", ["products.step", "labelled.step", "faces.iges", "text.brep", "binary.bin.brep", "sphere.3dm"]
)
def test_damaged_file_gives_panels_or_one_sentence(originals, tmp_path, monkeypatch, name, capfd):
    monkeypatch.setattr(requests, "SECONDS_TO_READ", SECONDS)
    monkeypatch.setattr(requests, "SECONDS_TO_WORK", SECONDS)
    path = tmp_path / name
    read, sentences = 0, []
    for seed in range(VARIANTS):
        path.write_bytes(damaged(originals[name], seed))
        try:
            if name == "products.step":
                read_raw_panels(path)
            else:
                survey(path)
            read += 1
        except CadpanelError as error:
            sentences.append(str(error))
    assert read + len(sentences) == VARIANTS
    assert sentences
    assert [said for said in sentences if not said.endswith(".") or len(said) > LONGEST_SENTENCE] == []
    assert [left.name for left in tmp_path.iterdir()] == [name]
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("ending", sorted(ending for form in FORMATS for ending in form.suffixes))
def test_file_of_another_kind_under_the_ending_is_refused(tmp_path, ending):
    path = tmp_path / f"model{ending}"
    path.write_bytes(random.Random(ending).randbytes(5000))
    with pytest.raises(CadpanelError, match=r"of no format that it knows"):
        load_model(path)


@pytest.fixture(scope="module")
def lines(folder):
    """Two curves across the strip."""
    u = np.linspace(0.0, 3.0, 60)
    return write_shape(folder / "lines.brep", compound_of(curve(Lip()(u, np.full(60, v))) for v in (0.3, 0.6)))


# Over what seeds 7 and 22 leave, the kernel crashes when a curve is laid over a face.
@pytest.mark.parametrize(
    ("seeds", "ways"),
    [(range(NUMBER, NUMBER + 6 * cases(8, 30), 6), ("divide", "grid")), ((7, 10, 16, 22, 28), ("network",))],
    ids=["alone", "curves"],
)
def test_damaged_faces_are_cut_or_refused(originals, lines, tmp_path, monkeypatch, seeds, ways):
    """What was read may still be nothing that can be cut: bent, empty or far away."""
    monkeypatch.setattr(requests, "SECONDS_TO_READ", SECONDS)
    monkeypatch.setattr(requests, "SECONDS_TO_WORK", SECONDS)
    path = tmp_path / "text.brep"
    settings = {"divide": 3, "grid": (2, 2), "network": lines}
    sentences = []
    for seed in seeds:
        path.write_bytes(damaged(originals["text.brep"], seed))
        for how in ({way: settings[way]} for way in ways):
            try:
                panels = read_raw_panels(path, ReferenceSettings(unit="mm", **how)).panels
                assert panels
            except CadpanelError as error:
                sentences.append(str(error))
    assert sentences
    assert [said for said in sentences if "text.brep" not in said and "lines.brep" not in said] == []


@pytest.mark.parametrize("file", ["panels_step", "skins_step"])
def test_damaged_delivery_is_refused_or_does_not_hold(tmp_path, file):
    """Over what seed 125 leaves of the panels, the kernel crashes."""
    delivery = Delivery(tmp_path, strip())
    path = getattr(delivery, file)
    whole, ends = path.read_bytes(), []
    for seed in cases((100, 103, 106, 114, 125), (*range(100, 130, 2), 103, 125)):
        path.write_bytes(damaged(whole, seed))
        try:
            ends.append(str(delivery.certify().holds))
        except DeliveryError as error:
            ends.append(str(error))
    assert len({*ends} - {"True"}) > 1
    assert [said for said in ends if said not in ("True", "False") and path.name not in said] == []
    path.write_bytes(whole)
    assert delivery.certify().holds


def test_damaged_mesh_is_read_or_refused(tmp_path):
    path = tmp_path / "mesh.obj"
    text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n"
    sentences = []
    for seed in range(200):
        path.write_bytes(damaged(text, seed))
        try:
            load_mesh(path, np.zeros(3), 1.0, 0.01)
        except CadpanelError as error:
            sentences.append(str(error))
    assert sentences
    assert [said for said in sentences if "mesh.obj" not in said] == []
