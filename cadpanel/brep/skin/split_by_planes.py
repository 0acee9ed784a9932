"""A surface cut by planes across it, and which piece lies between which two of them.

A face that fills its parameter range is cut by curves in its parameter plane, solved for point by point: on long faces
the kernel's own intersections break into pieces or are missing (of 99 planes through a face of 200 m, 24). Any other
face goes through the kernel's splitter. Either way every piece is held against its two planes.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Pln
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.faces.boundary import evaluate
from cadpanel.brep.faces.face_patch import Patch, patch_of
from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.kernel import points as kernel
from cadpanel.brep.kernel.splines import breaks_of
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.splitting.split_along_edges import split_along
from cadpanel.brep.splitting.split_by_pcurves import edge_across, slice_patch
from cadpanel.brep.splitting.splitter import UncutError, split_faces
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.vectors import unit

# Lines of the grid on which a face is evaluated to find where planes cross it, across and along the strip.
LINES_ACROSS = 33
LINES_ALONG = 129
# Lines in a span of a spline that lies between two of them, and as which part of the range two of them are one.
LINES_A_SPAN = 17
SAME_LINE = 1e-9
NEWTON_STEPS = 30
# By how much of a cell on either side a crossing in it is looked for.
WIDER = 0.1
# A crossing has been found when its point is this close to the plane, mm.
ON_PLANE = 1e-7
# A border this close to a plane lies in it and is not cut, mm.
IN_PLANE = 0.01
# The range of a trimmed face reaches over its border, and so do the curves across it: up to so many times the reach.
OVER_THE_BORDER = 1.5
# How far a piece may reach through a plane that bounds it, mm.
THROUGH = 0.02
# How often a point's place among the planes is corrected by the planes themselves.
CORRECTIONS = 3


def cut_by_planes(surface: Surface, cuts: Cuts, source: str) -> list[list[TopoDS_Face]]:
    """Cut a surface by k planes into k + 1 groups of faces.

    Raises:
        ReferenceFileError: a plane does not cut the surface from border to border, or the kernel leaves a face uncut.
    """
    groups: list[list[TopoDS_Face]] = [[] for _ in range(len(cuts.origins) + 1)]
    for face in surface.faces:
        for place, piece in pieces_of(face.patch, cuts, f"face {face.number} of '{source}'"):
            groups[place].append(piece)
    empty = next((index for index, group in enumerate(groups) if not group), None)
    if empty is not None:
        last = len(cuts.origins)
        where = {0: "Before the first cut", last: "Beyond the last cut"}.get(
            empty, f"Between cuts {empty} and {empty + 1}"
        )
        raise ReferenceFileError(
            f"{where} of {last} there is nothing of the surface of {surface.numbers} of '{source}': give fewer cuts, "
            "or cuts that lie on the surface."
        )
    return groups


def pieces_of(patch: Patch, cuts: Cuts, what: str) -> list[tuple[int, TopoDS_Face]]:
    """The pieces into which planes cut a patch, each with its place among them.

    Args:
        patch: any.
        cuts: the planes.
        what: the patch, for messages.

    Raises:
        ReferenceFileError: the kernel leaves it uncut.
    """
    first, last = _reached(patch, cuts)
    sliced = _sliced(patch, cuts, first, last)
    return _split(patch, cuts, first, last, what) if sliced is None else sliced


def _split(patch: Patch, cuts: Cuts, first: int, last: int, what: str) -> list[tuple[int, TopoDS_Face]]:
    """The pieces of a patch that the kernel splits off by planes, each with its place.

    Where it misses a plane, as on long tapered faces by a tenth of a millimetre and more, it is given the curves along
    which the planes cross the patch.

    Raises:
        ReferenceFileError: it leaves the patch uncut either way.
    """
    if first == last:
        return [(_place_of_piece(patch.face, cuts, what), patch.face)]
    planes = [_plane_face(cuts, index) for index in range(first, last)]
    try:
        pieces = split_faces([patch.face], planes, what).faces[0]
        return [(_place_of_piece(piece, cuts, what), piece) for piece in pieces]
    except ReferenceFileError:
        curves = _curves(patch, cuts, first, last)
        if curves is None:
            raise
    pieces = split_along([patch.face], curves, what).faces[0]
    return [(_place_of_piece(piece, cuts, what), piece) for piece in pieces]


def _curves(patch: Patch, cuts: Cuts, first: int, last: int) -> list[TopoDS_Edge] | None:
    """The curves along which planes cross the surface over a patch's range; None where one does not cross all of it."""
    normals = cuts.normals[first:last]
    axis = _axis_through(patch, cuts)
    across = _lines_across(patch, axis)
    reach = OVER_THE_BORDER * cuts.reach[first:last]
    found = _crossings(patch, axis, across, cuts.origins[first:last], normals, reach)
    return None if found is None else [edge_across(patch, axis, across, own) for own in found[1]]


