"""Panels as flat parts: blank, mass, stock, bevels, and what a press or roller needs to know of each bend."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.file_names import file_names
from cadpanel.delivery.panel_fixings import PanelFixings, panel_fixings
from cadpanel.delivery.records.blanks import BendModel, BlankModel, FixingModel, Pair
from cadpanel.delivery.records.from_shape import radius_ranges, vector
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.bevels import edge_bevels
from cadpanel.geometry.flat_curves import joined
from cadpanel.geometry.flat_sizes import FlatSize, flat_sizes
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch, Patch
from cadpanel.geometry.plane_sides import side_curves
from cadpanel.geometry.sheet_checks import other_face
from cadpanel.geometry.smallest_rectangle import Rectangle
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.unroll import FlatBend, FlatPattern, neutral_offset, unroll_all
from cadpanel.geometry.vectors import cross, unit

ALL = "all"
"""The drawing with all parts, beside those of the panels."""
# A number of facets this close below a whole one is that one.
_SAME_COUNT = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatPart:
    """A panel's flat pattern and its numbers.

    Attributes:
        pattern: of the surface that keeps its lengths.
        size: its exact numbers.
        blank: what the report says of it.
        bends: what it says of its bends.
        bevels: of each edge, as the report says them, degrees.
        share: where that surface lies, from the skin into the sheet, a part of the thickness.
        skin_pieces: lengths of all pieces of the skin's own outline, unrolled, mm.
        fixings: its holes; None where none are asked for.
    """

    pattern: FlatPattern
    size: FlatSize
    blank: BlankModel
    bends: tuple[BendModel, ...]
    bevels: dict[str, Pair]
    share: float
    skin_pieces: Array
    fixings: PanelFixings | None = None

    @property
    def circles(self) -> Array:
        """(h, 3) its holes on the pattern: their middles and diameters, mm."""
        if self.fixings is None:
            return np.empty((0, 3))
        middles = self.fixings.middles
        return np.column_stack([middles, np.full(len(middles), self.fixings.rule.diameter)])

    @property
    def holes(self) -> tuple[FixingModel, ...]:
        """What the report says of its holes."""
        if self.fixings is None:
            return ()
        found = []
        for hole in self.fixings.found.holes:
            (point,), (normal,) = self.fixings.places[hole.patch].on_skin(hole.place[None])
            x, y = hole.place.tolist()
            found.append(
                FixingModel(edge=hole.edge, patch=hole.patch, flat=(x, y), point=vector(point), normal=vector(normal))
            )
        return tuple(found)


def flat_parts(shapes: Sequence[Panel], sheet: SheetSettings, shop: ShopSettings) -> tuple[FlatPart, ...]:
    """Every panel, as it is built, as a flat part.

    Raises:
        PanelError: a panel bends both ways, and the K-factor is not 0.5.
    """
    offsets = np.array([neutral_offset(shape, sheet.thickness, sheet.skin_side, shop.k_factor) for shape in shapes])
    patterns = unroll_all(shapes, offsets)
    skins = unroll_all(shapes, np.zeros(len(shapes)))
    lengths = joined([skin.curves for skin in skins]).lengths()
    skin_pieces = np.split(lengths, np.cumsum([len(skin.curves) for skin in skins])[:-1])
    names = file_names([shape.name for shape in shapes], shop.dxf_name_length, taken=[ALL])
    return tuple(
        FlatPart(
            pattern=pattern,
            size=size,
            blank=BlankModel(
                width=size.blank.length,
                height=size.blank.width,
                area=size.area,
                edges=size.edges,
                stock=_stock(size.blank, shop),
                file=name,
            ),
            bends=_bends(shape, pattern, size, sheet, shop),
            bevels=_bevels(shape, sheet),
            share=abs(offset) / sheet.thickness,
            skin_pieces=pieces,
            fixings=panel_fixings(shape, sheet, shop),
        )
        for shape, pattern, size, name, offset, pieces in zip(
            shapes, patterns, flat_sizes(patterns), names, offsets.tolist(), skin_pieces, strict=True
        )
    )


def _bevels(shape: Panel, sheet: SheetSettings) -> dict[str, Pair]:
    found = edge_bevels(shape, other_face(shape, sheet.thickness, sheet.skin_side))
    return {edge: (math.degrees(least), math.degrees(largest)) for edge, (least, largest) in found.items()}


def _stock(blank: Rectangle, shop: ShopSettings) -> str | None:
    """The smallest sheet that will do."""
    fitting = [sheet for sheet in shop.stock if blank.fits(*sheet)]
    return None if not fitting else sheet_name(min(fitting, key=lambda sheet: (sheet[0] * sheet[1], sheet)))


def sheet_name(sheet: tuple[float, float]) -> str:
    """A sheet of the stock as it was asked for."""
    return f"{sheet[0]:g}x{sheet[1]:g}"


def _bends(
    shape: Panel, pattern: FlatPattern, size: FlatSize, sheet: SheetSettings, shop: ShopSettings
) -> tuple[BendModel, ...]:
    if not pattern.bends:
        return ()
    faces = [radius_ranges(face) for face in (shape, other_face(shape, sheet.thickness, sheet.skin_side))]
    angles = _end_angles(shape)
    return tuple(
        _bend(bend, shape.patches[bend.patch], [face[bend.patch] for face in faces], size, angles, shop.facet_height)
        for bend in pattern.bends
    )


def _bend(
    bend: FlatBend, patch: Patch, faces: Sequence[Pair | None], size: FlatSize, angles: Array, facet_height: float
) -> BendModel:
    """A bend as the inner one of the sheet's two faces has it; `faces` are their radii there."""
    inner = min((radii for radii in faces if radii is not None), key=lambda radii: radii[1])
    first, last = bend.at_ends
    sweep = abs(bend.sweep)
    angles = angles[:, bend.patch] * np.sign(bend.sweep)
    # The edge turns by nearly as much as the sheet does: whole turns are known from there.
    turns = 2.0 * math.pi * np.round((sweep - angles) / (2.0 * math.pi))
    return BendModel(
        patch=bend.patch,
        direction="down" if bend.sweep > 0.0 else "up",
        radius=inner,
        half_angle=math.degrees(abs(patch.half_angle)) if isinstance(patch, ConePatch) else 0.0,
        sweep=math.degrees(sweep),
        lengths=(size.pieces[first], size.pieces[last]),
        angles=(math.degrees(angles[0] + turns[0]), math.degrees(angles[1] + turns[1])),
        hits=press_hits(inner[1], sweep, facet_height),
    )


