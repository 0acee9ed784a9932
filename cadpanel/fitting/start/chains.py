"""Initial values from the reference alone: cut both ends into the chain's patches by their normals, roll cones between.

All panels of one feature at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.features.feature import Feature
from cadpanel.features.patches import DIMENSIONS
from cadpanel.features.walk import walk
from cadpanel.fitting.start.axes import turning_axes
from cadpanel.fitting.start.cone_strips import bends_in_cones, cone_strips
from cadpanel.fitting.start.frames import Frames, Given, reframe
from cadpanel.fitting.start.segmentation import (
    Profile,
    ambiguous,
    best_knots,
    curved_runs,
    cut_profile,
    without_blemishes,
)
from cadpanel.geometry.vectors import cross, dot
from cadpanel.reference.model import PanelReference
from cadpanel.reference.strip import end_planes
from cadpanel.reference.suitability import check_corners, check_fold

# A curved patch turns by at least this at the start, radians: where it turned by nothing its radius would be unknown.
_LEAST_SWEEP = 1e-3
# Places along an end at which its normals are looked at.
_PLACES = 65
# A fold below this angle (radians) cannot be told from a flat panel.
_LEAST_FOLD = np.radians(2.0)
# Half angles of the start stay below this, radians; the ends' widths tell them only roughly.
_STEEPEST = 0.3


def _check(panels: Sequence[PanelReference], source: str, feature: Feature) -> None:
    folds = sum(feature.curved)
    for panel in panels:
        check_corners(panel, source, feature.name)
        if folds:
            check_fold(panel, source, flanged=folds < len(feature.patches), folds=folds)


@dataclass(slots=True)
class _Ends:
    """Both ends of n panels of k patches: where patches begin and end, and by how much the normals turn on them.

    Attributes:
        points, normals: (n, 2, k + 1, 3) at the knots.
        middle, outward: (n, 2, 3) points and normals in the middle of the anchor patch.
        widths: (n, 2, k) mm along the end.
        sweeps: (n, k) radians.
    """

    points: Array
    normals: Array
    middle: Array
    outward: Array
    widths: Array
    sweeps: Array


def start_chains(feature: Feature, given: Given) -> Frames:
    """Frames and all numbers of chains; where their curved patches follow each other, in two ways.

    The other way are cones along a developable strip, see `cone_strips`, or where there is none, even parts.

    Raises:
        PanelError: a panel has no fold, or not the four corners, that its feature asks for.
    """
    panels, length = given.panels, given.length
    _check(panels, given.source, feature)
    axis = turning_axes(panels, given.samples)
    whole = np.array([panel.corners for panel in panels])
    found: Frames | None = None
    ways = given.ways if ambiguous(feature.curved) else 1
    for way, ends in enumerate(_cut_ends(panels, feature, axis, given.stretches, ways)):
        origins, axes, values = _roll(ends, panels, feature, length)
        if way > 0 and bends_in_cones(feature):
            _lay_cones(feature, given, axis, (origins, axes, values))
        if found is None:
            found = Frames(origins, axes, [])
        else:
            reframe(feature, values, (origins - found.origins) / length, axes, found.axes)
        values = _held(feature, values)
        corners = np.einsum("pesx,pxa->pesa", whole - found.origins[:, None, None], found.axes)
        _lay_flanges(corners / length, feature, values, panels)
        values = _held(feature, values)
        _lay_cuts(panels, feature, found, length, values)
        found.values.append(_held(feature, values))
    assert found is not None
    return found


def _roll(ends: _Ends, panels: Sequence[PanelReference], feature: Feature, length: float) -> tuple[Array, Array, Array]:
    """Frames in the middle of the anchor patches, and the numbers of all patches."""
    _refuse_without_fold(panels, feature, ends.sweeps)
    t = _unit(ends.middle[:, 1] - ends.middle[:, 0])
    n = _unit(_off(ends.outward.sum(axis=1), t))
    axes = np.stack([cross(t, n), t, n], axis=-1)
    origins = ends.middle.mean(axis=1)
    distance = np.linalg.norm(ends.points[:, 1] - ends.points[:, 0], axis=-1)
    values = np.zeros((len(panels), len(feature.numbers)))
    for i, curved in enumerate(feature.curved):
        widening = (ends.widths[:, 1, i] - ends.widths[:, 0, i]) / (0.5 * (distance[:, i] + distance[:, i + 1]))
        width = ends.widths[:, :, i].mean(axis=1)
        if curved:
            sweep = ends.sweeps[:, i]
            half_angle = np.clip(np.arctan(widening / sweep), -_STEEPEST, _STEEPEST)
            dimensions = np.stack([width / sweep / length, half_angle, sweep], axis=1)
        else:
            dimensions = np.stack([width / length, -np.arctan(widening)], axis=1)
        values[:, feature.patch_slice(i)] = _numbers_for(feature, i, dimensions, panels)
    return origins, axes, values


def _lay_cones(feature: Feature, given: Given, axis: Array, rolled: tuple[Array, Array, Array]) -> None:
    """Put cones along a strip in the place of what was rolled between the ends, where a panel has such cones."""
    origins, axes, values = rolled
    (run,) = curved_runs(feature.curved)
    for i, cones in enumerate(cone_strips(feature, given, axis)):
        if cones is None:
            continue
        origins[i], axes[i] = cones.origin, cones.axes
        for patch, own in zip(range(*run), cones.dimensions / np.array([given.length, 1.0, 1.0]), strict=True):
            values[i, feature.patch_slice(patch)] = _numbers_for(feature, patch, own[None], given.panels[i : i + 1])[0]


def _numbers_for(feature: Feature, patch: int, dimensions: Array, panels: Sequence[PanelReference]) -> Array:
    """(n, numbers) the numbers of one patch with these dimensions (n, d).

    Raises:
        PanelError: a patch of a user's own has no numbers for the dimensions that a panel asks for.
    """
    numbers = feature.patches[patch].numbers_for(dimensions)
    for panel, own, wanted in zip(panels, numbers, dimensions, strict=True):
        if not np.isfinite(own).all():
            told = ", ".join(
                f"{what} {value:.4g}"
                for what, value in zip(DIMENSIONS[feature.patches[patch].kind], wanted, strict=True)
            )
            raise PanelError(
                panel.name,
                f"patch {patch} of '{feature.name}' has no numbers for what the panel asks of it ({told}, lengths in "
                "panel lengths): let its 'numbers_for' give those nearest, or choose another feature",
            )
    return numbers


def _held(feature: Feature, values: Array) -> Array:
    """The values with fixed and tied numbers in their places, and the others within their bounds."""
    unknowns = np.clip(values[:, feature.free], *feature.bounds())
    return feature.expand(unknowns)


def _cut_ends(
    panels: Sequence[PanelReference], feature: Feature, axis: Array, stretches: Array, ways: int
) -> Iterator[_Ends]:
    """Both ends as their normals turn best, and then with even parts of their curved stretches."""
    lines, normals = _evenly(panels)
    count, _, places, _ = lines.shape
    n = _unit(_off(normals.sum(axis=(1, 2)), axis))
    b = cross(axis, n)
    turned = np.arctan2(np.einsum("peqx,px->peq", normals, b), np.einsum("peqx,px->peq", normals, n))
    turned = np.unwrap(turned, axis=2).reshape(2 * count, places)
    if sum(feature.curved) == 1:
        turned = without_blemishes(turned)
    lengths = np.linalg.norm(np.diff(lines, axis=2), axis=-1).sum(axis=2)
    held = stretches / lengths[..., None] * (places - 1)
    best = best_knots(turned, feature.curved)
    for way in range(ways):
        profile = cut_profile(turned, feature.curved, even=way > 0, held=held.reshape(-1, 2), best=best)
        yield _ends_at(profile, feature, lines, normals, lengths)


def _ends_at(profile: Profile, feature: Feature, lines: Array, normals: Array, lengths: Array) -> _Ends:
    """The ends (n, 2, q, 3) of these lengths (n, 2), mm, where they are cut."""
    count, _, places, _ = lines.shape
    knots = profile.knots.reshape(count, 2, -1)
    sweeps = np.diff(profile.angles.reshape(count, 2, -1).mean(axis=1), axis=1)
    sweeps = np.where(np.abs(sweeps) < _LEAST_SWEEP, np.where(sweeps < 0.0, -1.0, 1.0) * _LEAST_SWEEP, sweeps)
    middle = (0.5 * (knots[:, :, feature.anchor] + knots[:, :, feature.anchor + 1])).astype(np.float64)
    return _Ends(
        points=_at(lines, knots.astype(np.float64)),
        normals=_at(normals, knots.astype(np.float64)),
        middle=_at(lines, middle[..., None])[:, :, 0],
        outward=_at(normals, middle[..., None])[:, :, 0],
        widths=np.diff(knots, axis=2) * (lengths / (places - 1))[..., None],
        sweeps=sweeps,
    )


def _evenly(panels: Sequence[PanelReference]) -> tuple[Array, Array]:
    """Points and normals (n, 2, _PLACES, 3) at even distances along both ends."""
    lines, normals = np.empty((len(panels), 2, _PLACES, 3)), np.empty((len(panels), 2, _PLACES, 3))
    for i, panel in enumerate(panels):
        for end in (0, 1):
            line = panel.edges[end]
            reach = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
            places = np.interp(np.linspace(0.0, reach[-1], _PLACES), reach, np.arange(len(line), dtype=np.float64))
            low = np.minimum(places.astype(np.intp), len(line) - 2)
            share = (places - low)[:, None]
            for target, source in ((lines, line), (normals, panel.edge_normals[end])):
                target[i, end] = (1.0 - share) * source[low] + share * source[low + 1]
    return lines, _unit(normals)


def _at(lines: Array, places: Array) -> Array:
    """(n, 2, r, d) values of lines (n, 2, q, d) at places (n, 2, r) between 0 and q - 1."""
    low = np.clip(np.floor(places).astype(np.intp), 0, lines.shape[2] - 2)
    share = (places - low)[..., None]
    before = np.take_along_axis(lines, low[..., None], axis=2)
    after = np.take_along_axis(lines, low[..., None] + 1, axis=2)
    return np.asarray((1.0 - share) * before + share * after)


def _lay_flanges(corners: Array, feature: Feature, values: Array, panels: Sequence[PanelReference]) -> None:
    """Give outer flanges the width and the turn that bring their free edges through the corners (n, 2, 2, 3)."""
    edges = walk(feature, values, derivatives=False).edges
    last = len(feature.patches) - 1
    for side, (patch, ruling) in enumerate(((0, 1), (last, last))):
        if feature.curved[patch] or patch == feature.anchor:
            continue
        p, b, t = (getattr(edges, axis)[:, ruling, None] for axis in "pbt")
        out = corners[:, :, side] - p
        x, y = dot(out, b), dot(out, t)
        slope = (x[:, 1] - x[:, 0]) / (y[:, 1] - y[:, 0])
        way = 1.0 if side == 1 else -1.0
        dimensions = np.stack([way * (x[:, 0] - slope * y[:, 0]), -way * np.arctan(slope)], axis=1)
        values[:, feature.patch_slice(patch)] = _numbers_for(feature, patch, dimensions, panels)


def _lay_cuts(panels: Sequence[PanelReference], feature: Feature, frames: Frames, length: float, values: Array) -> None:
    """Lay each cut plane through the outline's end."""
    for end, where in enumerate(feature.cut_numbers):
        tilt = feature.numbers[where[2]].fixed is None
        lines = [
            (panel.ends[end] - origin) @ axes / length
            for panel, origin, axes in zip(panels, frames.origins, frames.axes, strict=True)
        ]
        positions, normals = end_planes(lines, tilt=tilt)
        values[:, where] = np.column_stack([positions, normals[:, 0], normals[:, 2]])
    if feature.tied:
        for number, source in feature.tied:
            values[:, source] = 0.5 * (values[:, source] + values[:, number])
    if feature.tied or feature.cuts == "square":
        corners = np.array([panel.corners for panel in panels]).mean(axis=2)
        local = np.einsum("pex,pxa->pea", corners - frames.origins[:, None], frames.axes) / length
        for end in (0, 1):
            skew, tilt_ = (values[:, feature.cut_numbers[0, k]] if feature.tied else 0.0 for k in (1, 2))
            values[:, feature.cut_numbers[end, 0]] = (
                local[:, end, 1] + skew * local[:, end, 0] + tilt_ * local[:, end, 2]
            )


def _refuse_without_fold(panels: Sequence[PanelReference], feature: Feature, sweeps: Array) -> None:
    """Refuse a panel whose curved patches, between flanges, turn by nothing that could be rolled."""
    if not any(feature.curved) or all(feature.curved):
        return
    folds = np.abs(np.where(feature.curved, sweeps, 0.0)).sum(axis=1)
    for panel, fold in zip(panels, folds, strict=True):
        if fold < _LEAST_FOLD:
            raise PanelError(
                panel.name,
                f"its faces turn by only {np.degrees(fold):.2f} degrees across the panel, which is no fold to roll; "
                "take it out of the file or give it a flat feature",
            )


def _off(vectors: Array, direction: Array) -> Array:
    return vectors - dot(vectors, direction)[..., None] * direction


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
