"""How far one walks on faces from line to line of their parameters, and how to lay the lines at even lengths."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.brep.faces.surface_batch import SurfaceBatch
from cadpanel.geometry.vectors import cross, norm

# Places across a face at which chords are measured.
ACROSS = 5


class Strides(NamedTuple):
    """Two times (F, k) lengths of the steps along u (and v) on the surface, mm; and (F,) areas, mm^2."""

    speeds: tuple[Array, Array]
    areas: Array


def even_lines(faces: int, steps: int) -> tuple[Array, Array]:
    """Two times (faces, steps + 1) parts of the parameter range at even steps."""
    return np.tile(np.linspace(0.0, 1.0, steps + 1), (faces, 1)), np.tile(np.linspace(0.0, 1.0, steps + 1), (faces, 1))


def are_uneven(measured: Strides, ratio: float) -> BoolArray:
    """(F,) whether the steps of each face differ in length by more than a factor."""
    return np.asarray(np.any([steps.max(axis=1) > ratio * steps.min(axis=1) for steps in measured.speeds], axis=0))


def lines_by_spans(breaks: Array, steps: int) -> Array:
    """(steps + 1,) parts of the range from the first to the last of rising breaks, spread evenly over the spans."""
    even = np.linspace(0.0, len(breaks) - 1.0, steps + 1)
    parts = (breaks - breaks[0]) / (breaks[-1] - breaks[0])
    return np.asarray(np.interp(even, np.arange(len(breaks)), parts), dtype=np.float64)


def laid_anew(lines: Array, steps: Array) -> Array:
    """(f, k + 1) lines at even lengths, by the (f, k) lengths of the steps between them so far."""
    reach = summed(steps)
    even = np.linspace(0.0, 1.0, lines.shape[1])
    found = [np.interp(even * own[-1], own, places) for own, places in zip(reach, lines, strict=True)]
    return np.array(found)


def measure_strides(surfaces: SurfaceBatch, faces: IntArray, bounds: Array, lines: tuple[Array, Array]) -> Strides:
    """Measure whole parameter ranges of f faces by the middles between (f, k + 1) lines each way."""
    middles = [0.5 * (own[:, :-1] + own[:, 1:]) for own in lines]
    count = middles[0].shape[1]
    parts = np.stack([np.repeat(middles[0], count, axis=1), np.tile(middles[1], (1, count))], axis=-1)
    spans = bounds[:, :, 1] - bounds[:, :, 0]
    _, along_u, along_v = surfaces.evaluate(faces[:, None], bounds[:, None, :, 0] + parts * spans[:, None])
    steps_u, steps_v = (np.diff(own, axis=1) * spans[:, [way]] for way, own in enumerate(lines))
    speeds_u = steps_u * norm(along_u).reshape(-1, count, count).mean(axis=2)
    speeds_v = steps_v * norm(along_v).reshape(-1, count, count).mean(axis=1)
    densities = norm(cross(along_u, along_v)).reshape(-1, count, count)
    return Strides((speeds_u, speeds_v), np.einsum("fuv,fu,fv->f", densities, steps_u, steps_v))


def measure_chords(surfaces: SurfaceBatch, faces: IntArray, bounds: Array, lines: tuple[Array, Array]) -> Strides:
    """The same, with lengths as the mean distance of points on neighbouring lines.

    That is a little short where a face bends, but where the speed grows without bounds at a border, the speed in the
    middle of a step tells nothing of its length.
    """
    found = []
    spans = bounds[:, :, 1] - bounds[:, :, 0]
    for way in (0, 1):
        along = np.repeat(lines[way][:, :, None], ACROSS, axis=2)
        across = np.broadcast_to((np.arange(ACROSS) + 0.5) / ACROSS, along.shape)
        parts = np.stack([along, across] if way == 0 else [across, along], axis=-1)
        points, _, _ = surfaces.evaluate(
            faces[:, None, None], bounds[:, None, None, :, 0] + parts * spans[:, None, None]
        )
        found.append(norm(np.diff(points, axis=1)).mean(axis=2))
    return Strides((found[0], found[1]), measure_strides(surfaces, faces, bounds, lines).areas)


def summed(steps: Array) -> Array:
    """(F, k + 1) lengths walked after none, one, two, ... of (F, k) steps."""
    return np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)
