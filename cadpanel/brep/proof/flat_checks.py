"""Flat patterns against the solids and skins in the files: the areas that they unroll, and the lengths of edges.

The surface at a share x of the sheet's thickness, counted from the skin, has an area that is a quadratic in x (lengths
along a generatrix and local widths are linear in it, and so are the places of walls, which are planes). The kernel's
areas of both faces and its volume tell it. Where the side of a cone stands in a plane, a part in a million or so is no
quadratic: that comes from the panel's numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.hole_checks import ExpectedHoles
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.sampled_curves import sampled_lengths
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.volume import quadratic_area

AREA_LIMIT = 1e-9
"""Relative difference between a flat pattern's area and that of the surface that it unrolls."""
LENGTH_LIMIT = 1e-6
"""Difference in mm between an edge on the skin and the same edge unrolled."""
_SAME_PLANE = 1e-6
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedFlat:
    """What a panel's flat pattern says.

    Attributes:
        area: inside its contour, less its holes, mm2.
        share: where the surface that it unrolls lies, from the skin into the sheet, a part of the thickness.
        depth: the thickness, negative where the sheet lies against the skin's normals, mm.
        skin_pieces: lengths of all pieces of the skin's own outline, unrolled, mm.
        tray: the panel, where it is a flat one with folded edges.
        beyond: what the surface that it unrolls has more than the quadratic in the share says, mm2.
    """

    area: float
    share: float
    depth: float
    skin_pieces: Array
    tray: TrayShape | None = None
    beyond: float = 0.0


class FlatFacts(NamedTuple):
    """A flat pattern, the planes of the far faces, what was found in the files, and the holes in the sheet."""

    expected: ExpectedFlat
    far_planes: Array
    solid: ShapeFacts
    skin: ShapeFacts
    holes: ExpectedHoles | None = None


def check_flats(panels: Sequence[FlatFacts], failures: list[str]) -> tuple[float, float]:
    """The greatest relative error of an area, and of a length in mm; what is too large becomes a sentence.

    Where there is nothing to measure the sentence says so, and nothing counts.
    """
    area_error, length_error = 0.0, 0.0
    for panel in panels:
        name, expected = panel.skin.name, panel.expected
        found = _area_at(panel)
        error = abs(expected.area / found - 1.0) if found > 0.0 else np.inf
        area_error = max(area_error, error if found > 0.0 else 0.0)
        if not error <= AREA_LIMIT:
            failures.append(
                f"Panel '{name}': its flat pattern has an area of {expected.area:.12g} mm2, the solid {found:.12g}."
            )
        own, wanted = np.sort(_border_lengths(panel.skin)), np.sort(expected.skin_pieces)
        alike = len(own) == len(wanted)
        error = float(np.abs(own - wanted).max(initial=0.0)) if alike else np.inf
        length_error = max(length_error, error if alike else 0.0)
        if not error <= LENGTH_LIMIT:
            failures.append(f"Panel '{name}': an edge of its skin is {error:.3g} mm longer or shorter when it is flat.")
    return area_error, length_error


def _area_at(panel: FlatFacts) -> float:
    """Area of the surface that is unrolled, from the kernel's numbers."""
    holes, share, depth = panel.holes, panel.expected.share, panel.expected.depth
    near = float(panel.skin.areas.sum()) - (0.0 if holes is None else holes.skin_area)
    both = float(panel.solid.areas[_main_faces(panel, depth)].sum())
    return quadratic_area(near, both - near, panel.solid.volume / abs(depth), share) + panel.expected.beyond


def _main_faces(panel: FlatFacts, depth: float) -> Array:
    """(f,) which faces are no walls: round ones, and those in the planes of flat patches, near or far.

    Square walls at the ends of round patches are neither planes nor round; holes through flat patches are as wide as
    they are asked for.
    """
    if panel.expected.tray is not None:
        return _faces_of_tray(panel.expected.tray, panel.solid.surfaces, depth)
    solid, normals, points = panel.solid, panel.far_planes[:, 1], panel.far_planes[:, 0]
    flat, known = (solid.surfaces[:, 6:8] == 0.0).all(axis=1), np.isfinite(solid.surfaces[:, 6])
    turned = np.linalg.norm(np.cross(solid.surfaces[:, None, 3:6], normals), axis=-1) <= _SAME_PLANE
    heights = np.einsum("fpx,px->fp", solid.surfaces[:, None, :3] - points, normals)
    level = np.minimum(np.abs(heights), np.abs(heights + depth)) <= _SAME_PLANE
    drilled = np.zeros(len(flat), dtype=bool)
    if panel.holes is not None:
        drilled = (np.abs(solid.surfaces[:, 6] - 0.5 * panel.holes.diameter) <= _SAME_PLANE) & turned.any(axis=-1)
    return np.asarray(~drilled & ((known & ~flat) | (turned & level).any(axis=-1)))


def _faces_of_tray(tray: TrayShape, surfaces: Array, depth: float) -> Array:
    """(f,) which faces lie on the skin of a folded flat panel, or on the parallel one at a depth."""
    found = np.zeros(len(surfaces), dtype=bool)
    for level in (tray, tray.offset(depth)):
        points, ways = level.surfaces()
        radii = np.array([patch.radius if isinstance(patch, ConePatch) else 0.0 for patch in level.patches])
        offset = surfaces[:, None, :3] - points
        along = np.einsum("fpx,px->fp", offset, ways)
        beside = np.linalg.norm(offset - along[..., None] * ways, axis=-1)
        turned = np.linalg.norm(np.cross(surfaces[:, None, 3:6], ways), axis=-1) <= _SAME_PLANE
        level_off = np.where(radii > 0.0, beside, np.abs(along)) <= _SAME_PLANE
        found |= (turned & level_off & (np.abs(surfaces[:, 6:7] - radii) <= _SAME_PLANE)).any(axis=-1)
    return np.asarray(found)


def _border_lengths(skin: ShapeFacts) -> Array:
    """Lengths of all that bounds a skin, mm."""
    others = skin.other_points[skin.other_edges[:, 1] < 0]
    return np.concatenate([_lengths(skin.pieces.take(skin.border)), sampled_lengths(others)])


def _lengths(border: CurvePieces) -> Array:
    """(b,) lengths of segments and arcs of ellipses, mm, the latter by quadrature to rounding error."""
    span = border.stops - border.starts
    angles = border.starts[:, None] + 0.5 * span[:, None] * (1.0 + _NODES)
    cosine, sine = np.cos(angles)[..., None], np.sin(angles)[..., None]
    speed = np.linalg.norm(cosine * border.sine_axes[:, None] - sine * border.cosine_axes[:, None], axis=-1)
    arcs = 0.5 * span * (speed @ _WEIGHTS)
    return np.asarray(np.where(border.arcs, arcs, span * np.linalg.norm(border.cosine_axes, axis=-1)))
