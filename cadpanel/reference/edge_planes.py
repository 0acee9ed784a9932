"""The planes in which the drawing's edges lie, as cuts through the skin: by them the turn of a fitted edge is told."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cadpanel.arrays import Array, BoolArray
from cadpanel.geometry.vectors import cross, dot, norm, unit
from cadpanel.reference.model import PanelReference, Reference

# An edge that bends out of its chord by this share of it tells its plane's tilt half and half; one that is straighter
# lies in the plane that is square to the skin.
_BENT = 0.01


def edge_planes(panels: Sequence[PanelReference]) -> tuple[Array, Array]:
    """Unit normals (panels, edges, 3) of the planes of all edges, and the edges' lengths (panels, edges), mm.

    A plane goes through both ends of its edge, and leans as the edge does where that bends out of the skin; rows are
    filled up with zeros where a panel has fewer edges than another one.
    """
    most = max(len(panel.edges) for panel in panels)
    normals, lengths = np.zeros((len(panels), most, 3)), np.zeros((len(panels), most))
    places: dict[int, list[tuple[int, int]]] = {}
    for i, panel in enumerate(panels):
        for place, edge in enumerate(panel.edges):
            places.setdefault(len(edge), []).append((i, place))
    for of in places.values():
        lines = np.array([panels[i].edges[place] for i, place in of])
        skins = np.array([panels[i].edge_normals[place] for i, place in of])
        rows, columns = np.array(of, dtype=np.intp).T
        normals[rows, columns] = _normals(lines, skins)
        lengths[rows, columns] = norm(np.diff(lines, axis=1)).sum(axis=1)
    return normals, lengths


def turned_edges(reference: Reference) -> BoolArray:
    """(panels, most edges) which edges may not turn: the ends of panels that have some, and all that lie on a seam."""
    panels = reference.panels
    limited = np.zeros((len(panels), max(len(panel.edges) for panel in panels)), dtype=np.bool_)
    limited[[i for i, panel in enumerate(panels) if panel.four_sided], :2] = True
    for seam in reference.seams:
        limited[list(seam.panels), list(seam.edges)] = True
    return limited


def _normals(lines: Array, skins: Array) -> Array:
    """(e, 3) of lines (e, q, 3) on skins with the normals (e, q, 3).

    In the axes chord, square to it in the skin (t), out of the skin (n) the plane is t + tilt n = 0: the tilt is that
    of least squares, drawn to 0 where the line hardly leaves the chord.
    """
    chords = lines[:, -1] - lines[:, 0]
    along = unit(chords)
    out = skins.sum(axis=1)
    out = unit(out - dot(out, along)[:, None] * along)
    square = cross(out, along)
    off = lines - lines[:, :1]
    t, n = (np.einsum("eqx,ex->eq", off, axis) for axis in (square, out))
    spare = lines.shape[1] * (_BENT * norm(chords)) ** 2
    tilt = -np.sum(t * n, axis=1) / np.where(spare > 0.0, np.sum(n * n, axis=1) + spare, 1.0)
    return unit(square + tilt[:, None] * out)
