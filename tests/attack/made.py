"""What is attacked: small files of every format, and small deliveries, made once."""

from __future__ import annotations

import shutil
from functools import cache
from pathlib import Path

from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

import cadpanel as cp
from cadpanel.brep.files.model import Label
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.result import FitResult
from fixtures.make_fixtures import Fixture, write
from tests.brep.files.mutants import originals as mutable
from tests.delivered import LIP
from tests.joined_fits import fitted
from tests.model_files import Labelled, strip_faces, write_labelled, write_shape
from tests.reference_shapes import Lip, kernel_lip, write_products
from tests.rhino_files import rhino

MESH = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n"
SHEET = SheetSettings(joint=10.0)
# Few holes: of each the kernel checks two rims and a wall, over and over.
SHOP = ShopSettings(fixings=(6.5, 2000.0, 20.0), returns=(30.0, 3.0), material="aluminium", stock=((1500.0, 3000.0),))


def models(folder: Path) -> dict[str, bytes]:
    """A small file of every format, by its name."""
    faces = strip_faces(Lip(), poles=6)
    labelled: list[Labelled] = [(Label(name=f"face {k}", color="#102030"), face, []) for k, face in enumerate(faces)]
    files = [
        write_products(folder / "products.step", [("lip", kernel_lip(Lip()))]),
        write_labelled(folder / "labelled.step", labelled),
        write_labelled(folder / "faces.iges", labelled),
        write_shape(folder / "text.brep", compound_of(faces)),
        write_shape(folder / "binary.bin.brep", BRepPrimAPI_MakeBox(100.0, 200.0, 300.0).Shape()),
    ]
    (folder / "mesh.obj").write_bytes(MESH)
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Millimeters
    file.Objects.AddBrep(rhino.Brep.CreateFromSphere(rhino.Sphere(rhino.Point3d(0.0, 0.0, 0.0), 100.0)))
    file.Write(str(folder / "sphere.3dm"), 8)
    found = {path.name: path.read_bytes() for path in (*files, folder / "mesh.obj", folder / "sphere.3dm")}
    return {**found, **mutable(folder)}


@cache
def strip_result(folder: Path) -> FitResult:
    """A strip of three panels, fitted from a file."""
    path = folder / "lip.step"
    write(Fixture(file=path.name, prefix="N", table=(), lip=LIP), path)
    return cp.fit(cp.read(path))


def rich_delivery(folder: Path) -> Path:
    """The strip with joints, holes, returns and every output that needs no asking."""
    deliver(strip_result(folder), folder / "rich", SHEET, SHOP)
    return folder / "rich"


def delivery_of(folder: Path, output: str) -> Path:
    """The strip as STEP files, report and one output more: all that `verify` need look at where that is attacked."""
    cp.deliver(strip_result(folder), folder / output, joint=10.0, outputs=output)
    return folder / output


def plain_delivery(folder: Path) -> Path:
    """The strip as STEP files and report alone."""
    cp.deliver(strip_result(folder), folder / "plain", outputs="step")
    return folder / "plain"


def flat_delivery(folder: Path) -> Path:
    """Flat panels with joints, as STEP files and report alone."""
    cp.deliver(fitted("quadrilaterals"), folder / "flat", joint=10.0, outputs="step")
    return folder / "flat"


def copied(delivery: Path, place: Path) -> Path:
    """A copy to be tampered with, in the place of an earlier one."""
    shutil.rmtree(place, ignore_errors=True)
    return Path(shutil.copytree(delivery, place))
