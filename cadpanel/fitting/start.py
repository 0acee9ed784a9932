"""Initial values from the reference alone: find the flanges and the blend by their normals, roll a cone between them.

All panels at once; panels with fewer samples than others are padded with samples of weight 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.errors import PanelError, SettingsError
from cadpanel.features.feature import Feature
from cadpanel.features.walk import walk
from cadpanel.geometry.frames import cross, dot
from cadpanel.reference.model import Reference

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# Share of the fold over which normals have turned where a flange ends and where the blend's middle begins.
_FLANGE_SHARE = 0.15
_BLEND_SHARE = 0.2
# A fold below this angle (radians) cannot be told from a flat panel.
_LEAST_FOLD = np.radians(2.0)
_LEAST_WEIGHT = 1e-12
# An end that is nearly straight does not tell its plane's tilt: singular values below this share are left out.
_LEAST_SINGULAR = 1e-6


@dataclass(frozen=True, slots=True)
class SampleArrays:
    """All panels' samples, padded to one length.

    Attributes:
        points, normals: (panels, m, 3), mm.
        weights: (panels, m) mm^2, 0 for padding.
    """

    points: Array
    normals: Array
    weights: Array

    @staticmethod
    def of(reference: Reference) -> SampleArrays:
        """Stack the panels of a reference."""
        panels = reference.panels
        most = max(len(panel.points) for panel in panels)
        points, normals = np.empty((len(panels), most, 3)), np.empty((len(panels), most, 3))
        weights = np.zeros((len(panels), most))
        for i, panel in enumerate(panels):
            own = len(panel.points)
            points[i, :own], normals[i, :own], weights[i, :own] = panel.points, panel.normals, panel.weights
            points[i, own:], normals[i, own:] = panel.points[0], panel.normals[0]
        return SampleArrays(points, normals, weights)


@dataclass(frozen=True, slots=True)
class Start:
    """Where the fit begins.

    Attributes:
        origins: (panels, 3) a point on the middle of each fold, mm.
        axes: (panels, 3, 3) columns b, t, n: across the fold, along it, outwards.
        values: (panels, N) all numbers of the feature, lengths in units of `length`.
        length: mm, the mean length of a panel.
    """

    origins: Array
    axes: Array
    values: Array
    length: float


def start(reference: Reference, feature: Feature, samples: SampleArrays) -> Start:
    """First values for a chain plane - curved - plane.

    Raises:
        PanelError: a panel has no fold that could be told from a flat panel.
        SettingsError: the feature is another chain.
    """
    if [patch.kind == "plane" for patch in feature.patches] != [True, False, True]:
        raise SettingsError(f"no starting values are known for the feature '{feature.name}'")
    fold = _find_fold(reference, samples)
    length = float(np.mean([panel.length for panel in reference.panels]))
    values = np.zeros((len(reference.panels), len(feature.numbers)))
    curved = feature.patch_slice(1).start
    values[:, curved] = fold.radius / length
    if feature.numbers[curved + 1].fixed is None:
        values[:, curved + 1] = np.arctan(fold.taper)
        _tilt_to_taper(fold)
    values[:, curved + 2] = fold.angle
    result = Start(fold.origin, np.stack([fold.b, fold.t, fold.n], axis=-1), values, length)
    _lay_flanges(reference, feature, result)
    _lay_cuts(reference, feature, result)
    return result


@dataclass(slots=True)
class _Fold:
    """Per panel: a frame on the middle ruling, the fold angle, the normal radius there and how it grows along t."""

    origin: Array
    b: Array
    t: Array
    n: Array
    angle: Array
    radius: Array
    taper: Array


def _find_fold(reference: Reference, samples: SampleArrays) -> _Fold:
    corners = np.array([panel.corners for panel in reference.panels])
    chord = _unit(corners[:, 1].mean(axis=1) - corners[:, 0].mean(axis=1))
    lower = _unit(np.mean([[n[0] for n in panel.end_normals] for panel in reference.panels], axis=1))
    upper = _unit(np.mean([[n[-1] for n in panel.end_normals] for panel in reference.panels], axis=1))
    # Twice: the first flanges come from the outline's corners, the second from all samples on them.
    for _ in range(2):
        n = _unit(_off(lower + upper, chord))
        b = cross(chord, n)
        turning = np.arctan2(_along(samples.normals, b), _along(samples.normals, n))
        low, high = (np.arctan2(dot(v, b), dot(v, n)) for v in (lower, upper))
        share = (turning - low[:, None]) / (high - low)[:, None]
        on_lower, on_upper = samples.weights * (share < _FLANGE_SHARE), samples.weights * (share > 1 - _FLANGE_SHARE)
        lower, upper = (_mean_normal(samples, w, old) for w, old in ((on_lower, lower), (on_upper, upper)))
    angle = np.arctan2(np.linalg.norm(cross(lower, upper), axis=-1), dot(lower, upper))
    for panel, fold in zip(reference.panels, angle, strict=True):
        if fold < _LEAST_FOLD:
            raise PanelError(
                panel.name,
                f"its faces turn by only {np.degrees(fold):.2f} degrees across the panel, which is no fold to roll; "
                "take it out of the file or give it a flat feature",
            )
    t = _unit(cross(lower, upper))
    t *= np.sign(dot(t, chord))[:, None]
    n = _unit(_off(lower + upper, t))
    b = cross(t, n)
    origin, radius, taper = _roll(samples, share, (on_lower, on_upper), (lower, upper), t, angle)
    return _Fold(origin, b, t, n, angle, radius, taper)


def _roll(
    samples: SampleArrays, share: Array, on: tuple[Array, Array], normals: tuple[Array, Array], t: Array, angle: Array
) -> tuple[Array, Array, Array]:
    """Origin on the middle ruling, normal radius and taper from the blend's arc width and the two flange planes."""
    centre = _weighted_mean(samples.points, samples.weights)
    z = np.einsum("pmx,px->pm", samples.points - centre[:, None], t)
    middle = np.abs(share - 0.5) < 0.5 - _BLEND_SHARE
    extent = np.ptp(z, axis=1) * (1.0 + 1.0 / np.sqrt(np.maximum(1, z.shape[1])))
    arc = (1.0 - 2.0 * _BLEND_SHARE) * angle

    def radius_over(half: BoolArray, length: Array) -> Array:
        radii: Array = np.sum(samples.weights * (middle & half), axis=1) / (arc * length)
        return radii

    before, after = radius_over(z < 0, 0.5 * extent), radius_over(z >= 0, 0.5 * extent)
    radius = np.maximum(0.5 * (before + after), 1e-3 * extent)
    # The taper from two coarse halves is only a hint; the fit finds it.
    taper = np.clip(0.5 * (after - before) / (0.5 * extent), -0.2, 0.2)
    # Tangent to both flange planes: its axis lies at the distance of the radius under both.
    points = [_weighted_mean(samples.points, weights) for weights in on]
    rows = np.stack([normals[0], normals[1], t], axis=1)
    right = np.stack(
        [dot(normals[0], points[0]) - radius, dot(normals[1], points[1]) - radius, dot(t, centre)], axis=-1
    )
    axis_point = np.linalg.solve(rows, right[..., None])[..., 0]
    outward = _unit(_off(normals[0] + normals[1], t))
    return axis_point + radius[:, None] * outward, radius, taper


