"""End curves of panels, and how far apart two of them are along a whole seam.

An end curve runs from corner to corner: straight over a plane patch, a conic over a cone patch. It is followed by a
parameter u from 0 to k: the integer part is the patch, the rest the share of its sweep (cone) or of its chord (plane).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.geometry.conic_chains import ConicChains, conic_chains
from cadpanel.geometry.frames import rotate_about
from cadpanel.geometry.vectors import cross, dot
from cadpanel.geometry.widest_place import Widest, widest

# Points a curved patch is followed at.
_ARC_POINTS = 24
# Seams that are measured together: enough to make the cost of a call small, few enough to stay in the cache.
_TOGETHER = 512


@dataclass(frozen=True, slots=True)
class EndCurves:
    """A batch of s end curves of panels with k patches each, in one frame and unit.

    Attributes:
        corners: (s, k + 1, 3).
        p, t, n: (s, k + 1, 3) the bounding rulings.
        radius, half_angle, sweep: (s, k) of the patch that follows each ruling; all 0 for a plane.
        cut_point, cut_normal: (s, 3).
    """

    corners: Array
    p: Array
    t: Array
    n: Array
    radius: Array
    half_angle: Array
    sweep: Array
    cut_point: Array
    cut_normal: Array

    def take(self, index: IntArray) -> EndCurves:
        """The curves at `index`."""
        return EndCurves(*(getattr(self, f.name)[index] for f in fields(self)))

    @property
    def patches(self) -> int:
        """Patches along a curve."""
        return int(self.radius.shape[1])

    def follow(self, u: Array) -> tuple[Array, Array]:
        """Points and the skin's normals (s, q, 3) at the parameters u (s, q) in [0, k]."""
        patch = np.clip(np.floor(u).astype(np.intp), 0, self.patches - 1)
        share = u - patch
        rows = np.arange(len(u))[:, None]
        p, t, n = self.p[rows, patch], self.t[rows, patch], self.n[rows, patch]
        radius, half_angle, sweep = (getattr(self, f)[rows, patch] for f in ("radius", "half_angle", "sweep"))
        axis = np.cos(half_angle)[..., None] * t - np.sin(half_angle)[..., None] * n
        centre = p - radius[..., None] * n
        turned_t, turned_n = rotate_about(axis, share * sweep, t), rotate_about(axis, share * sweep, n)
        foot = centre + radius[..., None] * turned_n
        m = self.cut_normal[:, None]
        slide = dot(m, self.cut_point[:, None] - foot) / dot(m, turned_t)
        arc = foot + slide[..., None] * turned_t
        here, there = self.corners[rows, patch], self.corners[rows, patch + 1]
        straight = here + share[..., None] * (there - here)
        return np.where((sweep == 0.0)[..., None], straight, arc), turned_n

    def stations(self) -> Array:
        """(q,) parameters that follow every curve of the batch closely."""
        curved = np.any(self.sweep != 0.0, axis=0)
        parts = [i + np.arange(n) / n for i, n in enumerate(np.where(curved, _ARC_POINTS, 4))]
        return np.append(np.concatenate(parts), float(self.patches))


def seam_gap(first: EndCurves, second: EndCurves) -> Widest:
    """How far apart pairs of end curves are at most, in which parts, and the largest angle between the skins there.

    All is taken between the points of either curve and their closest points on the other, and within 1e-3 of its value;
    lengths below 1e-10 of the curve's extent are not told from 0.
    """
    origin = 0.5 * (first.corners[:, 0] + second.corners[:, 0])
    one, other = as_chains(first, origin), as_chains(second, origin)
    parts = [np.zeros((4, 0))]
    for start in range(0, len(origin), _TOGETHER):
        some = slice(start, start + _TOGETHER)
        found = widest(one.part(some), other.part(some))
        parts.append(np.stack([found.gap, found.kink, found.width, found.step]))
    return Widest(*np.concatenate(parts, axis=1))


def as_chains(curves: EndCurves, origin: Array) -> ConicChains:
    """The curves as chains, seen from the origins (s, 3).

    With e(phi) the radial vector of a cone patch and m the cut's normal, a generatrix meets the cut plane where its
    height above the level of p is (m . (q - c) - r m . e) / (cos(g) m . a + sin(g) m . e); c + height (cos(g) a +
    sin(g) e) + r e over that divisor is linear in e, as the products of e cancel.
    """
    curved = (curves.sweep != 0.0)[..., None]
    p, t, n = (of[:, :-1] for of in (curves.p - origin[:, None], curves.t, curves.n))
    corners, m = curves.corners - origin[:, None], curves.cut_normal[:, None]
    cosine, sine = np.cos(curves.half_angle)[..., None], np.sin(curves.half_angle)[..., None]
    axis, radial = cosine * t - sine * n, cosine * n + sine * t
    tangential = cross(axis, radial)
    level = curves.radius[..., None] * cosine
    center = p - level * radial
    rise, toward, aside = (dot(m, of)[..., None] for of in (axis, radial, tangential))
    offset = dot(m, (curves.cut_point - origin)[:, None] - center)[..., None]
    stretch = cosine * rise * level + sine * offset
    flat = np.zeros_like(rise)
    return conic_chains(
        constant=np.where(curved, cosine * (rise * center + offset * axis), corners[:, :-1]),
        cosine=np.where(curved, stretch * radial + toward * (sine * center - cosine * level * axis), 0.0),
        sine=np.where(curved, stretch * tangential + aside * (sine * center - cosine * level * axis), 0.0),
        weights=np.where(
            curved, np.concatenate([cosine * rise, sine * toward, sine * aside], axis=-1), [1.0, 0.0, 0.0]
        ),
        span=np.where(curved, 0.0, corners[:, 1:] - corners[:, :-1]),
        start=flat[..., 0],
        turn=curves.sweep,
        normals=[
            np.where(curved, -sine * axis, n),
            np.where(curved, cosine * radial, 0.0),
            np.where(curved, cosine * tangential, 0.0),
        ],
    )
