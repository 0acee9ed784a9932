"""Lips for the tests of the reference: flange, blend, flange over a rectangle, as sampled faces and as STEP files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.GeomAbs import GeomAbs_C2
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Pnt
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Compound, TopoDS_Face, TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from cadpanel.arrays import Array
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.reference.model import FaceSamples, RawPanel

Surface = Callable[[Array, Array], Array]

EDGE_POINTS = 33
# Step of the central differences that give the normals, in parameters from 0 to 1.
STEP = 1e-5
POLES = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Lip:
    """A panel across u (0 to 3: flange, blend, flange) and along v (0 to 1); lengths in mm, angles in degrees."""

    length: float = 2000.0
    flange: float = 500.0
    radius: float = 300.0
    fold: float = 90.0
    twist: float = 6.0
    taper: float = 0.1
    start: float = 0.0
    angle: float = 0.0

    def __call__(self, u: Array, v: Array) -> Array:
        """Return the (..., 3) points at the parameters."""
        along = self.start + v * self.length
        fold = np.radians(self.fold)
        radius = self.radius * (1.0 + self.taper * along / 10_000.0)
        arc = np.clip(u - 1.0, 0.0, 1.0) * fold
        first, last = np.minimum(u - 1.0, 0.0) * self.flange, np.maximum(u - 2.0, 0.0) * self.flange
        across = first + radius * np.sin(arc) + last * np.cos(fold)
        height = -radius * (1.0 - np.cos(arc)) - last * np.sin(fold)
        turn = np.radians(self.twist) * along / 2000.0 + np.radians(self.angle)
        return np.stack(
            [along, across * np.cos(turn) - height * np.sin(turn), across * np.sin(turn) + height * np.cos(turn)],
            axis=-1,
        )


def strip(count: int, **numbers: float) -> list[Lip]:
    """Return lips that follow each other without a gap."""
    return [Lip(start=2000.0 * index, **numbers) for index in range(count)]


def ring(count: int, radius: float = 6000.0) -> list[Surface]:
    """Return lips that close to a ring round the z axis, bent in plan."""

    def panel(index: int) -> Surface:
        profile = Lip(twist=0.0, taper=0.0)

        def surface(u: Array, v: Array) -> Array:
            flat = profile(u, np.zeros_like(v))
            turn = 2.0 * np.pi * (index + v) / count
            reach = radius + flat[..., 1]
            return np.stack([reach * np.cos(turn), reach * np.sin(turn), flat[..., 2]], axis=-1)

        return surface

    return [panel(index) for index in range(count)]


def lens() -> list[Surface]:
    """Return two lips that share both their ends and bulge to either side, off both flanges: a ring of two."""
    straight = Lip(twist=0.0, taper=0.0)

    def half(bulge: float) -> Surface:
        return lambda u, v: straight(u, v) + bulge * np.sin(np.pi * v)[..., None] * np.array([0.0, 0.7, 0.7])

    return [half(60.0), half(-60.0)]


def normal(surface: Surface, u: Array, v: Array) -> Array:
    """Return the unit normals by central differences; at the folds' borders on the side that u comes from."""
    along_u = surface(u + STEP, v) - surface(u - STEP, v)
    along_v = surface(u, v + STEP) - surface(u, v - STEP)
    normals = np.cross(along_u, along_v)
    return np.asarray(normals / np.linalg.norm(normals, axis=-1, keepdims=True))


def sampled_face(
    surface: Surface, u_range: tuple[float, float], v_range: tuple[float, float] = (0.0, 1.0), count: int = 7
) -> FaceSamples:
    """Sample a rectangle of a surface as the kernel would."""
    (u_0, u_1), (v_0, v_1) = u_range, v_range
    middles = (np.arange(count) + 0.5) / count
    u, v = (grid.ravel() for grid in np.meshgrid(u_0 + middles * (u_1 - u_0), v_0 + middles * (v_1 - v_0)))
    cell = np.cross(surface(u + STEP, v) - surface(u - STEP, v), surface(u, v + STEP) - surface(u, v - STEP)) * (
        (u_1 - u_0) * (v_1 - v_0) / (2.0 * STEP * count) ** 2
    )
    along = np.linspace(0.0, 1.0, EDGE_POINTS)
    us, vs = u_0 + along * (u_1 - u_0), v_0 + along * (v_1 - v_0)
    borders = [
        (us, np.full_like(us, v_0)),
        (np.full_like(vs, u_1), vs),
        (us[::-1], np.full_like(us, v_1)),
        (np.full_like(vs, u_0), vs[::-1]),
    ]
    # Normals are taken a hair inside the face, so that they are this face's where two meet.
    hair = 2.0 * STEP
    return FaceSamples(
        points=surface(u, v),
        normals=normal(surface, u, v),
        weights=np.linalg.norm(cell, axis=-1),
        edges=tuple(surface(*border) for border in borders),
        edge_normals=tuple(
            normal(surface, np.clip(a, u_0 + hair, u_1 - hair), np.clip(b, v_0 + hair, v_1 - hair)) for a, b in borders
        ),
    )


