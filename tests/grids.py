"""References whose panels meet all round: grids, honeycombs and mixed rows on gently curved surfaces, as STEP files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.Geom2d import Geom2d_Line
from OCP.gp import gp_Dir2d, gp_Pnt2d
from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array
from tests.reference_shapes import Lip, Surface, kernel_face, kernel_lip, write_products

SIDE = 1500.0  # mm, of a panel


def dome(radius_x: float, radius_y: float, twist: float = 0.0, panels: float = 3.0) -> Surface:
    """A square of `panels` panels a side, u from 0 to 3 and v from 0 to 1, that sags like a paraboloid, mm.

    `twist` is the angle in radians by which the normals turn sideways over the side of a panel, along u and along v.
    """

    def surface(u: Array, v: Array) -> Array:
        x, y = panels * SIDE * (np.asarray(u) / 3.0 - 0.5), panels * SIDE * (np.asarray(v) - 0.5)
        height = -0.5 * (x**2 / radius_x + y**2 / radius_y) + twist * x * y / SIDE
        return np.stack([x, y, height], axis=-1)

    return surface


def write_grid(path: Path, surface: Surface, count: int = 3) -> Path:
    """Write count x count panels, each a face of its own: "i,j" in the i-th column (u) and the j-th row (v)."""

    def panel(i: int, j: int) -> Surface:
        return lambda u, v: surface(3.0 * (i + u / 3.0) / count, (j + v) / count)

    return write_products(path, [(f"{i},{j}", kernel_face(panel(i, j))) for i in range(count) for j in range(count)])


def write_honeycomb(path: Path, surface: Surface) -> Path:
    """Write a hexagon and its six neighbours, trimmed out of one surface and named by their place."""
    whole = kernel_face(surface)
    reach = 0.19
    centres = [(0.5, 0.5)] + [
        (0.5 + np.sqrt(3.0) * reach * np.cos(turn), 0.5 + np.sqrt(3.0) * reach * np.sin(turn))
        for turn in np.radians(30.0 + 60.0 * np.arange(6))
    ]
    turns = np.radians(60.0 * np.arange(6))
    return write_products(
        path,
        [
            (f"H{i}", _trimmed(whole, np.stack([x + reach * np.cos(turns), y + reach * np.sin(turns)], axis=-1)))
            for i, (x, y) in enumerate(centres)
        ],
    )


def _trimmed(face: TopoDS_Face, corners: Array) -> TopoDS_Face:
    """The part of a face inside a polygon (n, 2) of its parameters, as shares of their ranges."""
    surface = BRep_Tool.Surface_s(face)
    u_0, u_1, v_0, v_1 = surface.Bounds()
    points = corners * [u_1 - u_0, v_1 - v_0] + [u_0, v_0]
    wire = BRepBuilderAPI_MakeWire()
    for start, stop in _pairs(points):
        span = stop - start
        line = Geom2d_Line(gp_Pnt2d(*start.tolist()), gp_Dir2d(*span.tolist()))
        edge = BRepBuilderAPI_MakeEdge(line, surface, 0.0, float(np.linalg.norm(span))).Edge()
        BRepLib.BuildCurve3d_s(edge)
        wire.Add(edge)
    return BRepBuilderAPI_MakeFace(surface, wire.Wire()).Face()


def _pairs(points: Array) -> Iterator[tuple[Array, Array]]:
    return zip(points, np.roll(points, -1, axis=0), strict=True)


def write_mixed_row(path: Path, twist: float) -> Path:
    """Write two lips in a strip, and beside each a flat panel that goes on from its last flange's free edge."""
    products = []
    for i in range(2):
        lip = Lip(start=2000.0 * i, twist=twist, taper=0.1)

        def beside(u: Array, v: Array, lip: Lip = lip) -> Array:
            """The last flange, carried on: u from 0 to 3 over its next 900 mm."""
            return lip(3.0 + 0.6 * np.asarray(u), v)

        products += [(f"lip {i}", kernel_lip(lip)), (f"plate {i}", kernel_face(beside))]
    return write_products(path, products)