def _tilt_to_taper(fold: _Fold) -> None:
    """Turn the middle ruling about b so that a cone that widens stays tangent to both flanges."""
    slope = fold.taper * (1.0 / np.cos(0.5 * fold.angle) - 1.0)
    fold.t = _unit(fold.t - slope[:, None] * fold.n)
    fold.n = _unit(_off(fold.n, fold.t))


def _lay_flanges(reference: Reference, feature: Feature, start_: Start) -> None:
    """Give both flanges the width and the turn that bring their free edges through the reference's corners."""
    corners = _local(np.array([panel.corners for panel in reference.panels]), start_)
    edges = walk(feature, start_.values, derivatives=False).edges
    for side, (patch, ruling) in enumerate(((0, 0), (len(feature.patches) - 1, -1))):
        p, b, t = (getattr(edges, axis)[:, ruling, None] for axis in "pbt")
        out = corners[:, :, side] - p
        x, y = dot(out, b), dot(out, t)
        slope = (x[:, 1] - x[:, 0]) / (y[:, 1] - y[:, 0])
        at_foot = x[:, 0] - slope * y[:, 0]
        way = 1.0 if side == 1 else -1.0
        where = feature.patch_slice(patch).start
        start_.values[:, where] = way * at_foot
        start_.values[:, where + 1] = -way * np.arctan(slope)


def _lay_cuts(reference: Reference, feature: Feature, start_: Start) -> None:
    """Lay each cut plane through the outline's end."""
    for end in (0, 1):
        where = feature.cut_slice(end).start
        free = feature.numbers[where + 2].fixed is None
        for i, panel in enumerate(reference.panels):
            local = (panel.ends[end] - start_.origins[i]) @ start_.axes[i] / start_.length
            position, normal = end_plane(local, tilt=free)
            start_.values[i, where : where + 3] = position, normal[0], normal[2]


def end_plane(line: Array, *, tilt: bool) -> tuple[float, Array]:
    """The plane m . x = position through an end by least squares, m = (skew, 1, tilt), tilt 0 unless it is wanted.

    `line` (q, 3) runs along the end, in the axes b, t, n of a panel.
    """
    columns = [0, 2] if tilt else [0]
    matrix = np.column_stack([np.ones(len(line)), -line[:, columns]])
    solution = np.linalg.lstsq(matrix, line[:, 1], rcond=_LEAST_SINGULAR)[0]
    return float(solution[0]), np.array([solution[1], 1.0, solution[2] if tilt else 0.0])


def _local(points: Array, start_: Start) -> Array:
    shifted = points - start_.origins[:, None, None]
    local: Array = np.einsum("pesx,pxa->pesa", shifted, start_.axes) / start_.length
    return local


def _mean_normal(samples: SampleArrays, weights: Array, otherwise: Array) -> Array:
    total = np.einsum("pm,pmx->px", weights, samples.normals)
    found = weights.sum(axis=1) > _LEAST_WEIGHT
    return np.where(found[:, None], _unit(np.where(found[:, None], total, otherwise)), otherwise)


def _weighted_mean(points: Array, weights: Array) -> Array:
    mean: Array = np.einsum("pm,pmx->px", weights, points) / np.maximum(weights.sum(axis=1), _LEAST_WEIGHT)[:, None]
    return mean


def _along(vectors: Array, direction: Array) -> Array:
    components: Array = np.einsum("pmx,px->pm", vectors, direction)
    return components


def _off(vectors: Array, direction: Array) -> Array:
    return vectors - dot(vectors, direction)[..., None] * direction


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
