"""From the faces of panels to samples: exact surface points and normals, spread evenly by area.

Each face gets a grid in its parameters whose lines are spaced evenly along the surface, with a sample in the middle of
every cell. A trimmed face keeps the samples that lie inside. The faces of all panels are worked on together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.faces.arc_length_grid import (
    Strides,
    are_uneven,
    even_lines,
    laid_anew,
    lines_by_spans,
    measure_chords,
    measure_strides,
    summed,
)
from cadpanel.brep.faces.area import trimmed_areas, whole_areas
from cadpanel.brep.faces.boundary import Edge, sample_edges, unit_normals
from cadpanel.brep.faces.inside_test import InsideTest
from cadpanel.brep.faces.surface_batch import SurfaceBatch
from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.brep.kernel.splines import breaks_of, spans_of
from cadpanel.reference.model import FaceSamples

SAMPLES_PER_PANEL = 125
FEWEST_SAMPLES_PER_FACE = 9
# Grid lines each way on which a face is measured before it is sampled.
MEASURING_GRID = 5
# Where the speed along the lines changes by more than this factor, the face is measured again on a finer grid.
SPEED_RATIO = 1.5
FINE_MEASURING_GRID = 25
# Where it still does by more than this factor, the fine grid's lines are laid anew, evenly by length, so many times.
WILD_RATIO = 4.0
LAID_ANEW = 4
# How closely a boundary must follow the border of the parameter range for the face to count as untrimmed,
# as a part of that range.
BORDER = 1e-6
# Samples of an untrimmed face add up to its area where what they stand for differs by no more than this part between
# them, and it has no more spans than lines it was measured on; else it is integrated.
EVEN = 1e-4
# A trimmed face's grid has this many times the wanted samples at most, where only a small part of it lies inside.
LARGEST_GRID = 40


@dataclass(frozen=True, slots=True)
class _MeasuredFaces:
    """F faces with what is needed to lay a grid on each.

    Attributes:
        faces: the kernel's faces.
        adaptors: their surfaces as the kernel has them.
        surfaces: the same, evaluated together.
        sides: (F,) -1 where a face is reversed against its surface, else 1.
        bounds: (F, 2, 2) least and largest parameter, by u and v.
        lines: two times (F, FINE_MEASURING_GRID + 1): rising parts of the parameter range, from 0 to 1.
        reach: two times (F, FINE_MEASURING_GRID + 1): the length walked along u (and v) on the surface up to each of
            these lines, mm.
        edges: their boundaries.
        trimmed: (F,) whether the boundary cuts into the parameter range.
        areas: (F,) mm^2.
        full_areas: (F,) the areas of the whole parameter ranges, mm^2.
    """

    faces: list[TopoDS_Face]
    adaptors: list[BRepAdaptor_Surface]
    surfaces: SurfaceBatch
    sides: Array
    bounds: Array
    lines: tuple[Array, Array]
    reach: tuple[Array, Array]
    edges: list[list[Edge]]
    trimmed: BoolArray
    areas: Array
    full_areas: Array


def sample_faces(shape: TopoDS_Shape) -> tuple[FaceSamples, ...]:
    """Return the samples of all faces of one panel's shape, in the shape's order, mm.

    A face without area has no samples; what to say about it is left to the caller.
    """
    (samples,) = sample_panels([shape])
    return samples


def sample_panels(shapes: Sequence[TopoDS_Shape]) -> list[tuple[FaceSamples, ...]]:
    """Return the same for each of several panels, worked out together."""
    faces = [(panel, face) for panel, shape in enumerate(shapes) for face in faces_of(shape)]
    found: list[list[FaceSamples]] = [[] for _ in shapes]
    if faces:
        panels = np.array([panel for panel, _ in faces])
        measured = _measure([face for _, face in faces])
        whole = np.bincount(panels, measured.areas)[panels]
        parts = np.divide(measured.areas, whole, out=np.zeros(len(faces)), where=whole > 0.0)
        for (panel, _), samples in zip(faces, _sample(measured, SAMPLES_PER_PANEL * parts), strict=True):
            found[panel].append(samples)
    return [tuple(samples) for samples in found]


def _measure(faces: list[TopoDS_Face]) -> _MeasuredFaces:
    """Measure faces on a coarse grid, and on a fine one where that does not do."""
    adaptors = [BRepAdaptor_Surface(face) for face in faces]
    surfaces = SurfaceBatch(adaptors)
    sides = np.array([-1.0 if face.Orientation() == TopAbs_REVERSED else 1.0 for face in faces])
    bounds = np.array(
        [[[on.FirstUParameter(), on.LastUParameter()], [on.FirstVParameter(), on.LastVParameter()]] for on in adaptors]
    )
    edges = sample_edges(faces, surfaces, bounds, sides)
    lines, steps, full_areas = _walk(surfaces, adaptors, bounds)
    trimmed = _are_trimmed(edges, bounds)
    areas = full_areas.copy()
    cut = np.flatnonzero(trimmed)
    areas[cut] = trimmed_areas(faces, surfaces, cut, bounds)
    return _MeasuredFaces(
        faces=faces,
        adaptors=adaptors,
        surfaces=surfaces,
        sides=sides,
        bounds=bounds,
        lines=lines,
        reach=(summed(steps[0]), summed(steps[1])),
        edges=edges,
        trimmed=trimmed,
        areas=areas,
        full_areas=full_areas,
    )


def _walk(
    surfaces: SurfaceBatch, adaptors: Sequence[BRepAdaptor_Surface], bounds: Array
) -> tuple[tuple[Array, Array], tuple[Array, Array], Array]:
    """Lines across whole parameter ranges of F faces, the lengths of the steps between them, and the areas, mm^2.

    Returns:
        Two times (F, FINE_MEASURING_GRID + 1) lines as in `_MeasuredFaces`, two times (F, FINE_MEASURING_GRID) lengths,
        mm, and (F,) areas.
    """
    coarse = measure_strides(surfaces, np.arange(len(adaptors)), bounds, even_lines(len(adaptors), MEASURING_GRID))
    # The steps of the coarse grid are cut into equal parts.
    parts = FINE_MEASURING_GRID // MEASURING_GRID
    steps_u, steps_v = (np.repeat(speeds / parts, parts, axis=1) for speeds in coarse.speeds)
    lines, steps, areas = even_lines(len(adaptors), FINE_MEASURING_GRID), (steps_u, steps_v), coarse.areas

    def take(chosen: IntArray, found: Strides) -> None:
        areas[chosen] = found.areas
        for way in (0, 1):
            steps[way][chosen] = found.speeds[way]

    chosen = np.flatnonzero(are_uneven(coarse, SPEED_RATIO))
    fine = measure_strides(surfaces, chosen, bounds[chosen], (lines[0][chosen], lines[1][chosen]))
    take(chosen, fine)
    wild = chosen[are_uneven(fine, WILD_RATIO)]
    for attempt in range(LAID_ANEW):
        if not len(wild):
            break
        for way in (0, 1):
            # A spline's knots lie closer where it is fast, mostly.
            lines[way][wild] = (
                laid_anew(lines[way][wild], steps[way][wild])
                if attempt
                else [lines_by_spans(breaks_of(adaptors[face], way), FINE_MEASURING_GRID) for face in wild.tolist()]
            )
        found = measure_chords(surfaces, wild, bounds[wild], (lines[0][wild], lines[1][wild]))
        take(wild, found)
        wild = wild[are_uneven(found, WILD_RATIO)]
    return lines, steps, areas


def _are_trimmed(edges: list[list[Edge]], bounds: Array) -> BoolArray:
    """Tell for each face whether any part of its boundary runs inside the parameter range, not along its border."""
    trimmed = np.zeros(len(edges), dtype=bool)
    owners = np.array([face for face, own in enumerate(edges) for edge in own for _ in edge.parameters], dtype=np.intp)
    if len(owners):
        parameters = np.concatenate([edge.parameters for own in edges for edge in own])
        margin = BORDER * (bounds[:, :, 1] - bounds[:, :, 0])
        on_border = np.abs(parameters[:, :, None] - bounds[owners]) <= margin[owners][:, :, None]
        trimmed[owners[~on_border.any(axis=(1, 2))]] = True
    return trimmed


def _sample(measured: _MeasuredFaces, wanted: Array) -> list[FaceSamples]:
    """Sample each face with about `wanted` (F,) points."""
    counts = _grid_sizes(measured, wanted)
    sizes = counts.prod(axis=1)
    owners = np.repeat(np.arange(len(sizes)), sizes)
    place = np.arange(len(owners)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    rank_u, rank_v = np.divmod(place, counts[owners, 1])
    middles, widths = np.empty((len(owners), 2)), np.empty((len(owners), 2))
    for way, rank in enumerate((rank_u, rank_v)):
        low, high = (_even_border(measured, way, owners, (rank + k) / counts[owners, way]) for k in range(2))
        middles[:, way], widths[:, way] = 0.5 * (low + high), high - low
    spans = measured.bounds[:, :, 1] - measured.bounds[:, :, 0]
    parameters = measured.bounds[owners, :, 0] + middles * spans[owners]
    points, along_u, along_v = measured.surfaces.evaluate(owners, parameters)
    normals, lengths, keep = unit_normals(along_u, along_v, owners)
    normals *= measured.sides[owners, None]
    weights = widths.prod(axis=1) * spans.prod(axis=1)[owners] * lengths
    weights *= _corrections(measured, owners, weights * keep, lengths)[owners]
    found = []
    for face, (stop, size) in enumerate(zip(np.cumsum(sizes).tolist(), sizes.tolist(), strict=True)):
        own = slice(stop - size, stop)
        if measured.trimmed[face]:
            keep[own] &= InsideTest(measured.faces[face], measured.bounds[face]).inside(parameters[own])
            covered = weights[own][keep[own]].sum()
            weights[own] *= measured.areas[face] / covered if covered > 0.0 else 1.0
        kept = own if keep[own].all() else np.flatnonzero(keep[own]) + own.start
        found.append(
            FaceSamples(
                points=points[kept],
                normals=normals[kept],
                weights=weights[kept],
                edges=tuple(edge.points for edge in measured.edges[face]),
                edge_normals=tuple(edge.normals for edge in measured.edges[face]),
            )
        )
    return found


def _corrections(measured: _MeasuredFaces, owners: IntArray, weights: Array, speeds: Array) -> Array:
    """(F,) factors that make weights add up to the areas of untrimmed faces; 1 for trimmed ones.

    Args:
        measured: F faces.
        owners: (p,) the face of each sample, rising.
        weights: (p,) mm^2.
        speeds: (p,) |Su x Sv| there.
    """
    sums = np.bincount(owners, weights)
    starts = np.flatnonzero(np.diff(owners, prepend=-1))
    most, least = np.maximum.reduceat(speeds, starts), np.minimum.reduceat(speeds, starts)
    many = np.array([max(spans_of(surface)) > MEASURING_GRID for surface in measured.adaptors])
    chosen = np.flatnonzero((many | (most - least > EVEN * most)) & ~measured.trimmed & (sums > 0.0))
    factors = np.ones(len(sums))
    factors[chosen] = whole_areas(measured.surfaces, measured.adaptors, chosen) / sums[chosen]
    return factors


def _grid_sizes(measured: _MeasuredFaces, wanted: Array) -> IntArray:
    """(F, 2) cells by u and v for about `wanted` (F,) samples of each face."""
    wanted = np.maximum(wanted, FEWEST_SAMPLES_PER_FACE)
    cut = measured.trimmed & (measured.areas > 0.0)
    excess = np.divide(measured.full_areas, measured.areas, out=np.ones_like(wanted), where=cut)
    wanted = wanted * np.clip(excess, 1.0, LARGEST_GRID)
    length_u, length_v = (reach[:, -1] for reach in measured.reach)
    aspect = np.divide(length_u, length_v, out=np.ones_like(wanted), where=(length_u > 0.0) & (length_v > 0.0))
    count_u = np.maximum(2, np.round(np.sqrt(wanted * aspect)))
    count_v = np.maximum(2, np.round(wanted / count_u))
    return np.stack([count_u, count_v], axis=1).astype(np.intp)


def _even_border(measured: _MeasuredFaces, way: int, owners: IntArray, parts: Array) -> Array:
    """Return the parts of their parameter ranges up to which (p,) faces have been walked to `parts` of their length.

    Args:
        measured: F faces.
        way: along u (0) or v (1).
        owners: (p,) faces.
        parts: (p,) from 0 to 1.
    """
    reach, lines = measured.reach[way], measured.lines[way]
    steps = reach.shape[1] - 1
    walked = parts * reach[owners, -1]
    before = np.clip((reach[owners] <= walked[:, None]).sum(axis=1) - 1, 0, steps - 1)
    start, stop = reach[owners, before], reach[owners, before + 1]
    within = np.divide(walked - start, stop - start, out=np.zeros_like(walked), where=stop > start)
    even = reach[owners, -1] <= 0.0
    first, last = lines[owners, before], lines[owners, before + 1]
    return np.where(even, parts, first + within * (last - first))
