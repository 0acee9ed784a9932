"""Tampering of the other files of a delivery: of the text of STEP files, of bytes, of which files there are."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable
from pathlib import Path

from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.gp import gp_Trsf, gp_Vec
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.kernel.kept import kept_binary, kept_shape
from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.delivery.manifest import MANIFEST
from tests.attack.report_tampers import edited

Tamper = Callable[[Path], None]
"""Changes something in a folder."""


class NothingToTamperError(Exception):
    """A tamper found nothing that it could change: it must be mended."""


def _text(name: str, pattern: str, replacement: str | Callable[[re.Match[str]], str], count: int = 1) -> Tamper:
    def tamper(folder: Path) -> None:
        path = folder / name
        text = path.read_text(encoding="latin-1")
        new, made = re.subn(pattern, replacement, text, count=count)
        if not made or new == text:
            raise NothingToTamperError(f"{name}: {pattern}")
        path.write_text(new, encoding="latin-1")

    return tamper


def _bumped(by: float) -> Callable[[re.Match[str]], str]:
    """The number of the last group, larger by that."""
    return lambda found: f"{found[1]}{float(found[2]) + by!r}"


REAL = r"-?\d+\.\d*(?:E[+-]?\d+)?"
_POINT = rf"(CARTESIAN_POINT\('',\({REAL},)({REAL})"
_OF_STEP: dict[str, tuple[str, str | Callable[[re.Match[str]], str]]] = {
    # The first ones of a file are those of its origin.
    "a point by 0.01 mm": (rf"(?s)(VERTEX_POINT.*?{_POINT[1:]}", _bumped(0.01)),
    "a point by 2e-6 mm": (rf"(?s)(VERTEX_POINT.*?{_POINT[1:]}", _bumped(2e-6)),
    "a direction turned": (rf"(?s)(CONICAL_SURFACE.*?DIRECTION\('',\({REAL},)({REAL})", _bumped(1e-3)),
    "the first point": (rf"(CARTESIAN_POINT\('',\({REAL},)({REAL})", _bumped(0.01)),
    "the first direction": (rf"(DIRECTION\('',\({REAL},)({REAL})", _bumped(1e-3)),
    "a cone's half angle": (rf"(CONICAL_SURFACE\('',#\d+,{REAL},)({REAL})", _bumped(1e-6)),
    "a cone's radius": (rf"(CONICAL_SURFACE\('',#\d+,)({REAL})", _bumped(1e-3)),
    "an ellipse's half axis": (rf"(ELLIPSE\('',#\d+,)({REAL})", _bumped(1e-3)),
    "a face turned over": (r"(ADVANCED_FACE\([^;]*),\.T\.\)", r"\1,.F.)"),
    "an edge turned round": (r"(ORIENTED_EDGE\('',\*,\*,#\d+),\.T\.\)", r"\1,.F.)"),
    "an edge's sense": (r"(EDGE_CURVE\('',#\d+,#\d+,#\d+),\.T\.\)", r"\1,.F.)"),
    "two names exchanged": (r"(?s)'N-01'(.*)'N-02'", r"'N-02'\1'N-01'"),
    "all of one name": (r"'N-02'", "'N-01'"),
    "an empty name": (r"(=PRODUCT\('[^']*'),'N-01'", r"\1,''"),
    "another part number": (r"(=PRODUCT\('[^']*)/N-01(?=['/])", r"\1/N-77"),
    "an instance's name": (r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\('[^']*'),'N-01'", r"\1,'N-09'"),
    "another schema": (r"FILE_SCHEMA\(\('[^']*'\)\)", "FILE_SCHEMA(('CONFIG_CONTROL_DESIGN'))"),
    "centimetres": (r"SI_UNIT\(\.MILLI\.,\.METRE\.\)", "SI_UNIT(.CENTI.,.METRE.)"),
    "an accuracy of 10 mm": (rf"LENGTH_MEASURE\({REAL}\)(?=,#\d+,'distance_acc)", "LENGTH_MEASURE(10.)"),
    "a product's description": (r"(=PRODUCT\('[^']*','N-01'),'[^']*'", r"\1,'gold, 9 mm'"),
    "an area that is stated": (rf"(AREA_MEASURE\()({REAL})", _bumped(1.0)),
    "an instance left out": (r"#\d+=NEXT_ASSEMBLY_USAGE_OCCURRENCE\([^;]*;\n", ""),
    "a product left out": (r"#\d+=PRODUCT\('[^']*/N-01[^;]*;\n", ""),
    "a face left out of its shell": (r"((?:CLOSED|OPEN)_SHELL\('[^']*',\()#\d+,", r"\1"),
    "a placement moved": (r"(AXIS2_PLACEMENT_3D\('',#\d+),(#\d+),(#\d+)", r"\1,\3,\2"),
    "an author": (r"FILE_NAME\('([^']*)','[^']*',\([^)]*\)", r"FILE_NAME('\1','2001-01-01T00:00:00',('Somebody Else')"),
}
_OF_PANELS: dict[str, tuple[str, str | Callable[[re.Match[str]], str]]] = {
    "the thickness that is stated": (r"(?s)('thickness'.{0,400}?MEASURE\()[^)]*", r"\g<1>9."),
    "the mass that is stated": (r"(?s)('mass'.{0,400}?MEASURE\()[^)]*", r"\g<1>9."),
    "the material that is stated": ("aluminium", "magnesium"),
    "the feature that is stated": ("plane-cone-plane", "plane-cold-plane"),
    "a face turned over back": (r"(ADVANCED_FACE\([^;]*),\.F\.\)", r"\1,.T.)"),
    "a volume that is stated": (rf"(VOLUME_MEASURE\()({REAL})", _bumped(1.0)),
    "the density that is stated": (rf"(?s)(density.{{0,400}}?MEASURE\()({REAL})", _bumped(9.0)),
}


def _flipped(name: str, part: float = 0.5) -> Tamper:
    """One bit of a file changed, so far into it."""

    def tamper(folder: Path) -> None:
        data = bytearray((folder / name).read_bytes())
        data[int(part * (len(data) - 1))] ^= 1
        (folder / name).write_bytes(bytes(data))

    return tamper


def _cut(name: str) -> Tamper:
    def tamper(folder: Path) -> None:
        (folder / name).write_bytes((folder / name).read_bytes()[:-200])

    return tamper


def _gone(name: str) -> Tamper:
    return lambda folder: (folder / name).unlink()


def _exchanged(one: str, other: str) -> Tamper:
    def tamper(folder: Path) -> None:
        first, second = folder / one, folder / other
        data = first.read_bytes()
        first.write_bytes(second.read_bytes())
        second.write_bytes(data)

    return tamper


def _rezipped(name: str, change: Callable[[str, bytes], bytes]) -> Tamper:
    """An archive with its files changed."""

    def tamper(folder: Path) -> None:
        with zipfile.ZipFile(folder / name) as archive:
            files = {one: archive.read(one) for one in archive.namelist()}
        new = {one: change(one, data) for one, data in files.items()}
        if new == files:
            raise NothingToTamperError(name)
        with zipfile.ZipFile(folder / name, "w") as archive:
            for one, data in new.items():
                archive.writestr(one, data)

    return tamper


def _in_document(pattern: bytes, replacement: bytes) -> Tamper:
    def change(name: str, data: bytes) -> bytes:
        return re.sub(pattern, replacement, data, count=1) if name == "Document.xml" else data

    return _rezipped("panels.FCStd", change)


def _of_shapes(change: Callable[[TopoDS_Shape], TopoDS_Shape], *, of: str = "", triangles: bool = True) -> Tamper:
    """Shapes of the document, those whose names begin so, changed by the kernel."""

    def changed(name: str, data: bytes) -> bytes:
        wanted = name.endswith(".bin") and name.startswith(of)
        return kept_binary(change(kept_shape(data)), triangles=triangles) if wanted else data

    return _rezipped("panels.FCStd", changed)


def _moved(shape: TopoDS_Shape) -> TopoDS_Shape:
    move = gp_Trsf()
    move.SetTranslation(gp_Vec(1.0, 0.0, 0.0))
    return BRepBuilderAPI_Transform(shape, move, True, True).Shape()


def _corner_of_a_triangle_moved(shape: TopoDS_Shape) -> TopoDS_Shape:
    mesh = BRep_Tool.Triangulation_s(faces_of(shape)[-1], TopLoc_Location())
    mesh.SetNode(1, mesh.Node(1).Translated(gp_Vec(0.0, 0.0, 0.01)))
    return shape


def _of_manifest(change: Callable[[dict[str, dict[str, object]]], object]) -> Tamper:
    def tamper(folder: Path) -> None:
        def of_files(content: dict[str, dict[str, dict[str, object]]]) -> None:
            change(content["files"])

        edited(folder / MANIFEST, of_files)

    return tamper


def _stray(folder: Path) -> None:
    (folder / "flat" / "N-99.dxf").write_bytes((folder / "flat" / "N-01.dxf").read_bytes())


def _page(pattern: str, replacement: str) -> Tamper:
    return _text("report.html", pattern, replacement)


BINARY = (
    "panels.glb",
    "panels.FCStd",
    "report.html",
    "flat/N-02.dxf",
    "flat/all.dxf",
    "schedule.csv",
    "setting_out.csv",
)
_NUMBER_OF_DXF = r"(?m)(^ *1[01]\n)(-?\d+\.\d+)$"

STEPS = ("panels.step", "skins.step")

FILES: dict[str, Tamper] = {
    **{
        f"{name}: {what}": _text(name, *how) for name in ("panels.step", "skins.step") for what, how in _OF_STEP.items()
    },
    **{f"panels.step: {what}": _text("panels.step", *how) for what, how in _OF_PANELS.items()},
    **{f"{name}: cut": _cut(name) for name in (*BINARY, *STEPS)},
    **{f"{name}: gone": _gone(name) for name in (*BINARY, *STEPS, "report.json", MANIFEST)},
    "skins in the place of panels": _exchanged("skins.step", "panels.step"),
    "two drawings exchanged": _exchanged("flat/N-01.dxf", "flat/N-02.dxf"),
    "a drawing more": _stray,
    "a drawing: a contour moved": _text("flat/N-02.dxf", _NUMBER_OF_DXF, _bumped(0.01)),
    "a drawing: another layer": _text("flat/N-02.dxf", "CUT", "CUB"),
    "the drawing of all: a contour moved": _text("flat/all.dxf", _NUMBER_OF_DXF, _bumped(0.01)),
    "schedule: a number": _text("schedule.csv", r"(?m)(^panel,N-02,.*?,)(\d+\.\d+)", _bumped(0.1)),
    "schedule: a formula": _text("schedule.csv", "N-02", "=1+1"),
    "setting out: a coordinate": _text("setting_out.csv", r"(?m)(^N-02,.*?,)(-?\d+\.\d+)", _bumped(0.01)),
    "mesh: a bit in its numbers": _flipped("panels.glb", 0.7),
    "mesh: a name": _text("panels.glb", "N-02", "N-07"),
    "document: a property": _in_document(rb'(<Float value=")[^"]*', rb"\g<1>9.5"),
    "document: a name": _in_document(rb'value="N-02"', b'value="N-07"'),
    "document: shapes moved": _of_shapes(_moved),
    "document: triangles moved": _of_shapes(_corner_of_a_triangle_moved, of="panel"),
    "document: triangles left out": _of_shapes(lambda shape: shape, of="panel", triangles=False),
    "page: a number": _page(r'("deviation": ?)[\d.]+', r"\g<1>0.001"),
    "page: a name": _page("N-02", "N-07"),
    "page: a script": _page("</body>", "<script src='https://example.org/x.js'></script></body>"),
    "page: a picture moved": _page(r'("points":\{[^}]*"data": ?"[A-Za-z0-9+/]{30})...', r"\1AAA"),
    "manifest: another sum": _of_manifest(lambda files: files["panels.step"].update(sha256="0" * 64)),
    "manifest: another size": _of_manifest(lambda files: files["panels.step"].update(size=1)),
    "manifest: a file left out": _of_manifest(lambda files: files.pop("panels.step") and None),
    "manifest: a file more": _of_manifest(lambda files: files.update(ghost={"size": 1, "sha256": "0" * 64})),
    "manifest: no files": _of_manifest(lambda files: files.clear()),
}
"""By what is done, tampers of the rich delivery. Those of the manifest leave it as they make it."""