def raw_panel(surface: Surface, name: str = "lip", cuts: Sequence[float] = (0.0, 1.0, 2.0, 3.0)) -> RawPanel:
    """Sample a lip as faces between the given values of u."""
    faces = tuple(sampled_face(surface, (cuts[k], cuts[k + 1])) for k in range(len(cuts) - 1))
    return RawPanel(name=name, faces=faces)


def raw_strip(surfaces: Iterable[Surface]) -> list[RawPanel]:
    """Sample lips, named by their place."""
    return [raw_panel(surface, f"lip {index}") for index, surface in enumerate(surfaces)]


def raw_grid(surface: Surface, columns: int, rows: int) -> list[RawPanel]:
    """Sample a surface over (0, 1) x (0, 1) as panels of four sides in columns (along u) and rows (along v)."""
    us, vs = np.linspace(0.0, 1.0, columns + 1).tolist(), np.linspace(0.0, 1.0, rows + 1).tolist()
    return [
        RawPanel(
            name=f"{column}/{row}", faces=(sampled_face(surface, (us[column], us[column + 1]), (vs[row], vs[row + 1])),)
        )
        for row in range(rows)
        for column in range(columns)
    ]


def raw_honeycomb(surface: Surface, rings: int) -> list[RawPanel]:
    """Sample a surface around (0.5, 0.5) as hexagons: one in the middle and rings round it."""
    panels = []
    size = 0.5 / (np.sqrt(3.0) * (rings + 0.5))
    for i in range(-rings, rings + 1):
        for j in range(-rings, rings + 1):
            if abs(i + j) > rings:
                continue
            middle = np.array([0.5, 0.5]) + size * np.array([np.sqrt(3.0) * (i + 0.5 * j), 1.5 * j])
            angles = np.radians(30.0 + 60.0 * np.arange(6))
            corners = middle + size * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
            panels.append(RawPanel(name=f"{i}/{j}", faces=(polygon_face(surface, corners),)))
    return panels


def polygon_face(surface: Surface, corners: Array, count: int = 5) -> FaceSamples:
    """Sample the part of a surface over a convex polygon with the given (n, 2) corners, in parameters."""
    middle, after = corners.mean(axis=0), np.roll(corners, -1, axis=0)
    along = np.linspace(0.0, 1.0, EDGE_POINTS)[:, None]
    borders = [(1.0 - along) * one + along * other for one, other in zip(corners, after, strict=True)]
    # Every triangle from the middle to an edge is cut into strips, the wider the further out.
    share = (np.arange(count) + 0.5) / count
    out, aside = (grid.ravel()[:, None] for grid in np.meshgrid(share, share))
    inside = [
        middle + out * ((1.0 - aside) * one + aside * other - middle) for one, other in zip(corners, after, strict=True)
    ]
    u, v = np.concatenate(inside).T
    area = [
        abs(np.linalg.det(np.stack([one - middle, other - middle]))) for one, other in zip(corners, after, strict=True)
    ]
    parts = np.concatenate([size * out[:, 0] / count**2 for size in area])
    stretch = np.cross(surface(u + STEP, v) - surface(u - STEP, v), surface(u, v + STEP) - surface(u, v - STEP))
    return FaceSamples(
        points=surface(u, v),
        normals=normal(surface, u, v),
        weights=parts * np.linalg.norm(stretch, axis=-1) / (2.0 * STEP) ** 2,
        edges=tuple(surface(*border.T) for border in borders),
        edge_normals=tuple(normal(surface, *border.T) for border in borders),
    )


def sheet_of(height: Callable[[Array, Array], Array], width: float = 6000.0, length: float = 8000.0) -> Surface:
    """A sheet of that width (along u) and length (along v) with heights (mm) over its parameters."""

    def surface(u: Array, v: Array) -> Array:
        return np.stack([width * (u - 0.5), length * (v - 0.5), height(u, v)], axis=-1)

    return surface


