"""How many panels a grid needs each way for none to be larger than allowed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cadpanel.arrays import Array, IntArray
from cadpanel.brep.cutting.by_grid import AVERAGED, least_count, line_parts
from cadpanel.brep.cutting.fewest import fewest
from cadpanel.brep.faces.face_patch import INTERVALS, Patch, lengths_along
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.reference.settings import By


def counts_within(surface: Surface, size: tuple[float, float], by: By, source: str) -> list[tuple[int, int]]:
    """The fewest panels along u and v of every face, of which none is larger than so many by so many mm.

    Faces that share a border have as many panels along it, so that these meet corner to corner; where one face runs
    along it by u and the other by v, they keep to the smaller of the two sizes.

    Raises:
        SettingsError: there would be too many.
    """
    groups = _run_together(surface)
    counts = np.ones(2 * len(surface.faces), dtype=np.intp)
    for group in range(int(groups.max()) + 1):
        members = np.flatnonzero(groups == group).tolist()
        patches = [(surface.faces[member // 2].patch, member % 2) for member in members]
        most = min(size[axis] for _, axis in patches)
        numbers = ", ".join(str(surface.faces[member // 2].number) for member in members)
        what = f"parameter {'uv'[members[0] % 2]} of face {numbers} of '{source}'"
        reaches = [(patch, axis, lengths_along(patch, axis, AVERAGED)) for patch, axis in patches]
        whole = max(float(reach[:, -1].max()) for _, _, reach in reaches)
        count = fewest(partial(_largest_of, reaches, by), whole, most, what)
        counts[members] = max(count, *(least_count(patch, axis)[0] for patch, axis in patches))
    return [(int(u), int(v)) for u, v in counts.reshape(-1, 2)]


def _largest_of(reaches: Sequence[tuple[Patch, int, Array]], by: By, count: int) -> float:
    """The largest of so many parts of any of several parameters, mm."""
    return max(_largest(patch, axis, reach, count, by) for patch, axis, reach in reaches)


def _largest(patch: Patch, axis: int, reach: Array, count: int, by: By) -> float:
    """The largest of so many parts along a parameter on any of the lines that were walked, mm."""
    parts = line_parts(patch, axis, count, by)
    even = np.linspace(0.0, 1.0, INTERVALS + 1)
    return max(float(np.diff(np.interp(parts, even, line)).max()) for line in reach)


def _run_together(surface: Surface) -> IntArray:
    """(2 faces,) a number for u and v of every face, the same for two that run along a border between their faces."""
    pairs = [
        tuple(2 * face + _way_along(surface.faces[face].patch, contact.point) for face in contact.faces)
        for contact in surface.contacts
    ]
    first, second = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
    nodes = 2 * len(surface.faces)
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(nodes, nodes))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.intp)


def _way_along(patch: Patch, point: Array) -> int:
    """Which parameter changes along the edge of a patch that is nearest to a point, 0 for u and 1 for v."""
    nearest = min(patch.edges, key=lambda edge: float(np.linalg.norm(edge.points - point, axis=1).min()))
    spans = np.ptp(nearest.parameters, axis=0) / np.ptp(patch.bounds, axis=1)
    return int(spans[1] > spans[0])
