"""Chains rolled out ruling by ruling, a batch at a time: where rulings lie in the plane, and what their ends become."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.flat_curves import FlatCurves, joined, segments
from cadpanel.geometry.panel import Chain
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_sides import SideCurve, end_spans, side_curves
from cadpanel.geometry.vectors import cross, dot, unit


class ChainArrays(NamedTuple):
    """m chains of k patches each.

    Attributes:
        p, t, n, b: (m, k + 1, 3) the rulings' points, directions, normals and ways of the walk.
        radius, half_angle, sweep: (m, k) of the patches; 0 for a plane.
        cut_points, cut_normals: (m, 2, 3).
        lift: (m,) of the skins that these cut.
        spans: (m, 2, k, 2) angles between which the ends run over the patches.
        sides: (m, 2) the curves of sides that stand in planes, None of others.
    """

    p: Array
    t: Array
    n: Array
    b: Array
    radius: Array
    half_angle: Array
    sweep: Array
    cut_points: Array
    cut_normals: Array
    lift: Array
    spans: Array
    sides: list[tuple[SideCurve | None, SideCurve | None]]


def chain_arrays(shapes: Sequence[Chain]) -> ChainArrays:
    """Chains of as many patches each, as arrays."""
    numbers = np.array(
        [
            [
                (patch.radius, patch.half_angle, patch.sweep) if isinstance(patch, ConePatch) else (0.0, 0.0, 0.0)
                for patch in shape.patches
            ]
            for shape in shapes
        ]
    )
    t, n = (np.array([getattr(shape, of) for shape in shapes]) for of in ("directions", "normals"))
    return ChainArrays(
        p=np.array([shape.points for shape in shapes]),
        t=t,
        n=n,
        b=cross(t, n),
        radius=numbers[..., 0],
        half_angle=numbers[..., 1],
        sweep=numbers[..., 2],
        cut_points=np.array([shape.cut_points for shape in shapes]),
        cut_normals=np.array([shape.cut_normals for shape in shapes]),
        lift=np.array([shape.lift for shape in shapes]),
        spans=np.array([end_spans(shape) for shape in shapes]),
        sides=[side_curves(shape) for shape in shapes],
    )


class FlatChains(NamedTuple):
    """m chains in the plane.

    Attributes:
        corners: (m, 2, k + 1, 2).
        ends: the m k pieces along end 0 and along end 1; these run backwards, from the last patch to the first. Piece i
            of chain j stands in row i * m + j.
        sides: the m pieces along side 0, which run backwards, and along side 1.
    """

    corners: Array
    ends: tuple[FlatCurves, FlatCurves]
    sides: tuple[FlatCurves, FlatCurves]


def unroll_chain_arrays(shapes: Sequence[Chain]) -> FlatChains:
    """Chains of as many patches each, rolled out."""
    of = chain_arrays(shapes)
    origin, along = _flat_rulings(of)
    cut = of.p + of.lift[:, None, None] * of.n
    heights = dot(of.cut_points[:, :, None] - cut[:, None], of.cut_normals[:, :, None])
    heights = heights / dot(of.t[:, None], of.cut_normals[:, :, None])
    origin -= (origin[:, 0] + heights[:, 0, 0, None] * along[:, 0])[:, None]
    corners = origin[:, None] + heights[..., None] * along[:, None]
    sides = _side_pieces(of, origin, along, corners, 0), _side_pieces(of, origin, along, corners, 1)
    ends = _end_pieces(of, origin, along, corners, 0), _end_pieces(of, origin, along, corners, 1)
    return FlatChains(corners, ends, sides)


def _side_pieces(of: ChainArrays, origin: Array, along: Array, corners: Array, side: int) -> FlatCurves:
    """The pieces along a side; of those that stand in planes the corners are moved to where their planes are."""
    straight = segments(corners[:, 0, -side], corners[:, 1, -side])
    patch = 0 if side == 0 else of.radius.shape[1] - 1
    found = []
    for row, sides in enumerate(of.sides):
        curve, one = sides[side], straight.take(slice(row, row + 1))
        if curve is not None:
            level, sine = of.radius[row, patch] * np.cos(of.half_angle[row, patch]), np.sin(of.half_angle[row, patch])
            one = replace(
                one,
                origin=origin[row : row + 1, patch],
                along=along[row : row + 1, patch],
                level_radius=np.array([level]),
                sine=np.array([sine]),
                first=curve.heights[:1],
                sweep=np.diff(curve.heights),
                reach=curve.section.reach,
                rate=curve.section.rate,
                way_out=np.array([curve.way_out]),
            )
            corners[row, :, -side] = one.points(np.array([[0.0, 1.0]]))[0]
        found.append(one)
    pieces = joined(found)
    start, stop = corners[:, 0, -side], corners[:, 1, -side]
    if side == 0:
        return replace(pieces, start=stop, stop=start, backward=np.ones(len(pieces), dtype=bool))
    return replace(pieces, start=start, stop=stop)


def _flat_rulings(of: ChainArrays) -> tuple[Array, Array]:
    """Points and directions (m, k + 1, 2) of the rulings in the plane, the first one along y."""
    origin = np.zeros((*of.p.shape[:2], 2))
    along = np.zeros_like(origin)
    along[:, 0, 1] = 1.0
    for patch in range(of.radius.shape[1]):
        here, after = along[:, patch], patch + 1
        across = np.stack([here[:, 1], -here[:, 0]], axis=-1)
        step, turn = _step(of, patch)
        along[:, after] = unit(turn[:, :1] * across + turn[:, 1:] * here)
        origin[:, after] = origin[:, patch] + step[:, :1] * across + step[:, 1:2] * here + step[:, 2:] * along[:, after]
    return origin, along


def _step(of: ChainArrays, patch: int) -> tuple[Array, Array]:
    """From ruling to ruling over a patch, across and along the first one.

    Returns:
        (m, 3) where the point of the next one lies: across, along, and along itself; (m, 2) its direction.
    """
    p, t, n, b = (rulings[:, patch] for rulings in (of.p, of.t, of.n, of.b))
    next_p, next_t = of.p[:, patch + 1], of.t[:, patch + 1]
    half_angle, sweep = of.half_angle[:, patch], of.sweep[:, patch]
    cosine, k = np.cos(half_angle)[:, None], np.sin(half_angle)[:, None]
    level = of.radius[:, patch, None] * cosine
    radial, axis = cosine * n + k * t, cosine * t - k * n
    turned = np.cos(sweep)[:, None] * radial + np.sin(sweep)[:, None] * b
    slip = dot(next_p - (p + level * (turned - radial)), cosine * axis + k * turned)
    theta = k[:, 0] * sweep
    rolled = np.stack(
        [
            level[:, 0] * sweep * np.sinc(theta / np.pi),
            -0.5 * level[:, 0] * theta * sweep * np.sinc(0.5 * theta / np.pi) ** 2,
            slip,
        ],
        axis=-1,
    )
    way = next_p - p
    flat = np.stack([dot(way, b), dot(way, t), np.zeros(len(p))], axis=-1)
    bent = (sweep != 0.0)[:, None]
    return np.where(bent, rolled, flat), np.where(
        bent, np.stack([np.sin(theta), np.cos(theta)], axis=-1), np.stack([dot(next_t, b), dot(next_t, t)], axis=-1)
    )


def _end_pieces(of: ChainArrays, origin: Array, along: Array, corners: Array, end: int) -> FlatCurves:
    """The pieces along an end, patch by patch; along end 1 backwards."""
    p, t, n, b = (rulings[:, :-1] for rulings in (of.p, of.t, of.n, of.b))
    m, q = of.cut_normals[:, end, None], of.cut_points[:, end, None]
    cosine, k = np.cos(of.half_angle), np.sin(of.half_angle)
    level = of.radius * cosine
    radial = cosine[..., None] * n + k[..., None] * t
    axis = cosine[..., None] * t - k[..., None] * n
    rise, toward, aside = dot(m, axis), dot(m, radial), dot(m, b)
    cut = p + of.lift[:, None, None] * n
    cut_level = level + of.lift[:, None] * cosine
    reach = np.stack([dot(m, q - cut) + cut_level * toward, -cut_level * toward, -cut_level * aside], axis=-1)
    rate = np.stack([cosine * rise, k * toward, k * aside], axis=-1)
    order = slice(None, None, -1 if end else 1)
    start, stop = (corners[:, end, :-1], corners[:, end, 1:])[:: -1 if end else 1]

    def rows(values: Array) -> Array:
        turned = np.swapaxes(values, 0, 1)[order]
        return turned.reshape(-1, *turned.shape[2:])

    return FlatCurves(
        start=rows(start),
        stop=rows(stop),
        origin=rows(origin[:, :-1]),
        along=rows(along[:, :-1]),
        level_radius=rows(level),
        sine=rows(k),
        first=rows(of.spans[:, end, :, 0]),
        sweep=rows(of.spans[:, end, :, 1] - of.spans[:, end, :, 0]),
        reach=rows(reach),
        rate=rows(rate),
        backward=np.full(of.sweep.size, end == 1),
        way_out=np.zeros(of.sweep.size),
    )
