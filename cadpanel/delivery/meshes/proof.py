"""Meshes that were read back, held against the report: names, closed surfaces, volumes, corners."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, IntArray
from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.records.to_shape import sheet_corners
from cadpanel.geometry.sheet_checks import sheet_depth
from cadpanel.geometry.triangles import Triangles, is_closed, merged

TOGETHER = 0.01
"""Corners of triangles within so many mm are one: single precision keeps 0.001 mm of a panel of 10 m."""


class ReadMesh(Protocol):
    """A mesh as a reader gives it: a name, points (v, 3) in mm, triangles (t, 3)."""

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def points(self) -> Array: ...  # noqa: D102

    @property
    def corners(self) -> IntArray: ...  # noqa: D102


def prove_meshes(file: str, found: Sequence[ReadMesh], contents: Contents, origin: Array) -> Proof:
    """One sentence for everything that does not hold.

    Args:
        file: its name, for sentences.
        found: the meshes in it.
        contents: what it must tell of.
        origin: (3,) where the origin of the report's coordinates lies in the file, mm.
    """
    if [mesh.name for mesh in found] != [panel.name for panel in contents.records]:
        return Proof(failures=(f"'{file}' does not hold the panels of the report, each once and in their order.",))
    failures = [
        f"'{file}': the mesh of panel '{mesh.name}' {what}."
        for mesh, panel in zip(found, contents.records, strict=True)
        for what in _faults(mesh, panel, contents, origin)
    ]
    triangles = sum(len(mesh.corners) for mesh in found)
    return Proof(numbers={"panels": len(found), "triangles": triangles}, failures=tuple(failures))


def _faults(mesh: ReadMesh, panel: PanelModel, contents: Contents, origin: Array) -> Iterator[str]:
    chord = contents.shop.mesh_chord
    points, place = merged(mesh.points, TOGETHER)
    if not is_closed(place[mesh.corners]):
        yield "is not closed"
        return
    whole = Triangles(points=points, normals=np.zeros_like(points), corners=place[mesh.corners])
    surface = panel.surface if panel.surface is not None else 2.0 * panel.area
    # Every facet lies within the chord of its face, so that between mesh and solid is a layer no thicker than that.
    if not abs(whole.volume() - panel.volume) <= surface * (chord + TOGETHER):
        yield f"encloses {whole.volume():.6g} mm3 instead of {panel.volume:.6g}"
    depth = sheet_depth(contents.sheet.thickness, contents.sheet.skin_side)
    corners = np.concatenate(sheet_corners(panel, depth)) + origin
    apart = float(np.max(cKDTree(points).query(corners)[0]))
    if not apart <= TOGETHER:
        yield f"has a corner {apart:.3g} mm away from where it is expected"
