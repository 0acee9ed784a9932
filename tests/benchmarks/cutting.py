"""How long reading and cutting a reference takes, against solving and building the panels that it is cut into.

    python -m tests.benchmarks.cutting --panels 2000

A roof arched both ways, one B-spline face, is cut into flat quadrilaterals along its parameters, along curves, and by a
mesh; a roof edge of three faces is divided along its length. Each is read from files, with half the panels first: what
the second time is to the first tells how the time grows. The mesh and the curves are laid along the same lines.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
import typer
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.Geom import Geom_Surface
from OCP.TopoDS import TopoDS_Face

import cadpanel as cp
from cadpanel.brep.kernel.shapes import compound_of
from fixtures.grids import dome
from tests.model_files import strip_faces, write_shape
from tests.reference_shapes import Lip, kernel_face, sheet_of

# Sides of the panels of the roof, mm, and what it rises, as a part of its width.
SIDE = 1500.0
RISE = 0.07
# Length of a panel along the strip, mm.
PANEL_LENGTH = 2000.0


class Way(NamedTuple):
    """One way to cut: what it is called, the settings for it, the file that is cut, and the feature for its panels."""

    name: str
    file: Path
    settings: cp.ReferenceSettings
    feature: str


def roof_face(rows: int, columns: int) -> TopoDS_Face:
    """A roof for so many panels."""
    width, length = SIDE * rows, SIDE * columns
    height = dome(RISE * width, width)
    sheet = sheet_of(lambda u, v: height(width * (u - 0.5), width * (v - 0.5)), width, length)
    return kernel_face(sheet, (0.0, 1.0), poles=24)


def lines(surface: Geom_Surface, rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """The parameters at which rows and columns part, borders included."""
    u_0, u_1, v_0, v_1 = surface.Bounds()
    return np.linspace(u_0, u_1, rows + 1), np.linspace(v_0, v_1, columns + 1)


def write_network(path: Path, face: TopoDS_Face, rows: int, columns: int) -> Path:
    """The lines between the panels as curves."""
    surface = BRep_Tool.Surface_s(face)
    along_u, along_v = lines(surface, rows, columns)
    curves = [surface.UIso(u) for u in along_u[1:-1].tolist()] + [surface.VIso(v) for v in along_v[1:-1].tolist()]
    return write_shape(path, compound_of(BRepBuilderAPI_MakeEdge(curve).Edge() for curve in curves))


def write_mesh(path: Path, face: TopoDS_Face, rows: int, columns: int) -> Path:
    """The panels' corners as an OBJ mesh."""
    surface = BRep_Tool.Surface_s(face)
    along_u, along_v = lines(surface, rows, columns)
    corners = [surface.Value(u, v).Coord() for u in along_u.tolist() for v in along_v.tolist()]
    text = ["v {!r} {!r} {!r}".format(*corner) for corner in corners]
    for row in range(rows):
        for column in range(columns):
            first = row * (columns + 1) + column + 1
            text.append(f"f {first} {first + 1} {first + columns + 2} {first + columns + 1}")
    path.write_text("\n".join(text) + "\n")
    return path


def ways(panels: int, folder: Path) -> Iterator[Way]:
    """The files for so many panels, written one after the other."""
    rows = round(panels**0.5)
    columns = max(2, round(panels / rows))
    face = roof_face(rows, columns)
    roof = write_shape(folder / f"roof_{panels}.brep", face)
    flat = "planar-quadrilateral"
    yield Way("--grid", roof, cp.ReferenceSettings(unit="mm", grid=(rows, columns)), flat)
    network = write_network(folder / f"lines_{panels}.brep", face, rows, columns)
    yield Way("--network", roof, cp.ReferenceSettings(unit="mm", network=network), flat)
    mesh = write_mesh(folder / f"corners_{panels}.obj", face, rows, columns)
    yield Way("--mesh", roof, cp.ReferenceSettings(unit="mm", mesh=mesh), flat)
    lip = Lip(length=panels * PANEL_LENGTH, twist=0.0, taper=0.0)
    strip = write_shape(folder / f"strip_{panels}.brep", compound_of(strip_faces(lip)))
    yield Way("--divide", strip, cp.ReferenceSettings(unit="mm", divide=panels), "plane-cone-plane")


def run(panels: Annotated[int, typer.Option(help="Panels to cut into, about.")] = 2000) -> None:
    """Time each way to cut."""
    head = ("panels", "seams", "read half, s", "read all, s", "solve, s", "build, s")
    print(" " * 10 + "".join(f"{word:>14}" for word in head))
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        pairs = zip(ways(panels // 2, folder), ways(panels, folder), strict=True)
        for half, whole in pairs:
            began = time.perf_counter()
            cp.read(half.file, half.settings)
            halfway = time.perf_counter()
            reference = cp.read(whole.file, whole.settings)
            read = time.perf_counter()
            result = cp.fit(reference, feature=whole.feature)
            solved = time.perf_counter()
            for shape in result.shapes:
                cp.build_solid(shape, 3.0)
                cp.build_skin(shape)
            built = time.perf_counter()
            times = np.diff([began, halfway, read, solved, built])
            counts = f"{len(reference.panels):14d}{len(reference.seams):14d}"
            print(f"{whole.name:<10}{counts}" + "".join(f"{seconds:14.1f}" for seconds in times), flush=True)


if __name__ == "__main__":
    typer.run(run)