def places_of(points: Array, cuts: Cuts) -> IntArray:
    """Between which planes (m, 3) points lie: 0 before the first one, k behind the last one."""
    _, nearest = cKDTree(cuts.line).query(points)
    count = len(cuts.origins)
    places = np.clip(cuts.places[nearest].astype(np.intp), 0, count)
    for _ in range(CORRECTIONS):
        behind = np.minimum(places, count - 1)
        ahead = np.sum((points - cuts.origins[behind]) * cuts.normals[behind], axis=1) > 0.0
        before = np.maximum(places - 1, 0)
        back = np.sum((points - cuts.origins[before]) * cuts.normals[before], axis=1) < 0.0
        step = np.where(ahead & (places < count), 1, np.where(back & (places > 0), -1, 0))
        if not step.any():
            break
        places = places + step
    return places


def _reached(patch: Patch, cuts: Cuts) -> tuple[int, int]:
    """The range of planes that may cut a patch."""
    if not patch.edges:
        return 0, len(cuts.origins)
    places = places_of(np.concatenate([edge.points for edge in patch.edges]), cuts)
    return max(0, int(places.min()) - 1), min(len(cuts.origins), int(places.max()) + 1)


def _sliced(patch: Patch, cuts: Cuts, first: int, last: int) -> list[tuple[int, TopoDS_Face]] | None:
    """The pieces of a whole patch that its planes cut from border to border, each with its place; None for others."""
    if not patch.whole or not patch.edges:
        return None
    chosen = slice(first, last)
    origins, normals, reach = cuts.origins[chosen], cuts.normals[chosen], cuts.reach[chosen]
    axis = _axis_through(patch, cuts)
    across = _lines_across(patch, axis)
    crossings = _crossings(patch, axis, across, origins, normals, reach)
    if crossings is None:
        return None
    cut, parts = crossings
    if not cut.any():
        middle = patch.points(patch.at(axis, np.array([0.5]), np.array([0.5])))
        place = int(places_of(middle, cuts)[0])
        border = np.concatenate([edge.points for edge in patch.edges])
        return [(place, patch.face)] if _pierced(border, place, cuts) is None else None
    numbers = np.flatnonzero(cut)
    if len(numbers) != numbers[-1] - numbers[0] + 1:
        return None
    rising = parts[0].mean() <= parts[-1].mean()
    ordered = parts if rising else parts[::-1]
    if (np.diff(ordered, axis=0) <= 0.0).any() or (ordered <= 0.0).any() or (ordered >= 1.0).any():
        return None
    pieces = slice_patch(patch, axis, across, ordered)
    if len(numbers) == 1:
        rising = _rises(patch, axis, float(parts[0].mean()), normals[numbers[0]])
    start = first + int(numbers[0])
    places = range(start, start + len(pieces))
    return list(zip(places if rising else reversed(places), pieces, strict=True))


def _axis_through(patch: Patch, cuts: Cuts) -> int:
    """The parameter that runs along the line which the planes cross, rather than along the planes."""
    grid = np.linspace(0.1, 0.9, 5)
    points, *along = evaluate(patch.surface, patch.at(0, grid[:, None], grid[None, :]))
    ways = unit(np.gradient(cuts.line, axis=0))[cKDTree(cuts.line).query(points)[1]]
    through = [
        np.abs(np.sum(vectors * ways, axis=-1)).mean() / max(np.linalg.norm(vectors, axis=-1).mean(), 1e-300)
        for vectors in along
    ]
    return int(through[1] > through[0])


def _lines_across(patch: Patch, axis: int) -> Array:
    """(w,) rising parts of the other parameter's range at which cuts are solved for: even ones, closer in short spans.

    A spline may do in a hundredth of its range what it does in all the rest, as where it begins on another one's edge.
    """
    even = np.linspace(0.0, 1.0, LINES_ACROSS)
    low, high = patch.bounds[1 - axis]
    breaks = np.clip((breaks_of(patch.surface, 1 - axis) - low) / (high - low), 0.0, 1.0)
    short = [pair for pair in pairwise(breaks.tolist()) if SAME_LINE < pair[1] - pair[0] < even[1]]
    lines = np.unique(np.concatenate([even, *(np.linspace(first, last, LINES_A_SPAN) for first, last in short)]))
    return np.asarray(lines[np.concatenate([np.diff(lines) > SAME_LINE, [True]])])


def _rises(patch: Patch, axis: int, part: float, normal: Array) -> bool:
    """Whether a patch goes through a plane along its parameter, at a part of the range where it crosses it."""
    _, *along = evaluate(patch.surface, patch.at(axis, np.array([part]), np.array([0.5])))
    return bool(along[axis][0] @ normal > 0.0)


