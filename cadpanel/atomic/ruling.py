"""A plane, a cylinder or a cone as a ruling with two bending numbers, none of which ever blows up.

The ruling is a point p and right-handed axes b, t, n (across, along, normal). With k the normal curvature at p (the
inverse of the signed normal radius r; the axis passes through p - r n) and l the taper, the inverse of the distance
along t from the apex to p, the half angle g follows from tan(g) = l / k. Of a point with the coordinates (u, v, w)
along b, t, n let P = 1 + k w + l v and S = sqrt((k^2 + l^2) u^2 + P^2). Then
    d = w + k u^2 / (P + S)
is the signed distance s rho cos(g) - z sin(g) - r of `cadpanel.geometry.cone`: put r = 1/k and sin(g), cos(g) in terms
of k and l, and expand the difference of the two large lengths. So k = 0 is the plane and l = 0 is the cylinder, both
regular points. Where P < 0 (behind the axis) u^2 / (P + S) = (S - P) / (k^2 + l^2) keeps all digits.

From the apex to the foot of the point on its generatrix it is f = 1 / l + v + l u^2 / (P + S). Where l f < 0 the foot
has passed the apex, d is the distance to the generatrix's prolongation, and the distance to the cone, which has one
nappe, is that to the apex: sqrt(d^2 + f^2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.geometry.frames import cayley

# The increments a ruling is moved by: turns about b, t, n (radians), shift along n, curvature, taper.
TURN_B, TURN_T, TURN_N, SHIFT, CURVATURE, TAPER = range(6)
PLANE = (TURN_B, TURN_T, SHIFT)
CYLINDER = (TURN_B, TURN_T, TURN_N, SHIFT, CURVATURE)
CONE = (TURN_B, TURN_T, TURN_N, SHIFT, CURVATURE, TAPER)
_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rulings:
    """n rulings with their bending.

    Attributes:
        points: (n, 3) p.
        frames: (n, 3, 3) columns b, t, n.
        curvature: (n,) k, positive if the axis lies on the side of -n.
        taper: (n,) l, positive if the apex lies on the side of -t.
    """

    points: Array
    frames: Array
    curvature: Array
    taper: Array

    def at(self, which: IntArray | BoolArray | slice) -> Rulings:
        """Some of them."""
        return Rulings(
            points=self.points[which],
            frames=self.frames[which],
            curvature=self.curvature[which],
            taper=self.taper[which],
        )

    def replaced(self, where: BoolArray, others: Rulings) -> Rulings:
        """Those of `others` where (n,) is true, these elsewhere."""
        return Rulings(
            points=np.where(where[:, None], others.points, self.points),
            frames=np.where(where[:, None, None], others.frames, self.frames),
            curvature=np.where(where, others.curvature, self.curvature),
            taper=np.where(where, others.taper, self.taper),
        )

    def local(self, x: Array) -> Array:
        """(3, n, m) coordinates u, v, w of points x (n, m, 3)."""
        return np.ascontiguousarray(np.moveaxis((x - self.points[:, None]) @ self.frames, -1, 0))


def distances(rulings: Rulings, q: Array) -> Array:
    """(n, m) signed distances of points with the local coordinates q (3, n, m), positive on the side of n."""
    height, _, _ = _heights(rulings, q)
    distance: Array = q[2] + rulings.curvature[:, None] * height
    return distance


def distance_rows(rulings: Rulings, q: Array, unknowns: tuple[int, ...]) -> tuple[Array, Array]:
    """As `distances`, and the exact derivatives (n, len(unknowns), m) by the increments of `moved`."""
    u, v, w = q
    k, taper = rulings.curvature[:, None], rulings.taper[:, None]
    height, quotient, root = _heights(rulings, q)
    normal_b, normal_t, normal_n = _normal(k, taper, u, quotient, root)
    rows = np.empty((len(k), len(unknowns), u.shape[1]))
    for i, unknown in enumerate(unknowns):
        if unknown == TURN_B:
            rows[:, i] = w * normal_t - v * normal_n
        elif unknown == TURN_T:
            rows[:, i] = u * normal_n - w * normal_b
        elif unknown == TURN_N:
            rows[:, i] = v * normal_b - u * normal_t
        elif unknown == SHIFT:
            rows[:, i] = -normal_n
        elif unknown == CURVATURE:
            rows[:, i] = height - k * (quotient * w + k * height * quotient)
        else:
            rows[:, i] = -k * (quotient * v + taper * height * quotient)
    return w + k * height, rows


def passed_apex(rulings: Rulings, q: Array) -> Array:
    """(n, m) how far the feet of points with local coordinates q (3, n, m) have passed the apex, not negative."""
    height, _, _ = _heights(rulings, q)
    taper = rulings.taper[:, None]
    # l f is 1 where the taper is 0: there is no apex.
    share = 1.0 + taper * q[1] + taper * taper * height
    return np.where(share < 0.0, -share, 0.0) / np.where(share < 0.0, np.abs(taper), 1.0)


def passed_apex_rows(rulings: Rulings, q: Array) -> tuple[Array, Array]:
    """As `passed_apex`, and the exact derivatives (n, 6, m) by the increments of a cone."""
    u, v, w = q
    k, taper = rulings.curvature[:, None], rulings.taper[:, None]
    height, quotient, root = _heights(rulings, q)
    passed = passed_apex(rulings, q)
    # The foot's way changes along the generatrix's own direction only.
    along_b = taper * u / root
    along_t, along_n = 1.0 - taper * taper * quotient, -taper * k * quotient
    inverse = np.divide(1.0, taper, out=np.zeros_like(taper), where=taper != 0.0)
    rows = np.stack(
        [
            w * along_t - v * along_n,
            u * along_n - w * along_b,
            v * along_b - u * along_t,
            -along_n,
            -taper * quotient * (w + k * height),
            height - inverse * inverse - taper * quotient * (v + taper * height),
        ],
        axis=1,
    )
    rows *= np.where(passed > 0.0, -np.sign(taper), 0.0)[:, None]
    return passed, rows


def normals(rulings: Rulings, q: Array) -> Array:
    """(3, n, m) unit normals, along b, t, n, of the surfaces under points with local coordinates q (3, n, m)."""
    _, quotient, root = _heights(rulings, q)
    return np.stack(_normal(rulings.curvature[:, None], rulings.taper[:, None], q[0], quotient, root))


def moved(rulings: Rulings, increments: Array, unknowns: tuple[int, ...]) -> Rulings:
    """The rulings after increments (n, len(unknowns)): turned about p in their own axes, shifted, bent."""
    full = np.zeros((len(increments), len(CONE)))
    full[:, list(unknowns)] = increments
    turn = cayley(full[:, TURN_B : TURN_N + 1])
    return Rulings(
        points=rulings.points + full[:, SHIFT, None] * rulings.frames[:, :, 2],
        frames=rulings.frames @ turn,
        curvature=rulings.curvature + full[:, CURVATURE],
        taper=rulings.taper + full[:, TAPER],
    )


def anchored(rulings: Rulings, centres: Array) -> Rulings:
    """The same surfaces, told by the ruling and the point on it that lie under the centres (n, 3).

    The ruling is turned about the axis by the angle whose sine is h u / S and whose cosine is P / S, h^2 = k^2 + l^2;
    with h a = k t - l n for the axis a, everything is written without dividing by h. A centre on the axis, under which
    all rulings lie alike, leaves the ruling as it is.
    """
    along = rulings.local(centres[:, None])[1, :, 0]
    stretch = 1.0 + rulings.taper * along
    # Only a centre beyond the apex could ask for a stretch that is not positive.
    along = np.where(stretch > 0.0, along, 0.0)
    stretch = 1.0 + rulings.taper * along
    slid = Rulings(
        points=rulings.points + along[:, None] * rulings.frames[:, :, 1],
        frames=rulings.frames,
        curvature=rulings.curvature / stretch,
        taper=rulings.taper / stretch,
    )
    q = slid.local(centres[:, None])
    _, quotient, root = (part[:, 0] for part in _heights(slid, q))
    off_axis = root > np.sqrt(np.finfo(float).eps)
    across = np.where(off_axis, q[0, :, 0] / np.maximum(root, _TINY), 0.0)
    quotient = np.where(off_axis, quotient, 0.0)
    k, taper = slid.curvature, slid.taper
    skew = np.zeros((len(k), 3, 3))
    skew[:, 0, 1], skew[:, 1, 0] = taper, -taper
    skew[:, 0, 2], skew[:, 2, 0] = k, -k
    turn = np.eye(3) + across[:, None, None] * skew + quotient[:, None, None] * (skew @ skew)
    step = np.stack([across, -quotient * taper, -quotient * k], axis=-1)
    return Rulings(
        points=slid.points + (slid.frames @ step[:, :, None])[:, :, 0],
        frames=_orthonormal(slid.frames @ turn),
        curvature=k,
        taper=taper,
    )


def _heights(rulings: Rulings, q: Array) -> tuple[Array, Array, Array]:
    """u^2 / (P + S), u^2 / (P + S) / S and S, each (n, m)."""
    u, v, w = q
    k, taper = rulings.curvature[:, None], rulings.taper[:, None]
    square = k * k + taper * taper
    reach = 1.0 + k * w + taper * v
    root = np.sqrt(square * u * u + reach * reach)
    np.maximum(root, _TINY, out=root)
    both = root + np.abs(reach)
    height = u * u / both
    behind = reach < 0.0
    if np.any(behind):
        np.divide(both, np.broadcast_to(square, both.shape), out=height, where=behind)
    return height, height / root, root


def _normal(k: Array, taper: Array, u: Array, quotient: Array, root: Array) -> tuple[Array, Array, Array]:
    bent = k * quotient
    return k * u / root, -taper * bent, 1.0 - k * bent


def _orthonormal(frames: Array) -> Array:
    """Frames with what rounding has left of their skewness taken out (one Newton step of the polar decomposition)."""
    gram = np.swapaxes(frames, 1, 2) @ frames
    orthonormal: Array = frames @ (1.5 * np.eye(3) - 0.5 * gram)
    return orthonormal