def press_hits(radius: float, sweep: float, facet_height: float) -> int:
    """Strokes of a press brake, so that facets between them stay within a height of the arc of that radius, mm."""
    if facet_height >= radius:
        return 1
    facet = 2.0 * math.acos(1.0 - facet_height / radius)
    return max(1, math.ceil(sweep / facet - _SAME_COUNT))


def _end_angles(shape: Panel) -> Array:
    """(2, k) angles by which the edge turns over each patch about the normals of end 0's and end 1's cut, radians."""
    if isinstance(shape, TrayShape):
        # Its folds end square to themselves.
        sweeps = [patch.sweep if isinstance(patch, ConePatch) else 0.0 for patch in shape.patches]
        return np.array([sweeps, sweeps])
    _, _, normals = shape.rulings()
    _, cut_normals = shape.cuts()
    ends = np.tile(normals, (2, 1, 1))
    for side, curve in enumerate(side_curves(shape)):
        if curve is not None:
            ends[:, -side] = curve.frame.normals(curve.corners)
    ways = unit(cross(ends, np.broadcast_to(cut_normals[:, None], ends.shape)))
    cosines = (ways[:, :-1] * ways[:, 1:]).sum(axis=-1)
    sines = (cross(ways[:, :-1], ways[:, 1:]) * cut_normals[:, None]).sum(axis=-1)
    return np.asarray(np.arctan2(sines, cosines))