def shuffled(panel: RawPanel, random: np.random.Generator) -> RawPanel:
    """The panel with faces and edges in another order, some edges walked backwards and some normals turned over."""
    faces = []
    for index in random.permutation(len(panel.faces)):
        face, count = panel.faces[index], len(panel.faces[index].edges)
        face = with_edges(face, random.permutation(count).tolist(), (random.random(count) < 0.5).tolist())
        faces.append(flipped(face) if random.random() < 0.5 else face)
    return replace(panel, faces=tuple(faces))


def flipped(face: FaceSamples) -> FaceSamples:
    """Return the face with its normals on the other side."""
    return replace(face, normals=-face.normals, edge_normals=tuple(-normals for normals in face.edge_normals))


def with_edges(face: FaceSamples, order: Sequence[int], backwards: Sequence[bool]) -> FaceSamples:
    """Return the face with its edges in another order, some of them walked the other way."""
    steps = [-1 if back else 1 for back in backwards]
    return replace(
        face,
        edges=tuple(face.edges[k][::step] for k, step in zip(order, steps, strict=True)),
        edge_normals=tuple(face.edge_normals[k][::step] for k, step in zip(order, steps, strict=True)),
    )


def moved(panel: RawPanel, rotation: Array, shift: Array) -> RawPanel:
    """Return the panel moved in space."""
    return replace(
        panel,
        faces=tuple(
            replace(
                face,
                points=face.points @ rotation.T + shift,
                normals=face.normals @ rotation.T,
                edges=tuple(edge @ rotation.T + shift for edge in face.edges),
                edge_normals=tuple(normals @ rotation.T for normals in face.edge_normals),
            )
            for face in panel.faces
        ),
    )


def kernel_face(surface: Surface, u_range: tuple[float, float] = (0.0, 3.0), poles: int = POLES) -> TopoDS_Face:
    """Return a B-spline face over a rectangle of a surface."""
    grid = TColgp_Array2OfPnt(1, poles, 1, poles)
    u, v = np.meshgrid(np.linspace(*u_range, poles), np.linspace(0.0, 1.0, poles), indexing="ij")
    points = surface(u, v)
    for row in range(poles):
        for column in range(poles):
            grid.SetValue(row + 1, column + 1, gp_Pnt(*points[row, column].tolist()))
    spline = GeomAPI_PointsToBSplineSurface(grid, 3, 8, GeomAbs_C2, 1e-4).Surface()
    return BRepBuilderAPI_MakeFace(spline, 1e-6).Face()


def kernel_lip(surface: Surface, cuts: Sequence[float] = (0.0, 1.0, 2.0, 3.0)) -> TopoDS_Compound:
    """Return a lip as a compound of B-spline faces."""
    return compound(kernel_face(surface, (cuts[k], cuts[k + 1])) for k in range(len(cuts) - 1))


def compound(shapes: Iterable[TopoDS_Shape]) -> TopoDS_Compound:
    """Put shapes into a compound."""
    builder, result = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(result)
    for shape in shapes:
        builder.Add(result, shape)
    return result


def write_products(path: Path, products: Iterable[tuple[str, TopoDS_Shape]], unit: str = "MM") -> Path:
    """Write named products, each a free shape, in the given unit."""
    silence_kernel()
    document = TDocStd_Document(TCollection_ExtendedString("test"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    for name, shape in products:
        TDataStd_Name.Set_s(shapes.AddShape(shape, False), TCollection_ExtendedString(name, True))
    writer = STEPCAFControl_Writer()
    Interface_Static.SetCVal_s("write.step.unit", unit)
    try:
        writer.Transfer(document, STEPControl_AsIs)
        assert writer.Write(str(path)) == IFSelect_RetDone
    finally:
        Interface_Static.SetCVal_s("write.step.unit", "MM")
    return path


def write_plain(path: Path, *shapes: TopoDS_Shape) -> Path:
    """Write shapes without names."""
    silence_kernel()
    writer = STEPControl_Writer()
    for shape in shapes:
        assert writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone
    assert writer.Write(str(path)) == IFSelect_RetDone
    return path


def tile(name, x, y, width=1000.0, length=1000.0, height=0.0):
    """A flat panel from (x, y) on."""

    def surface(u, v):
        return np.stack([x + width * u, y + length * v, height + 0.0 * u + 0.0 * v], axis=-1)

    return RawPanel(name=name, faces=(sampled_face(surface, (0.0, 1.0)),))