def _crossings(
    patch: Patch, axis: int, across: Array, origins: Array, normals: Array, reach: Array
) -> tuple[BoolArray, Array] | None:
    """Where planes cross the parameter lines of a patch.

    Returns:
        (k,) which planes cross all the lines, and for those (c, w) at which part of the range; None where a plane
        crosses some of the lines and not the others, or one of them more than once.
    """
    along = np.linspace(0.0, 1.0, LINES_ALONG)
    grid = patch.points(patch.at(axis, along[None, :], across[:, None]))
    cut = np.zeros(len(origins), dtype=np.bool_)
    cells = np.zeros((len(origins), len(across)), dtype=np.intp)
    for index, (origin, normal, far) in enumerate(zip(origins, normals, reach, strict=True)):
        offsets = grid - origin
        heights = offsets @ normal
        for border, beside in ((0, 1), (-1, -2)):
            if np.abs(heights[:, border]).max() <= IN_PLANE:
                heights[:, border] = np.sign(heights[:, beside])
        near = np.einsum("wsd,wsd->ws", offsets, offsets) - heights**2 <= far**2
        change = ((heights[:, 1:] > 0.0) != (heights[:, :-1] > 0.0)) & near[:, 1:] & near[:, :-1]
        counts = change.sum(axis=1)
        if (counts == 1).all():
            cut[index], cells[index] = True, change.argmax(axis=1)
        elif counts.any():
            return None
    found = _refined(patch, axis, across, along, cells[cut], origins[cut], normals[cut])
    return None if found is None else (cut, found)


def _refined(
    patch: Patch, axis: int, across: Array, along: Array, cells: IntArray, origins: Array, normals: Array
) -> Array | None:
    """Solve for the crossings within their cells by Newton's method, kept inside by bisection: (c, w)."""
    low, high = along[cells], along[cells + 1]
    parts = 0.5 * (low + high)
    # A plane may pass through the end of a cell, and which side that lies on is a matter of the last bit.
    low, high = np.maximum(low - WIDER * along[1], 0.0), np.minimum(high + WIDER * along[1], 1.0)
    lines = np.broadcast_to(across, parts.shape)
    start = _heights(patch, axis, low, lines, origins, normals)[0]
    for _ in range(NEWTON_STEPS):
        heights, slopes = _heights(patch, axis, parts, lines, origins, normals)
        if np.abs(heights).max(initial=0.0) <= ON_PLANE:
            return parts
        below = (heights > 0.0) == (start > 0.0)
        low, high = np.where(below, parts, low), np.where(below, high, parts)
        with np.errstate(divide="ignore", invalid="ignore"):
            wanted = parts - heights / slopes
        inside = (wanted > low) & (wanted < high)
        parts = np.where(inside, wanted, 0.5 * (low + high))
    return None if np.abs(heights).max(initial=0.0) > 100.0 * ON_PLANE else parts


def _heights(
    patch: Patch, axis: int, parts: Array, lines: Array, origins: Array, normals: Array
) -> tuple[Array, Array]:
    """Heights over the planes and their slopes along the parameter, each (c, w)."""
    points, along_u, along_v = evaluate(patch.surface, patch.at(axis, parts, lines))
    tangents = (along_u if axis == 0 else along_v) * np.ptp(patch.bounds[axis])
    heights = np.einsum("cwd,cd->cw", points - origins[:, None], normals)
    return heights, np.einsum("cwd,cd->cw", tangents, normals)


def _plane_face(cuts: Cuts, index: int) -> TopoDS_Face:
    far = float(cuts.reach[index])
    plane = gp_Pln(kernel.point(cuts.origins[index]), kernel.direction(cuts.normals[index]))
    return BRepBuilderAPI_MakeFace(plane, -far, far, -far, far).Face()


def _beside(place: int, cuts: Cuts) -> list[int]:
    """The planes that bound a place among them."""
    return [plane for plane in (place - 1, place) if 0 <= plane < len(cuts.origins)]


def _place_of_piece(piece: TopoDS_Face, cuts: Cuts, what: str) -> int:
    """The place of a piece that the kernel split off, once its boundary is seen to keep between its two planes."""
    patch = patch_of(piece)
    points = np.concatenate([edge.points for edge in patch.edges])
    place = int(np.bincount(places_of(points, cuts)).argmax())
    if any(np.abs((points - cuts.origins[one]) @ cuts.normals[one]).max() <= THROUGH for one in _beside(place, cuts)):
        # All its boundary lies in one plane, like that of half a ball: its inside tells on which side.
        inside = np.concatenate([samples.points for samples in sample_faces(piece)])
        place = int(np.bincount(places_of(inside, cuts)).argmax())
    pierced = _pierced(points, place, cuts)
    if pierced is not None:
        x, y, z = cuts.origins[pierced]
        raise UncutError(f"The CAD kernel leaves {what} uncut at ({x:.1f}, {y:.1f}, {z:.1f}).")
    return place


def _pierced(points: Array, place: int, cuts: Cuts) -> int | None:
    """The plane on whose other side some of (m, 3) points of a place lie; None where there is none."""
    for plane, sign in ((place - 1, -1.0), (place, 1.0)):
        if 0 <= plane < len(cuts.origins):
            heights = sign * ((points - cuts.origins[plane]) @ cuts.normals[plane])
            if heights.max() > THROUGH:
                return plane
    return None
