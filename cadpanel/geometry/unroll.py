"""Panels unrolled into the plane: outline, tangent lines and rulings, exactly, for many panels at once.

The plane is looked at from outside: x runs across the panel, the way of the walk, and y along it, from end 0 to end 1.
Whichever parallel surface is asked for is the one that keeps its lengths: the middle of the sheet, or the one that a
K-factor says.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import singledispatch
from typing import Any

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.flat_curves import FlatCurves, joined, segments
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.unroll_chains import unroll_chain_arrays
from cadpanel.geometry.unroll_trays import flat_tray
from cadpanel.geometry.vectors import cross, unit


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatBend:
    """Where a flat pattern is rolled or folded.

    Attributes:
        patch: which patch of the panel.
        at_ends: the pieces of the pattern in which it meets end 0 and end 1.
        sweep: angle of the bend, radians; positive where the sheet turns away from the viewer, who is outside.
    """

    patch: int
    at_ends: tuple[int, int]
    sweep: float


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatPattern:
    """A panel as a flat sheet, seen from outside; millimetres.

    Attributes:
        name: the panel's.
        feature: name of its shape feature.
        curves: c pieces of the outline, counterclockwise from the corner of side 0 and end 0.
        edges: (c) the edge that each belongs to: "end 0", "side 1", ...; of a polygon "edge 0", "edge 1", ...; or
            "corner 0" and so on, what belongs to a relief.
        owners: (c) the patch that each belongs to.
        tangents: (k - 1, 2, 2) the rulings between patches, from end 0 to end 1.
        bends: the curved patches in the order of the walk.
    """

    name: str
    feature: str
    curves: FlatCurves
    edges: tuple[str, ...]
    owners: tuple[int, ...]
    tangents: Array
    bends: tuple[FlatBend, ...] = ()

    def __repr__(self) -> str:
        return f"<FlatPattern '{self.name}': {self.feature}, {len(self.owners)} edges, {len(self.bends)} bends>"

    def rulings(self, bend: FlatBend, shares: Array) -> Array:
        """(q, 2, 2) rulings of a bend, from end 0 to end 1, at shares (q,) of the sweep that it has at both."""
        pieces = self.curves.take(np.array(bend.at_ends))
        u = np.broadcast_to(shares, (2, len(shares)))
        if pieces.curved.all():
            way = np.sign(pieces.sweep[0])
            begin = way * np.max(way * pieces.first)
            whole = way * np.min(way * (pieces.first + pieces.sweep)) - begin
            u = (begin + shares * whole - pieces.first[:, None]) / pieces.sweep[:, None]
        return np.swapaxes(pieces.points(np.where(pieces.backward[:, None], 1.0 - u, u)), 0, 1)


def neutral_offset(shape: Panel, thickness: float, skin_side: SkinSide = "outer", k_factor: float = 0.5) -> float:
    """Distance in mm along the outward normal from a panel's skin to the surface that keeps its lengths.

    Args:
        shape: the panel's skin.
        thickness: of the sheet, mm.
        skin_side: "outer" where the sheet lies inside of the skin.
        k_factor: distance of that surface from the inner face of the bends, as a share of the thickness.

    Raises:
        PanelError: the panel bends both ways and the share is not one half: no one parallel surface would do.
    """
    ways = {np.sign(patch.radius) for patch in shape.patches if isinstance(patch, ConePatch)}
    if len(ways) > 1 and k_factor != 0.5:
        raise PanelError(
            shape.name,
            f"it bends both ways, so that no one surface lies at {k_factor:g} of the thickness from the inner face of "
            "every bend; give a K-factor of 0.5.",
        )
    from_inside = 1.0 - k_factor if ways == {-1.0} else k_factor
    return (from_inside - 1.0 if skin_side == "outer" else from_inside) * thickness


def unroll(shape: Panel, offset: float = 0.0) -> FlatPattern:
    """The flat pattern of the surface parallel to a panel's skin at `offset` mm along its outward normals.

    Raises:
        TypeError: nobody has said how panels of this kind are unrolled.
    """
    return unroll_all([shape], np.array([offset]))[0]


def unroll_all(shapes: Sequence[Panel], offsets: Array) -> list[FlatPattern]:
    """The flat patterns of many panels, of each at its own offset (m,); alike panels are unrolled together.

    Raises:
        TypeError: nobody has said how panels of this kind are unrolled.
    """
    alike: dict[tuple[Unroller, int], list[int]] = {}
    for place, shape in enumerate(shapes):
        alike.setdefault((unroller(shape), shape.corners().shape[1]), []).append(place)
    found: dict[int, FlatPattern] = {}
    for (unrolled, _), places in alike.items():
        own = [shapes[place].offset(float(offsets[place])) for place in places]
        found |= dict(zip(places, unrolled(own), strict=True))
    return [found[place] for place in range(len(shapes))]


Unroller = Callable[[Sequence[Any]], Sequence[FlatPattern]]
"""Unrolls panels of one kind, all with as many corners."""


@singledispatch
def unroller(shape: Panel) -> Unroller:
    """How panels of a kind are unrolled; one entry for each kind.

    Raises:
        TypeError: nobody has said how panels of this kind are unrolled.
    """
    raise TypeError(f"no flat pattern is known for a panel like {shape!r}: register one for its class")


def unroll_polygons(shapes: Sequence[PolygonShape]) -> list[FlatPattern]:
    """Polygons with their first edge along x."""
    outlines, normals = np.array([shape.outline for shape in shapes]), np.array([shape.normal for shape in shapes])
    x_axis = unit(outlines[:, 1] - outlines[:, 0])
    axes = np.stack([x_axis, cross(normals, x_axis)], axis=-1)
    flat = (outlines - outlines[:, :1]) @ axes
    return [
        FlatPattern(
            name=shape.name,
            feature=shape.feature,
            curves=segments(corners, np.roll(corners, -1, axis=0)),
            edges=tuple(f"edge {edge}" for edge in range(len(corners))),
            owners=len(corners) * (0,),
            tangents=np.empty((0, 2, 2)),
        )
        for shape, corners in zip(shapes, flat, strict=True)
    ]


def unroll_chains(shapes: Sequence[PanelShape]) -> list[FlatPattern]:
    """Chains of as many patches each, their first ruling along y, with its place at end 0 in the origin."""
    flat = unroll_chain_arrays(shapes)
    return [
        _pattern(
            shape,
            flat.corners[i],
            [end.take(slice(i, None, len(shapes))) for end in flat.ends],
            [side.take(slice(i, i + 1)) for side in flat.sides],
        )
        for i, shape in enumerate(shapes)
    ]


def _pattern(shape: PanelShape, corners: Array, ends: Sequence[FlatCurves], sides: Sequence[FlatCurves]) -> FlatPattern:
    """From corners (2, k + 1, 2) and the pieces along ends and sides to a pattern."""
    count = len(shape.patches)
    bends = tuple(
        FlatBend(patch=index, at_ends=(index, 2 * count - index), sweep=abs(patch.sweep) * float(np.sign(patch.radius)))
        for index, patch in enumerate(shape.patches)
        if isinstance(patch, ConePatch)
    )
    return FlatPattern(
        name=shape.name,
        feature=shape.feature,
        curves=joined([ends[0], sides[1], ends[1], sides[0]]),
        edges=(*count * ("end 0",), "side 1", *count * ("end 1",), "side 0"),
        owners=(*range(count), count - 1, *reversed(range(count)), 0),
        tangents=np.swapaxes(corners[:, 1:-1], 0, 1),
        bends=bends,
    )


def unroll_trays(shapes: Sequence[TrayShape]) -> list[FlatPattern]:
    """Folded flat panels with their first edge along x."""
    found = []
    for shape in shapes:
        flat = flat_tray(shape)
        bends = tuple(FlatBend(patch=patch, at_ends=at_ends, sweep=sweep) for patch, at_ends, sweep in flat.bends)
        found.append(
            FlatPattern(
                name=shape.name,
                feature=shape.feature,
                curves=flat.outline(),
                edges=tuple(flat.edges),
                owners=tuple(flat.owners),
                tangents=np.array(flat.tangents).reshape(-1, 2, 2),
                bends=bends,
            )
        )
    return found


unroller.register(PolygonShape, lambda _: unroll_polygons)
unroller.register(PanelShape, lambda _: unroll_chains)
unroller.register(TrayShape, lambda _: unroll_trays)
